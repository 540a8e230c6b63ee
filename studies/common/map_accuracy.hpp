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

/// Settings for repeated frames of a map at one light level. Errors are relative to each pixel's own
/// distance, after the look-up table of FlatCalibration.
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
  std::string command;  ///< command that reproduces a difference found by --verify
};

/// Errors of one read-out in one distance band, over all frames. Intervals follow from the spread of the
/// frames' means; an interval of a share is at least Wilson's for independent pixels.
struct BandAccuracy {
  std::string readout;  ///< readout_name
  std::string title;
  double klux;
  double from_m;
  double to_m;
  std::uint64_t pixels;  ///< per frame
  int frames;
  Estimate bias_m;
  Estimate rmse_m;
  Estimate above_3_percent;
  Estimate above_10_percent;
};

/// Edges of ten bands of equal width from the nearest to the farthest target; a single band if all distances
/// are equal. Throws InputError if the map has no target.
std::vector<double> equal_bands(const TargetMap& targets);

/// Sorted by read-out, then by band (ascending). Bands without pixels are left out; the last band of each
/// read-out is the whole range. Throws InputError for illegal settings, or if no pixel lies within the bands.
std::vector<BandAccuracy> run_map_accuracy(const MapAccuracySettings& settings);

}  // namespace dtof
