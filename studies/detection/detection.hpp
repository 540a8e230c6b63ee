// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "page/page.hpp"

namespace dtof {

/// Study of target detection. Frames of sky alone set one confidence threshold per read-out, for all light
/// levels and skies. Frames of a flat target then give the share of pixels that pass the threshold and have a
/// correct distance.
struct DetectionSettings {
  SensorModel sensor;
  std::vector<ReadoutParameters> readouts;
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  std::vector<double> sky_reflectivities = {0.5, 1.0, 2.0};  ///< brightness of a sky, as a reflectivity
  std::vector<double> distances_m = {2.0, 3.0, 4.0, 5.0};
  double wall_reflectivity = 0.5;
  double false_alarms = 1e-3;  ///< largest share of any sky's pixels that may pass
  int seeds = 4;               ///< at least 2
  std::uint64_t seed = 1;
  int threads = 0;
};

struct DetectionCell {
  double klux = 0.0;
  double distance_m = 0.0;
  Estimate detected;  ///< share of the target's pixels that pass and are at most 10 % off
  Estimate right;     ///< share of the target's pixels that are at most 10 % off
};

struct ReadoutDetection {
  Readout readout = Readout::kEzPointer;
  int threshold = 0;  ///< lowest confidence that meets `false_alarms` for all skies
  /// Share of each sky's pixels that pass, with other seeds; sorted by light.
  std::vector<double> held_out_alarms;
  std::vector<DetectionCell> cells;  ///< sorted by light
};

/// Measures the read-outs that have a confidence, on an engine's columns with the sensor's rows. Throws
/// InputError for settings out of range.
std::vector<ReadoutDetection> run_detection(const DetectionSettings& settings);

/// What detection.mustache shows.
PageData detection_page(const DetectionSettings& settings, const std::vector<ReadoutDetection>& study,
                        const std::string& command_line);
Table detection_csv(const std::vector<ReadoutDetection>& study);
/// Light level of the picture: the one nearest to 50 klux.
double detection_klux(const DetectionSettings& settings);
/// Share detected against distance, at that light level.
std::vector<PlotSeries> detection_curves(const DetectionSettings& settings,
                                         const std::vector<ReadoutDetection>& study);

}  // namespace dtof
