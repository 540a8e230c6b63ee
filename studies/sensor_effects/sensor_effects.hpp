// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/report/table.hpp"
#include "page/page.hpp"

namespace dtof {

/// Accuracy of the read-outs with one sensor: points for every light level, read-out and distance.
struct SensorAccuracy {
  SensorModel sensor;
  std::vector<AccuracyPoint> points;
};

/// Differences of a sensor from a clean one, e.g. "dead time 20 ns; 1 % hot pixels of 1e+07 Hz".
std::string sensor_difference(const SensorModel& clean, const SensorModel& sensor);

/// Number of comparisons of a figure whose intervals do not overlap.
struct IntervalsApart {
  int higher = 0;
  int lower = 0;
  int comparisons = 0;
};
/// Compares the figure `figure` of two sensors, point by point. Throws std::logic_error unless both have the
/// same points in the same order.
IntervalsApart intervals_apart(const SensorAccuracy& clean, const SensorAccuracy& other,
                               Estimate AccuracyPoint::*figure);

/// Median over an estimator's points of the ratio of rmse with the sensor to rmse with the clean one.
double median_rmse_ratio(const SensorAccuracy& clean, const SensorAccuracy& other,
                         const std::string& estimator);

/// A row per sensor with median_rmse_ratio of every estimator.
Table effect_overview(const SensorAccuracy& clean, std::span<const SensorAccuracy> others);

/// Table at one light level with a row per read-out and a column per distance: clean and with the sensor.
Table effect_table(const SensorAccuracy& clean, const SensorAccuracy& other, double klux,
                   Estimate AccuracyPoint::*figure, double scale, bool relative_to_distance);

/// Several sensors beside a clean one, on the same targets.
struct SensorEffects {
  SensorAccuracy clean;
  std::vector<SensorAccuracy> others;
  std::vector<double> klux;
  int frames = 0;  ///< at each distance and light
  std::uint64_t seed = 0;
};
/// What sensor_effects.mustache shows.
PageData sensor_effects_page(const SensorEffects& effects, const std::string& command_line);

/// All figures with their intervals; SI units, shares 0 .. 1.
Table effects_csv(const SensorAccuracy& clean, std::span<const SensorAccuracy> others);

}  // namespace dtof
