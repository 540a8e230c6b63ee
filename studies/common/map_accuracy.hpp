// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "run/run_settings.hpp"

namespace dtof {

/// Repeated frames of a map at one light level; errors are against each pixel's own distance, after the
/// look-up table of FlatCalibration.
struct MapAccuracySettings {
  SensorModel sensor;
  TargetMap targets{1, 1};
  double klux = 14.0;
  std::vector<ReadoutParameters> readouts;
  std::vector<double>
      band_edges_m;  ///< ascending, at least 2; band i is [edge i, edge i + 1), the last closed
  int frames = 8;    ///< at least 4
  SourceFactory make_source = make_exact_source;
  RunSettings run;
  std::string command;  ///< to reproduce a difference that --verify finds
};

/// One read-out's errors on the pixels of one distance band, over all frames. Intervals come from the spread
/// of the frames' means; that of a share is at least Wilson's for pixels that are independent.
struct BandAccuracy {
  std::string readout;  ///< readout_name
  std::string title;
  double klux;
  double from_m;
  double to_m;
  std::uint64_t pixels;  ///< of a frame
  int frames;
  Estimate bias_m;
  Estimate rmse_m;
  Estimate above_3_percent;
  Estimate above_10_percent;
};

/// Edges of ten bands of equal width from the nearest to the farthest target; of one band if all are at one
/// distance. Throws InputError if the map has no target.
std::vector<double> equal_bands(const TargetMap& targets);

/// Read-out by read-out, bands ascending; bands without a pixel are left out, and the last one of each
/// read-out is the whole range. Throws InputError for illegal settings, or if no pixel lies within the bands.
std::vector<BandAccuracy> run_map_accuracy(const MapAccuracySettings& settings);

}  // namespace dtof
