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
  std::vector<double> low = {};  ///< with `high`: a band around the line, as long as x, or empty
  std::vector<double> high = {};
};

/// Its quantity and unit, scene and light stand in the title, so that a picture says by itself what it shows.

struct PlotLayout {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool logarithmic_y = false;
  std::vector<double> y_limits = {};  ///< horizontal lines, e.g. a requirement
  bool logarithmic_x = false;
  bool markers = true;  ///< a symbol at each point
  bool panels = false;  ///< each series in a panel of its own, with the same axes
};

/// How a read-out (readouts.toml) or reference (scripts/plot_styles.toml) looks in every picture.
struct PlotStyle {
  std::string_view title;
  std::string_view colour;  ///< "#rrggbb"
  int marker = 0;           ///< gnuplot's pointtype
  int dash = 1;             ///< gnuplot's dashtype
};

/// All of them.
std::span<const PlotStyle> plot_styles();

/// That of the longest title which the label begins with, e.g. hisPointer's for "hisPointer, corrected"; none
/// for a label that names no read-out.
std::optional<PlotStyle> plot_style(std::string_view label);

/// Why nothing can be plotted here: gnuplot does not run. Empty if it does.
std::string plot_obstacle();

/// Draws lines with points as SVG through gnuplot. Values that are not finite are left out. Throws
/// InputError if gnuplot is missing or fails, or the file cannot be written; then nothing is left behind.
void write_plot(const std::filesystem::path& path, const std::vector<PlotSeries>& series,
                const PlotLayout& layout);

}  // namespace dtof
