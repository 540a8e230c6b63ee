// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dtof {

struct PlotSeries {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> low = {};  ///< with `high`: limits of a band around the line, as long as x; or empty
  std::vector<double> high = {};
};

/// Titles and axes of a plot. The title holds quantity, unit, scene and light, so that the picture explains
/// itself.
struct PlotLayout {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool logarithmic_y = false;
  std::vector<double> y_limits = {};  ///< y of horizontal lines, e.g. a requirement
  bool logarithmic_x = false;
  bool markers = true;  ///< draw a symbol at each point
  bool panels = false;  ///< draw each series in a panel of its own, with the same axes
};

/// Appearance of a read-out (readouts.toml) or reference (scripts/plot_styles.toml) in every picture.
struct PlotStyle {
  std::string_view title;
  std::string_view colour;  ///< "#rrggbb"
  int marker = 0;           ///< gnuplot's pointtype
  int dash = 1;             ///< gnuplot's dashtype
};

/// All styles.
std::span<const PlotStyle> plot_styles();

/// Style whose title begins the label, the longest such title: hisPointer's for "hisPointer, corrected". None
/// for a label that begins with no known title.
std::optional<PlotStyle> plot_style(std::string_view label);

/// Why plots cannot be drawn (gnuplot does not run); empty if they can.
std::string plot_obstacle();

/// Draws lines and points as SVG with gnuplot. Values that are not finite are left out. Throws InputError if
/// gnuplot is missing or fails, or the file cannot be written; then no file is left behind.
void write_plot(const std::filesystem::path& path, const std::vector<PlotSeries>& series,
                const PlotLayout& layout);

}  // namespace dtof
