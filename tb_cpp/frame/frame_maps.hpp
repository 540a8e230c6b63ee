// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/detection.hpp"
#include "core/parameters.hpp"
#include "core/result.hpp"
#include "host/range_converter.hpp"
#include "metrics/error_statistics.hpp"
#include "photon/sensor_model.hpp"
#include "photon/target_map.hpp"

namespace dtof {

/// True distances of the rows of these columns, m, row-major; NaN where nothing returns light.
std::vector<float> true_depth(const TargetMap& targets, std::span<const int> columns, RowRange rows);

/// What a host makes of a frame's results, m; NaN in `error` where the truth is unknown.
struct FrameMaps {
  std::vector<float> depth;  ///< at least 0
  std::vector<float> error;  ///< measured - true
  RunningMoments before;     ///< errors by Eq. 3.11, before the look-up table
};

/// Distances by `table`, or by Eq. 3.11 if there is none. `truth` has a value for each result.
FrameMaps frame_maps(std::span<const PixelResult> results, const ReadoutParameters& parameters,
                     const SensorModel& sensor, const std::optional<RangeConverter>& table,
                     std::span<const float> truth);

/// Adds the errors of the pixels whose truth is known to `all`; returns the frame's own mean square, m2.
double add_errors(std::span<const float> truth, std::span<const float> error, ErrorStatistics& all);

/// The figures of a summary as text, with and without a look-up table: their names and, of a frame's errors,
/// their values; "-" if no pixel had a target.
std::vector<std::string> figure_names(bool table);
std::vector<std::string> figure_values(const ErrorStatistics& statistics, const RunningMoments& before,
                                       bool table);

}  // namespace dtof
