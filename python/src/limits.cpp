// SPDX-License-Identifier: Apache-2.0
#include "src/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/pipeline/frame_limits.hpp"
#include "dtof/sensor/sensor_keys.hpp"

namespace dtof::python {
namespace {

constexpr int kMostSlots = 16;
constexpr int kMostThreads = 1024;
// As --max-frames has them.
constexpr int kFewestFrames = 4;
constexpr int kMostFrames = 1'000'000;

/// Written so that a NaN fails.
bool is_within(double value, double lowest, double highest) { return value >= lowest && value <= highest; }

void check_within(const char* name, double value, double lowest, double highest, const std::string& reason) {
  if (!is_within(value, lowest, highest)) {
    throw InputError(fmt::format("{}: {}", name, not_within(fmt::format("{}", value), lowest, reason)));
  }
}

void check_range(const char* name, std::int64_t value, std::int64_t lowest, std::int64_t highest) {
  if (value < lowest || value > highest) {
    throw InputError(fmt::format("{}: {} is outside {} to {}", name, value, lowest, highest));
  }
}

}  // namespace

void check_klux(double klux) { check_within("klux", klux, 0.0, kMostKlux, klux_reason()); }

void check_threads(int threads) { check_range("threads", threads, 0, kMostThreads); }

void check_precision(const std::optional<double>& percent, int max_frames) {
  if (percent && !(*percent > 0.0)) {
    throw InputError(fmt::format("precision_percent: {} is not above 0", *percent));
  }
  check_range("max_frames", max_frames, kFewestFrames, kMostFrames);
}

void check_sensor_number(std::string_view key, const std::optional<std::int64_t>& value) {
  const auto keys = sensor_number_keys();
  const auto found = std::ranges::find(keys, key, &SensorNumberKey::name);
  if (!value || found == keys.end()) {
    return;
  }
  const std::string error =
      sensor_number_error(*found, static_cast<double>(*value), fmt::format("{}", *value));
  if (!error.empty()) {
    throw InputError(error);
  }
}

void check_reflectivity(double reflectivity) {
  check_within("reflectivity", reflectivity, 0.0, kMostReflectivity, reflectivity_reason());
}

void check_size(int columns, int rows) {
  check_sensor_number("columns", columns);
  check_sensor_number("rows", rows);
}

void check_reflectivities(const TargetMap& targets) {
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      const double share = targets.at(column, row).reflectivity;
      if (!is_within(share, 0.0, kMostReflectivity)) {
        throw InputError(fmt::format("reflectivity: column {}, row {}: {}", column, row,
                                     not_within(fmt::format("{}", share), 0.0, reflectivity_reason())));
      }
    }
  }
}

void check_recorded(std::int64_t acquisitions, int slots) {
  if (acquisitions < 1) {
    throw InputError(fmt::format("acquisitions: {} is not at least 1", acquisitions));
  }
  check_range("slots", slots, 1, kMostSlots);
}

void refuse_without_effect(bool given, std::string_view argument, std::string_view reason) {
  if (given) {
    throw InputError(fmt::format("{} has no effect: {}", argument, reason));
  }
}

}  // namespace dtof::python
