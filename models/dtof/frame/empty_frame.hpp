// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Columns of a frame in the dark without a target: what cover glass and fog alone send back. 2 columns of
/// 160 rows. Throws InputError as PhotonSource does.
std::vector<ColumnStream> empty_columns(const SensorModel& sensor, std::uint64_t seed = 1);

/// Whether a frame without a target has light of the sensor's own.
bool has_own_light(const SensorModel& sensor);

/// The TEMPLATE registers of a pool read-out for what surrounds the sensor (readout/pool_template.hpp).
PoolTemplate template_of(const SensorModel& sensor, const ReadoutParameters& parameters);

}  // namespace dtof
