// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "common/map_accuracy.hpp"
#include "page/page.hpp"

namespace dtof {

struct LightAccuracy {
  double klux = 0.0;
  AccuracyStudy study;
};
/// What accuracy.mustache shows. `fidelity`: the photon model by its option's name.
PageData accuracy_page(const StudySettings& settings, const std::string& fidelity,
                       const std::vector<LightAccuracy>& lights);

struct LightBands {
  double klux = 0.0;
  std::vector<BandAccuracy> bands;
};
/// A user's depth map or transient cube, in a sentence.
struct OwnScene {
  std::string description;
  bool is_cube = false;
};
/// What accuracy_over_a_map.mustache shows.
PageData map_accuracy_page(const MapAccuracySettings& settings, const OwnScene& scene,
                           const std::string& fidelity, const std::vector<LightBands>& lights);

}  // namespace dtof
