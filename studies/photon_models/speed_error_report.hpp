// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dtof/report/table.hpp"
#include "page/page.hpp"
#include "photon_models/speed_error_curves.hpp"

namespace dtof {

/// CPU ms of a frame by photon model, photons and one read-out included.
struct ModelCosts {
  double exact_stream_ms = 0.0;
  double fast_stream_ms = 0.0;
  double fast_sampler_ms = 0.0;
};

struct SpeedErrorResults {
  std::string sensor;
  std::uint64_t seed = 1;
  int frames = 0;            ///< of a point
  std::size_t scenes = 0;    ///< lights and distances
  std::size_t readouts = 0;  ///< of each scene
  std::uint32_t acquisitions = 0;
  std::uint64_t detections = 0;  ///< of the frame whose time was taken
  int threads = 1;
  Table models{{"model"}};  ///< time, largest changes and p-values of each
  ModelCosts costs;
  std::vector<ErrorCurve> curves;
  int reference_frames = 0;  ///< of the curves
  std::string command_line;
};

/// Data of the page speed_error.mustache. Its advice follows from the costs and the curves.
PageData speed_error_page(const SpeedErrorResults& results);

}  // namespace dtof
