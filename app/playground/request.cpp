// SPDX-License-Identifier: Apache-2.0
#include "playground/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/recording/resampling.hpp"
#include "playground/advice.hpp"

namespace dtof {
namespace {

double number(const std::string& name, const std::string& text, double lowest, double highest) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= lowest && value <= highest)) {
    throw InputError(fmt::format("{}: '{}' is no number from {:g} to {:g}", name, text, lowest, highest));
  }
  return value;
}

std::uint64_t whole(const std::string& name, const std::string& text, std::uint64_t lowest,
                    std::uint64_t highest) {
  std::uint64_t value = 0;
  bool legal = !text.empty() && text.size() < 20;
  for (const char digit : text) {
    legal = legal && digit >= '0' && digit <= '9';
    value = 10 * value + static_cast<std::uint64_t>(digit - '0');
  }
  if (!legal || value < lowest || value > highest) {
    throw InputError(fmt::format("{}: '{}' is no whole number from {} to {}", name, text, lowest, highest));
  }
  return value;
}

void set(PlaygroundRequest& request, const std::string& name, const std::string& value) {
  constexpr double kFarthest = 100.0;
  constexpr double kNearest = 0.01;
  constexpr double kLongestShift = 1e6;
  if (name == "sensor") {
    request.sensor = value;
  } else if (name == "scene") {
    request.scene = value;
  } else if (name == "columns") {
    request.columns = static_cast<int>(whole(name, value, 1, 400));
  } else if (name == "rows") {
    request.rows = static_cast<int>(whole(name, value, 1, 400));
  } else if (name == "distance") {
    request.distance_m = number(name, value, kNearest, kFarthest);
  } else if (name == "near") {
    request.near_m = number(name, value, kNearest, kFarthest);
  } else if (name == "far") {
    request.far_m = number(name, value, kNearest, kFarthest);
  } else if (name == "steps") {
    request.steps = static_cast<int>(whole(name, value, 1, 400));
  } else if (name == "reflectivity") {
    request.reflectivity = number(name, value, 0.0, 4.0);
  } else if (name == "klux") {
    request.klux = number(name, value, 0.0, 200.0);
  } else if (name == "acquisitions") {
    request.acquisitions = static_cast<std::uint32_t>(whole(name, value, 1, 65535));
  } else if (name == "photons") {
    request.photons = number(name, value, 0.0, kLargestPhotonNumber);
  } else if (name == "shift") {
    request.shift_ns = number(name, value, -kLongestShift, kLongestShift);
  } else if (name == "readout") {
    request.readouts.push_back(value);
  } else if (name == "seed") {
    request.seed = whole(name, value, 0, std::numeric_limits<std::int64_t>::max());
  } else {
    throw InputError(fmt::format("'{}' is nothing that a request may say", name));
  }
}

void set(AdviceRequest& request, const std::string& name, const std::string& value) {
  constexpr double kLeast = 1e-6;  // of a limit
  constexpr double kMost = 1e9;
  if (name == "sensor") {
    request.sensor = value;
  } else if (name == "max-mm2") {
    request.most_mm2 = number(name, value, kLeast, kMost);
  } else if (name == "max-mw") {
    request.most_mw = number(name, value, kLeast, kMost);
  } else if (name == "frame-rate") {
    request.frames_per_s = number(name, value, kLeast, kMost);
  } else if (name == "clock-mhz") {
    request.clock_mhz = number(name, value, kLeast, kMost);
  } else if (name == "seed") {
    request.seed = whole(name, value, 0, std::numeric_limits<std::int64_t>::max());
  } else {
    throw InputError(fmt::format("'{}' is nothing that a request may say", name));
  }
}

/// Sets a request's fields from "name value" lines.
template <typename Request>
Request parse(std::string_view text) {
  Request request;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t blank = line.find(' ');
    if (blank == std::string_view::npos) {
      throw InputError(fmt::format("'{}' has no value", line));
    }
    set(request, std::string(line.substr(0, blank)), std::string(line.substr(blank + 1)));
  }
  return request;
}

}  // namespace

PlaygroundRequest parse_playground_request(std::string_view text) { return parse<PlaygroundRequest>(text); }

AdviceRequest parse_advice_request(std::string_view text) { return parse<AdviceRequest>(text); }

}  // namespace dtof
