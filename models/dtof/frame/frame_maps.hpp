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

/// Whether a result has a distance: not with confidence 0, as that of a pixel without a detection is, unless
/// the read-out has no confidence. EMPTY of dtof_subsystem's results.
bool has_distance(const PixelResult& result, const ReadoutParameters& parameters);

/// Figures of the pixels that are judged, of one frame or several. Their errors are those of the position
/// that a result holds, with a distance or without: no read-out gains by its doubts.
struct FrameFigures {
  ErrorStatistics errors;
  RunningMoments before;  ///< errors by Eq. 3.11, before the look-up table
  std::uint64_t without_distance = 0;

  void merge(const FrameFigures& other);
};

/// What a host makes of a frame's results. Maps are in m; NaN is unknown.
struct FrameMaps {
  std::vector<float> depth;  ///< at least 0; unknown without a distance
  std::vector<float> error;  ///< measured - true; unknown without a distance or a truth
  FrameFigures figures;
  double mean_square = 0.0;  ///< of the errors that `figures` has, m2
};

/// Distances by `table`, or by Eq. 3.11 if there is none. `truth` has a value for each result, NaN where the
/// result is not judged. `skew_bins`: timing skew of each result's pixel, which the host knows and subtracts;
/// empty: none.
FrameMaps frame_maps(std::span<const PixelResult> results, const ReadoutParameters& parameters,
                     const SensorModel& sensor, const std::optional<RangeConverter>& table,
                     std::span<const float> truth, std::span<const double> skew_bins = {});

/// The figures of a summary as text, with and without a look-up table: their names and their values; "-" if
/// no pixel is judged.
std::vector<std::string> figure_names(bool table);
std::vector<std::string> figure_values(const FrameFigures& figures, bool table);

}  // namespace dtof
