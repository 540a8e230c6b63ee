// SPDX-License-Identifier: Apache-2.0
#include "frame/frame_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "metrics/depth.hpp"

namespace dtof {

std::vector<float> true_depth(const TargetMap& targets, std::span<const int> columns, RowRange rows) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> metres;
  for (int row = rows.first; row < rows.first + rows.count; ++row) {
    for (const int column : columns) {
      const PixelTarget& target = targets.at(column, row);
      metres.push_back(target.returns_signal() ? static_cast<float>(target.depth_m) : kUnknown);
    }
  }
  return metres;
}

FrameMaps frame_maps(std::span<const PixelResult> results, const ReadoutParameters& parameters,
                     const SensorModel& sensor, const std::optional<RangeConverter>& table,
                     std::span<const float> truth) {
  const DepthScale scale(sensor.integration_time_s, parameters.np, sensor.pulse_fwhm_s);
  FrameMaps maps;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double position = code_position(results[i], parameters.fraction_bits);
    const double before = scale.depth(position);
    const auto depth = static_cast<float>(table ? table->distance(position) : before);
    if (!std::isnan(truth[i])) {
      maps.before.add(before - truth[i]);
    }
    maps.depth.push_back(std::max(depth, 0.0F));
    maps.error.push_back(depth - truth[i]);
  }
  return maps;
}

double add_errors(std::span<const float> truth, std::span<const float> error, ErrorStatistics& all) {
  RunningMoments errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!std::isnan(truth[i])) {
      all.add(truth[i], truth[i] + error[i]);
      errors.add(error[i]);
    }
  }
  return errors.mean_square();
}

std::vector<std::string> figure_names(bool table) {
  std::vector<std::string> names = {"rmse mm", "bias mm"};
  if (table) {
    names.emplace_back("bias before table mm");
  }
  names.insert(names.end(), {"above 3 %", "above 10 %"});
  return names;
}

std::vector<std::string> figure_values(const ErrorStatistics& statistics, const RunningMoments& before,
                                       bool table) {
  if (statistics.count() == 0) {
    std::vector<std::string> unknown(figure_names(table).size(), "-");
    return unknown;
  }
  const ErrorSummary summary = statistics.summary();
  std::vector<std::string> values = {fmt::format("{:.0f}", summary.rmse_m * 1e3),
                                     fmt::format("{:.0f}", summary.bias_m * 1e3)};
  if (table) {
    values.push_back(fmt::format("{:.0f}", before.mean() * 1e3));
  }
  values.insert(values.end(), {fmt::format("{:.2f} %", summary.share_above_3_percent * 100.0),
                               fmt::format("{:.2f} %", summary.share_above_10_percent * 100.0)});
  return values;
}

}  // namespace dtof
