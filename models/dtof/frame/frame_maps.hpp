// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// True if a result has a distance: its confidence is above 0, or the read-out has no confidence. EMPTY of
/// dtof_subsystem's results follows the same rule.
bool has_distance(const PixelResult& result, const ReadoutParameters& parameters);

/// Error figures of the judged pixels of one frame or several. Every judged pixel counts, whether its result
/// has a distance or not, so a read-out cannot improve its figures by low confidence.
struct FrameFigures {
  ErrorStatistics errors;
  RunningMoments before;  ///< errors of the distances by Eq. 3.11, without the look-up table
  std::uint64_t without_distance = 0;
  /// Pixels with another return before the strongest one (FrameTruth::first_return), and those whose distance
  /// is within 3 % of this first return.
  std::uint64_t behind_another = 0;
  std::uint64_t at_first_return = 0;

  void merge(const FrameFigures& other);
};

/// Distances and errors of a frame's results, as a host computes them. Maps are in m; NaN is unknown.
struct FrameMaps {
  std::vector<float> depth;  ///< at least 0; NaN without a distance
  std::vector<float> error;  ///< measured - true; NaN without a distance or a true distance
  FrameFigures figures;
  double mean_square = 0.0;  ///< mean square of the errors in `figures`, m2
};

/// Computes distances by `table`, or by Eq. 3.11 if there is none. `truth` has the true distance of each
/// result, NaN where the result is not judged. `skew_bins` has the timing skew of each result's pixel, which
/// the host knows and subtracts; empty: no skew.
FrameMaps frame_maps(std::span<const PixelResult> results, const ReadoutParameters& parameters,
                     const SensorModel& sensor, const std::optional<RangeConverter>& table,
                     std::span<const float> truth, std::span<const double> skew_bins = {});

/// Counts the results that measured the first return instead of the strongest one; `first_return` as in
/// FrameTruth.
void count_first_returns(std::span<const float> first_return, FrameMaps& maps);

/// Names of a summary's figures, with or without a look-up table, and their values as text; "-" if no pixel
/// is judged.
std::vector<std::string> figure_names(bool table);
std::vector<std::string> figure_values(const FrameFigures& figures, bool table);

}  // namespace dtof
