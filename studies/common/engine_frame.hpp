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

// Frames of one engine of the pool read-outs, cut out of the middle of a scene: the smallest array on which
// every read-out is at home.

/// Columns judged: an engine of poolPointer.
int engine_columns_judged();
/// Columns read, so that the lean form's engine is whole, too; what it makes of the further ones is not
/// judged.
int engine_columns_read();

/// The scene's pixels around the centre of the sensor's: engine_columns_read() columns.
TargetMap middle_of(Scene scene, const SensorModel& sensor, int rows);

/// Results by column and row.
using EngineResults = std::vector<std::vector<PixelResult>>;
/// What each read-out made of at least the judged columns. All see the same photons, but for those of the
/// first `dropped` acquisitions.
std::vector<EngineResults> read_engine(const PhotonSource& source,
                                       std::span<const ReadoutParameters> readouts,
                                       std::uint32_t dropped = 0);

}  // namespace dtof
