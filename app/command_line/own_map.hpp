// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Scales of the numbers in map files; none: the default of the format (io/depth_image.hpp).
struct MapScales {
  std::optional<double> metres_per_unit;
  std::optional<double> reflectivity_per_unit;

  /// Adds --depth-scale and --reflectivity-scale.
  void add_to(CLI::App& group);
};

/// Files of a user's scene.
struct MapFiles {
  std::string depth;
  std::string reflectivity;  ///< empty: all surfaces have the default reflectivity
};

/// A user's scene for --map of `dtof-study scenes`.
struct NamedMap {
  std::string name;
  MapFiles files;
};

/// Parses "NAME=DEPTH" or "NAME=DEPTH,REFLECTIVITY". A name has letters, digits, blanks and "-_.". Throws
/// InputError, also for names of built-in scenes and of scenes that `dtof-study scenes` adds ("flat 1 m",
/// "held planes").
NamedMap parse_named_map(std::string_view text);

/// Targets from a user's maps.
struct OwnMap {
  TargetMap targets;
  std::string description;  ///< one sentence per map: its size and resampling
};

/// Reads the maps and resamples each to columns x rows by nearest neighbour. Throws InputError that names the
/// file.
OwnMap read_own_map(const MapFiles& files, const MapScales& scales, int columns, int rows,
                    double default_reflectivity);

/// Sets the reflectivity of `targets` from a map file. Returns a sentence with its size and resampling.
std::string apply_reflectivity_map(TargetMap& targets, const std::string& file, const MapScales& scales);

/// Sentence, e.g. "depth map a.png: 640 x 480 pixels, resampled to 200 x 160 by nearest neighbour."
std::string resampling_sentence(std::string_view map, int width, int height, const TargetMap& targets);

}  // namespace dtof
