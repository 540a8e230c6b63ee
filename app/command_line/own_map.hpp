// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Scale of the numbers in map files; none: the default of the format (io/depth_image.hpp).
struct MapScales {
  std::optional<double> metres_per_unit;
  std::optional<double> reflectivity_per_unit;

  /// --depth-scale and --reflectivity-scale.
  void add_to(CLI::App& group);
};

/// Files of a scene of the user's own.
struct MapFiles {
  std::string depth;
  std::string reflectivity;  ///< empty: every surface has the default
};

/// A scene of the user's own for --map of `dtof-study scenes`.
struct NamedMap {
  std::string name;
  MapFiles files;
};

/// "NAME=DEPTH" or "NAME=DEPTH,REFLECTIVITY". A name has letters, digits, blanks and "-_."; those of the
/// built-in scenes and what `dtof-study scenes` calls its own ("flat 1 m", "held planes") are refused with
/// InputError.
NamedMap parse_named_map(std::string_view text);

/// Maps as an array's targets.
struct OwnMap {
  TargetMap targets;
  std::string description;  ///< one sentence a map: its size, and how it was resampled
};

/// Reads the maps and resamples each to columns x rows by nearest neighbour. Throws InputError that names the
/// file.
OwnMap read_own_map(const MapFiles& files, const MapScales& scales, int columns, int rows,
                    double default_reflectivity);

/// Gives `targets` the reflectivity of a file's map; returns the sentence on its size and resampling.
std::string apply_reflectivity_map(TargetMap& targets, const std::string& file, const MapScales& scales);

/// "depth map a.png: 640 x 480 pixels, resampled to 200 x 160 by nearest neighbour."
std::string resampling_sentence(std::string_view map, int width, int height, const TargetMap& targets);

}  // namespace dtof
