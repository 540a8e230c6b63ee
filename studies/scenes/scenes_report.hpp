// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/report/table.hpp"
#include "page/page.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

struct EstimatorResult {
  SceneScore score;
  double error_over_bound;  ///< median; NaN without bounds
};

struct SceneResult {
  std::string scene;
  std::vector<EstimatorResult> estimators;
};

/// What was measured with a sensor at a light.
struct LightResults {
  double klux;
  std::string sensor;
  std::string look_up_table;  ///< a sentence: table_sentence
  std::vector<std::string> estimators;
  std::vector<SceneResult> scenes;
};

struct ScenesResults {
  std::uint64_t seed;
  int columns;                     ///< read of a scene at most
  std::vector<std::string> notes;  ///< sentences on the scenes' maps
  std::vector<LightResults> lights;
  std::string command_line;
};

/// Flats and slanted planes: a pool of pixels must not need a flat wall.
bool shows_pooled_gain(const std::string& scene);

/// Pixels above 3 % / 10 %: scenes down, estimators across.
Table all_pixels_table(const LightResults& light);

/// Data of the page scenes.mustache.
PageData scenes_page(const ScenesResults& results);

}  // namespace dtof
