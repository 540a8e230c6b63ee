// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/metrics/error_statistics.hpp"
#include "measured_data/measured_scene.hpp"
#include "page/page.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// How bright it is: photons per pixel and frame, and what the sun adds.
struct MeasuredLight {
  double photons;  ///< 0: all photons of the recording
  double background;

  [[nodiscard]] std::string name() const;
};

/// What a read-out made of a light's frames.
struct MeasuredOutcome {
  SceneMeasurement measurement;  ///< offset removed
  SceneScore score;
  ErrorSummary errors;
  double median_error_m;
  double off_both_surfaces;  ///< share of pixels more than 3 % off the nearer of the two
};

struct MeasuredLightResult {
  MeasuredLight light;
  std::vector<MeasuredOutcome> readouts;
};

/// Titles of read-outs whose RTL gave the model's result in each pixel, and of those without RTL.
struct ComparedWithRtl {
  std::vector<std::string> equal;
  std::vector<std::string> not_compiled;
};

struct MeasuredResults {
  std::vector<std::string> readouts;  ///< titles
  std::vector<MeasuredLightResult> lights;
  std::uint32_t acquisitions;
  double t_int_ns;
  int timestamp_bits;
  std::uint32_t frames;  ///< of each light
  std::uint64_t seed;
  ComparedWithRtl compared_with_rtl;
  std::string command_line;
};

/// Data of the page measured.mustache.
PageData measured_page(const MeasuredScene& scene, const MeasuredResults& results);

}  // namespace dtof
