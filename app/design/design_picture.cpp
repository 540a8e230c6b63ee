// SPDX-License-Identifier: Apache-2.0
#include "design/design_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "dtof/report/plot.hpp"

namespace dtof {
namespace {

constexpr double kInPerCent = 100.0;

}  // namespace

void write_design_picture(const std::filesystem::path& path, const DesignRequest& request,
                          const DesignResult& result) {
  std::map<Readout, std::vector<std::pair<double, double>>> points;
  double least = 1.0;
  double most = 0.0;
  for (const DesignOption& option : result.options) {
    constexpr double kLeastShown = 1e-4;  // of pixels: a logarithmic axis has no 0
    const double share = std::max(option.best_known().worst().above_3_percent.value, kLeastShown);
    points[option.candidate.readout()].emplace_back(option.candidate.cost.mm2, kInPerCent * share);
    least = std::min(least, share);
    most = std::max(most, share);
  }
  std::vector<PlotSeries> series;
  for (auto& [readout, of] : points) {
    std::ranges::sort(of);
    PlotSeries one{.label = std::string(readout_title(readout)), .x = {}, .y = {}};
    for (const auto& [mm2, share] : of) {
      one.x.push_back(mm2);
      one.y.push_back(share);
    }
    series.push_back(std::move(one));
  }
  if (std::isfinite(request.limits.most_mm2)) {
    series.push_back({.label = "limit of area",
                      .x = {request.limits.most_mm2, request.limits.most_mm2},
                      .y = {kInPerCent * least, kInPerCent * most}});
  }
  write_plot(
      path, series,
      {.title = fmt::format("{}: pixels off by more than 3 %, against area", request.bench.sensor.name),
       .x_label = "area of the array in mm2",
       .y_label = "pixels off by more than 3 %, in %",
       .logarithmic_y = true,
       .y_limits = {},
       .logarithmic_x = true});
}

}  // namespace dtof
