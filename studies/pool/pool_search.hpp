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

/// A frame on which designs of poolPointer are compared: the columns of one engine, one scene, one light
/// level.
struct TrainingFrame {
  std::string scene;
  double klux = 0.0;
  SceneTruth truth;
  PoolFrame photons;
};

/// Draws the engine's columns from the middle of each scene. Scenes must have at least that many columns.
std::vector<TrainingFrame> draw_training_frames(const SensorModel& sensor,
                                                const std::vector<StudyScene>& scenes,
                                                const std::vector<double>& klux, std::uint64_t seed,
                                                int columns, int threads);

/// Errors of a design. Each figure is a geometric mean over frames of a share in per cent. kLeastShare is
/// added to each share, so that frames without errors do not dominate.
struct DesignScore {
  double above_3_percent = 0.0;         ///< without S1
  double smooth_above_3_percent = 0.0;  ///< with S1
  double above_10_percent = 0.0;
  double edges_above_3_percent = 0.0;  ///< with S1
  /// Values of objective() for each light level alone, in the order of the frames' light levels.
  std::vector<double> by_light;

  /// Figure that a search minimises: the geometric mean of the four figures.
  [[nodiscard]] double objective() const;
};
inline constexpr double kLeastShare = 0.05;  // per cent

/// Scores a design on frames; distances follow Eq. 3.11.
DesignScore score_design(const SensorModel& sensor, const std::vector<TrainingFrame>& frames,
                         const PoolNumbers& design, int threads);

}  // namespace dtof
