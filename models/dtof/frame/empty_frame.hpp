// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Two columns of 160 rows of a frame without sunlight and target: the returns of cover glass and fog alone.
/// Throws InputError as PhotonSource does.
std::vector<ColumnStream> empty_columns(const SensorModel& sensor, std::uint64_t seed = 1);

/// True if the sensor's own light returns without a target (cover glass, fog).
bool has_own_light(const SensorModel& sensor);

/// TEMPLATE registers of a pool read-out for the sensor's cover glass and fog (readout/pool_template.hpp).
PoolTemplate template_of(const SensorModel& sensor, const ReadoutParameters& parameters);

}  // namespace dtof
