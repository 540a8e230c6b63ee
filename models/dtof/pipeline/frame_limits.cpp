// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/frame_limits.hpp"

#include <fmt/format.h>

namespace dtof {

std::string acquisitions_reason() {
  return fmt::format("{}: the detections of a frame's columns are held in memory", kMostAcquisitions);
}

std::string klux_reason() { return fmt::format("{} klux: the brightest sunlight is about 130", kMostKlux); }

std::string reflectivity_reason() {
  return fmt::format(
      "{0:g}: a white matt surface is 1, a glint is more, and the photon models are checked up to {0:g}",
      kMostReflectivity);
}

std::string not_within(std::string_view value, double lowest, std::string_view reason) {
  return fmt::format("{} is not within {} to {}", value, lowest, reason);
}

}  // namespace dtof
