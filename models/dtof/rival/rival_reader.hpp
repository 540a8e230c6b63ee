// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "dtof/rival/rival.hpp"

namespace dtof {

/// Largest number of frames that a result of one of the rivals needs; 1 without rivals.
std::size_t most_frames(std::span<const std::unique_ptr<Rival>> rivals);

/// Reads the columns of a scene with rivals, from the same photons for all of them. Thread-safe.
class RivalReader {
 public:
  /// `frames`: numbers of the frames that a result is made of, oldest first, most_frames(rivals) of them. The
  /// last one is the measured frame. `rivals` must outlive the reader.
  RivalReader(SensorModel sensor, const TargetMap& targets, double klux, std::uint64_t seed,
              std::vector<std::uint32_t> frames, std::span<const std::unique_ptr<Rival>> rivals);

  /// Words of a column's pixels: a vector of rows for each rival. Draws the photons of the column again with
  /// each call.
  [[nodiscard]] std::vector<std::vector<RivalWords>> column(int column) const;

 private:
  std::vector<PhotonSource> lit_;   // of each frame
  std::vector<PhotonSource> dark_;  // without laser; of the frames that some rival wants dark
  std::span<const std::unique_ptr<Rival>> rivals_;
};

}  // namespace dtof
