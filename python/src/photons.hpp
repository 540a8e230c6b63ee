// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/region.hpp"
#include "src/scene.hpp"

namespace dtof::python {

/// The scene before the sensor, photons not yet drawn. Throws InputError if the sensor can measure no
/// distance of the scene.
PhotonSource scene_photons(const SceneMap& scene, const SensorModel& sensor, double klux, std::uint64_t seed,
                           std::uint32_t frame);

/// The region of some columns, in ascending order, and of neighbouring rows (first, one behind the last);
/// without them all. Throws InputError for a column or row that is not there, or a column named twice.
Region choose_region(int columns, int rows, const std::optional<std::vector<int>>& chosen_columns,
                     const std::optional<std::pair<int, int>>& chosen_rows);

}  // namespace dtof::python
