// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dtof {

struct PlotSeries {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
};

struct PlotLayout {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool logarithmic_y = false;
  std::vector<double> y_limits = {};  ///< horizontal lines, e.g. a requirement
  bool logarithmic_x = false;
  bool markers = true;  ///< a symbol at each point
};

/// Draws lines with points as SVG through gnuplot. Values that are not finite are left out. Throws
/// InputError if gnuplot is missing or fails, or the file cannot be written; then nothing is left behind.
void write_plot(const std::filesystem::path& path, const std::vector<PlotSeries>& series,
                const PlotLayout& layout);

}  // namespace dtof
