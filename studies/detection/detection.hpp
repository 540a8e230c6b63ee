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

namespace dtof {

/// Is there a target at all? Frames of sky alone give each read-out one threshold of confidence for all
/// lights and skies; frames of a wall then say how many of its pixels pass it and are right.
struct DetectionSettings {
  SensorModel sensor;
  std::vector<ReadoutParameters> readouts;
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  std::vector<double> sky_reflectivities = {0.5, 1.0, 2.0};  ///< what a sky's sunlight is like
  std::vector<double> distances_m = {2.0, 3.0, 4.0, 5.0};
  double wall_reflectivity = 0.5;
  double false_alarms = 1e-3;  ///< most that pass of any sky's pixels
  int seeds = 4;               ///< at least 2
  std::uint64_t seed = 1;
  int threads = 0;
};

struct DetectionCell {
  double klux = 0.0;
  double distance_m = 0.0;
  Estimate detected;  ///< share of the wall's pixels that pass and are at most 10 % off
  Estimate right;     ///< share that are at most 10 % off
};

struct ReadoutDetection {
  Readout readout = Readout::kEzPointer;
  int threshold = 0;                    ///< the lowest confidence that no sky has too often
  std::vector<double> held_out_alarms;  ///< share of each sky that passes, of other seeds; lights first
  std::vector<DetectionCell> cells;     ///< lights first
};

/// Measures read-outs that have a confidence on an engine's columns of the sensor's rows. Throws InputError
/// for settings out of range.
std::vector<ReadoutDetection> run_detection(const DetectionSettings& settings);

std::string detection_report(const DetectionSettings& settings, const std::vector<ReadoutDetection>& study,
                             const std::string& command_line);
Table detection_csv(const std::vector<ReadoutDetection>& study);
/// The light nearest to 50 klux, that of the picture.
double detection_klux(const DetectionSettings& settings);
/// Detection over distance at that light.
std::vector<PlotSeries> detection_curves(const DetectionSettings& settings,
                                         const std::vector<ReadoutDetection>& study);

}  // namespace dtof
