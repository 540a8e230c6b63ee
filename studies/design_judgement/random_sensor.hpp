// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/design/design.hpp"

namespace dtof {

/// Ranges of the sensors that draw_sensor draws. The lower ends are fixed.
struct SensorRanges {
  int most_columns = 128;                  ///< from kLeastColumns
  int most_rows = 96;                      ///< from kLeastRows
  std::uint32_t most_acquisitions = 3333;  ///< from kLeastAcquisitions
};
inline constexpr int kLeastColumns = 16;
inline constexpr int kLeastRows = 12;
inline constexpr std::uint32_t kLeastAcquisitions = 300;

/// A sensor file and the options of `dtof design` that belong to it.
struct RandomSensor {
  std::string toml;
  std::string options;    ///< "--max-mm2 0.31"; empty: none
  DesignRequest request;  ///< of `dtof design` with this sensor and these options
  int refused = 0;        ///< earlier draws that no read-out suits
};

/// Returns the candidates that keep the limits.
std::vector<DesignCandidate> kept_of(const std::vector<DesignCandidate>& grid, const DesignLimits& limits);
/// Returns the candidate with the smallest array of those that are compared with equal parameters
/// (compared_parameters).
std::vector<DesignCandidate> smallest_of_each(const std::vector<DesignCandidate>& candidates);

/// Draws the sensor with this number. A quarter of the sensors has no limit but the default frame rate, a
/// quarter a limit of area, a quarter a limit of power, and a quarter a high frame rate. A limit is a random
/// quantile of the grid's costs. Equal arguments give the same sensor.
RandomSensor draw_sensor(std::uint64_t seed, int number, const SensorRanges& ranges);

/// "57 x 40, NP 10, 2 SLOTS, ...": what differs from sensor to sensor.
std::string sensor_line(const SensorModel& sensor);
/// Sentence on the ranges, for the report.
std::string ranges_text(const SensorRanges& ranges);

}  // namespace dtof
