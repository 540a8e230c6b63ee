// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/report/table.hpp"

namespace dtof {

/// How the read-outs fare with a sensor: points of every light level, read-out and distance.
struct SensorAccuracy {
  SensorModel sensor;
  std::vector<AccuracyPoint> points;
};

/// What distinguishes a sensor from a clean one, e.g. "dead time 20 ns; 1 % hot pixels of 1e+07 Hz".
std::string sensor_difference(const SensorModel& clean, const SensorModel& sensor);

/// How many comparisons of a figure have intervals that do not touch.
struct IntervalsApart {
  int higher = 0;
  int lower = 0;
  int comparisons = 0;
};
/// `figure` picks the estimate. Throws std::logic_error unless both have the same points in the same order.
IntervalsApart intervals_apart(const SensorAccuracy& clean, const SensorAccuracy& other,
                               Estimate AccuracyPoint::*figure);

/// Median over the points of an estimator of rmse with the sensor / rmse with the clean one.
double median_rmse_ratio(const SensorAccuracy& clean, const SensorAccuracy& other,
                         const std::string& estimator);

/// A line for each sensor: median_rmse_ratio of every estimator.
Table effect_overview(const SensorAccuracy& clean, std::span<const SensorAccuracy> others);

/// Sentences on a sensor, each computed from the figures: what differs beyond the intervals, where most, and
/// which read-out bears it best and worst.
std::string effect_sentences(const SensorAccuracy& clean, const SensorAccuracy& other);

/// Read-outs down, distances across: clean and with the sensor, at one light level.
Table effect_table(const SensorAccuracy& clean, const SensorAccuracy& other, double klux,
                   Estimate AccuracyPoint::*figure, double scale, bool relative_to_distance);

/// Every figure with its interval; SI units, shares 0 .. 1.
Table effects_csv(const SensorAccuracy& clean, std::span<const SensorAccuracy> others);

}  // namespace dtof
