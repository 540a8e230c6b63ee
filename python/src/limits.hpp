// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "dtof/photon/target_map.hpp"

namespace dtof::python {

/// Each throws InputError for what the program `dtof` refuses, with the program's sentence.
void check_klux(double klux);
void check_threads(int threads);
/// The arguments of a precision.
void check_precision(const std::optional<double>& percent, int max_frames);
/// A number of a sensor, by its key in sensor files; none is legal.
void check_sensor_number(std::string_view key, const std::optional<std::int64_t>& value);
/// Size of an array in front of a scene.
void check_size(int columns, int rows);
void check_reflectivity(double reflectivity);
/// Those of all pixels.
void check_reflectivities(const TargetMap& targets);
/// Slots and acquisitions of recorded data.
void check_recorded(std::int64_t acquisitions, int slots);
/// An argument that is there and means nothing.
void refuse_without_effect(bool given, std::string_view argument, std::string_view reason);

}  // namespace dtof::python
