// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

// Frames of one engine of the pool read-outs, cut out of the middle of a scene: the smallest array in which
// every read-out works as in a full array.

/// Number of judged columns: an engine of poolPointer.
int engine_columns_judged();
/// Number of columns read, which also holds a whole engine of the lean form. Its additional columns are not
/// judged.
int engine_columns_read();

/// Middle engine_columns_read() columns of the scene, around the centre of the sensor.
TargetMap middle_of(Scene scene, const SensorModel& sensor, int rows);

/// Results [column][row].
using EngineResults = std::vector<std::vector<PixelResult>>;
/// Results of each read-out for at least the judged columns. All see the same photons, except those of the
/// first `dropped` acquisitions.
std::vector<EngineResults> read_engine(const PhotonSource& source,
                                       std::span<const ReadoutParameters> readouts,
                                       std::uint32_t dropped = 0);

}  // namespace dtof
