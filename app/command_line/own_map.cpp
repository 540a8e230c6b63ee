// SPDX-License-Identifier: Apache-2.0
#include "command_line/own_map.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstddef>

#include "command_line/option_checks.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/pipeline/frame_limits.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

void MapScales::add_to(CLI::App& group) {
  group
      .add_option("--depth-scale", metres_per_unit,
                  "metres that one unit of a depth map stands for (default: 0.001 for a PNG of 16 bits, 1\n"
                  "for PFM and NPY; a PNG of 8 bits needs it)")
      ->check(above_zero());
  group
      .add_option("--reflectivity-scale", reflectivity_per_unit,
                  "reflectivity that one unit of a reflectivity map stands for (default: a PNG's full range\n"
                  "is 1, PFM and NPY are taken as they are)")
      ->check(above_zero());
}

NamedMap parse_named_map(std::string_view text) {
  const auto fail = [&](std::string_view reason) {
    throw InputError(fmt::format("--map '{}': {}", text, reason));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) {
    fail("expected NAME=DEPTH or NAME=DEPTH,REFLECTIVITY");
  }
  NamedMap map;
  map.name = text.substr(0, equals);
  const std::string_view files = text.substr(equals + 1);
  const std::size_t comma = files.find(',');
  map.files.depth = files.substr(0, comma);
  if (comma != std::string_view::npos) {
    map.files.reflectivity = files.substr(comma + 1);
    if (map.files.depth.empty() || map.files.reflectivity.empty() ||
        map.files.reflectivity.find(',') != std::string::npos) {
      fail("expected NAME=DEPTH or NAME=DEPTH,REFLECTIVITY");
    }
  }
  const auto legal = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == ' ' || c == '-' || c == '_' || c == '.';
  };
  if (!std::ranges::all_of(map.name, legal)) {
    fail("a name has letters, digits, blanks, '-', '_' and '.'");
  }
  const bool built_in =
      std::ranges::any_of(kAllScenes, [&](Scene scene) { return map.name == scene_name(scene); });
  if (built_in || map.name.starts_with("flat ") || map.name.starts_with("held ") ||
      map.name == "disparity map") {
    fail(fmt::format("'{}' is the name of another scene of the study", map.name));
  }
  return map;
}

std::string resampling_sentence(std::string_view map, int width, int height, const TargetMap& targets) {
  if (width == targets.columns() && height == targets.rows()) {
    return fmt::format("{}: {} x {} pixels, taken pixel by pixel.", map, width, height);
  }
  return fmt::format("{}: {} x {} pixels, resampled to {} x {} by nearest neighbour.", map, width, height,
                     targets.columns(), targets.rows());
}

std::string apply_reflectivity_map(TargetMap& targets, const std::string& file, const MapScales& scales) {
  const ReflectivityImage image = read_reflectivity_image(file, scales.reflectivity_per_unit);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (image.values[i] > kMostReflectivity) {
      const auto width = static_cast<std::size_t>(image.width);
      throw InputError(fmt::format("{}: column {}, row {}: a reflectivity of {:g} is not within 0 to {}",
                                   file, i % width, i / width, image.values[i], reflectivity_reason()));
    }
  }
  set_reflectivity(targets, image.width, image.height, image.values);
  return resampling_sentence("Reflectivity map " + file, image.width, image.height, targets);
}

OwnMap read_own_map(const MapFiles& files, const MapScales& scales, int columns, int rows,
                    double default_reflectivity) {
  const DepthImage depth = read_depth_image(files.depth, scales.metres_per_unit);
  OwnMap map{
      scene_from_depth_image(depth.width, depth.height, depth.metres, columns, rows, default_reflectivity),
      {}};
  map.description = resampling_sentence("Depth map " + files.depth, depth.width, depth.height, map.targets);
  if (!files.reflectivity.empty()) {
    map.description += " " + apply_reflectivity_map(map.targets, files.reflectivity, scales);
  }
  return map;
}

}  // namespace dtof
