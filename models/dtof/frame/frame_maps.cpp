// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/frame_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "dtof/metrics/depth.hpp"

namespace dtof {

bool has_distance(const PixelResult& result, const ReadoutParameters& parameters) {
  const bool has_confidence = !is_pointer_readout(parameters.readout) || parameters.confidence_width > 0;
  return !has_confidence || result.confidence > 0;
}

void FrameFigures::merge(const FrameFigures& other) {
  errors.merge(other.errors);
  before.merge(other.before);
  without_distance += other.without_distance;
  behind_another += other.behind_another;
  at_first_return += other.at_first_return;
}

FrameMaps frame_maps(std::span<const PixelResult> results, const ReadoutParameters& parameters,
                     const SensorModel& sensor, const std::optional<RangeConverter>& table,
                     std::span<const float> truth, std::span<const double> skew_bins) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const DepthScale scale(sensor.integration_time_s, parameters.np, sensor.pulse_fwhm_s);
  FrameMaps maps;
  RunningMoments errors;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double position =
        code_position(results[i], parameters.fraction_bits) - (skew_bins.empty() ? 0.0 : skew_bins[i]);
    const double before = scale.depth(position);
    const auto depth = static_cast<float>(table ? table->distance(position) : before);
    const float error = depth - truth[i];
    const bool known = has_distance(results[i], parameters);
    if (!std::isnan(truth[i])) {
      maps.figures.before.add(before - truth[i]);
      maps.figures.errors.add(truth[i], truth[i] + error);
      maps.figures.without_distance += known ? 0 : 1;
      errors.add(error);
    }
    maps.depth.push_back(known ? std::max(depth, 0.0F) : kUnknown);
    maps.error.push_back(known ? error : kUnknown);
  }
  maps.mean_square = errors.mean_square();
  return maps;
}

void count_first_returns(std::span<const float> first_return, FrameMaps& maps) {
  constexpr float kSame = 0.03F;
  for (std::size_t i = 0; i < first_return.size(); ++i) {
    if (!std::isnan(first_return[i])) {
      ++maps.figures.behind_another;
      maps.figures.at_first_return +=
          std::abs(maps.depth[i] - first_return[i]) <= kSame * first_return[i] ? 1 : 0;
    }
  }
}

std::vector<std::string> figure_names(bool table) {
  std::vector<std::string> names = {"rmse mm", "bias mm"};
  if (table) {
    names.emplace_back("bias before table mm");
  }
  names.insert(names.end(), {"above 3 %", "above 10 %", "no distance"});
  return names;
}

std::vector<std::string> figure_values(const FrameFigures& figures, bool table) {
  const std::uint64_t judged = figures.errors.count();
  if (judged == 0) {
    std::vector<std::string> unknown(figure_names(table).size(), "-");
    return unknown;
  }
  const ErrorSummary summary = figures.errors.summary();
  std::vector<std::string> values = {fmt::format("{:.0f}", summary.rmse_m * 1e3),
                                     fmt::format("{:.0f}", summary.bias_m * 1e3)};
  if (table) {
    values.push_back(fmt::format("{:.0f}", figures.before.mean() * 1e3));
  }
  const auto per_cent = [](double share) { return fmt::format("{:.2f} %", share * 100.0); };
  values.insert(values.end(),
                {per_cent(summary.share_above_3_percent), per_cent(summary.share_above_10_percent),
                 per_cent(static_cast<double>(figures.without_distance) / static_cast<double>(judged))});
  return values;
}

}  // namespace dtof
