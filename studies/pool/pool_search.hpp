// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/photon/sensor_model.hpp"
#include "dtof/readout/pool_pointer.hpp"
#include "pool/pool_study.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// A frame that designs of poolPointer are tried on: one engine's columns of a scene at one light.
struct TrainingFrame {
  std::string scene;
  double klux = 0.0;
  SceneTruth truth;
  PoolFrame photons;
};

/// Draws the engine's columns in the middle of each scene. Scenes must have at least that many columns.
std::vector<TrainingFrame> draw_training_frames(const SensorModel& sensor,
                                                const std::vector<StudyScene>& scenes,
                                                const std::vector<double>& klux, std::uint64_t seed,
                                                int columns, int threads);

/// What a design made of the frames. Each is a geometric mean over frames of a share in per cent, to which
/// kLeastShare is added so that a frame without errors does not decide alone.
struct DesignScore {
  double above_3_percent = 0.0;         ///< without S1
  double smooth_above_3_percent = 0.0;  ///< with S1
  double above_10_percent = 0.0;
  double edges_above_3_percent = 0.0;  ///< with S1
  std::vector<double> by_light;  ///< objective() of each light alone, in the order of the frames' lights

  /// The figure that a search lowers: the geometric mean of the four.
  [[nodiscard]] double objective() const;
};
inline constexpr double kLeastShare = 0.05;  // per cent

/// Distances are those of Eq. 3.11.
DesignScore score_design(const SensorModel& sensor, const std::vector<TrainingFrame>& frames,
                         const PoolNumbers& design, int threads);

}  // namespace dtof
