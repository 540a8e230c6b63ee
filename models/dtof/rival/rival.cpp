// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/rival.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dtof/core/error.hpp"

namespace dtof {

const RivalEntry& find_rival(std::string_view name) {
  const std::span<const RivalEntry> rivals = all_rivals();
  const auto found = std::ranges::find(rivals, name, &RivalEntry::name);
  if (found == rivals.end()) {
    std::vector<std::string_view> names;
    for (const RivalEntry& entry : rivals) {
      names.push_back(entry.name);
    }
    throw InputError(fmt::format("no rival is called {}; known are {}", name, fmt::join(names, ", ")));
  }
  return *found;
}

void check_rival_frame(std::span<const Detection> detections, const SensorModel& sensor) {
  const std::uint32_t codes = std::uint32_t{1} << static_cast<unsigned>(sensor.np);
  for (const Detection& detection : detections) {
    if (detection.timestamp >= codes) {
      throw InputError(
          fmt::format("timestamp {} is above {}, the largest code", detection.timestamp, codes - 1));
    }
    if (detection.acquisition >= sensor.acquisitions) {
      throw InputError(
          fmt::format("acquisition {} is beyond the frame's {}", detection.acquisition, sensor.acquisitions));
    }
  }
}

}  // namespace dtof
