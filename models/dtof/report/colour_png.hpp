// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "dtof/io/depth_image.hpp"

namespace dtof {

/// What a map shows, which fixes its colours.
enum class MapKind {
  kDepth,  ///< viridis; 0, negative and NaN are unknown
  kError,  ///< blue - white - red, symmetric about 0; NaN is unknown
};

/// Range of a colour scale in m; values beyond take its end colours, and that end of the bar has a point.
struct ColourRange {
  double lowest = 0.0;
  double highest = 1.0;
};

/// A picture of one map. Unknown pixels are grey.
struct MapPanel {
  DepthImage image;
  std::string label;  ///< drawn above the map; may be empty
  MapKind kind = MapKind::kDepth;
};

/// What surrounds the maps.
struct PictureLayout {
  std::string title;
  std::string caption = {};  ///< last line, e.g. command, seed and preset
  int panels_per_row = 1;
  int pixel_size = 0;  ///< screen pixels per map pixel; 0 chooses 1..16 so that a map is about 480 wide
  std::optional<ColourRange> depth_range = std::nullopt;  ///< none: smallest to largest depth of all maps
  std::optional<double> largest_error = std::nullopt;     ///< m; none: 98 % of all |errors| lie inside
};

/// Draws the panels in a grid with one scale bar for each kind of map in it. Throws InputError for no panels,
/// an impossible layout or an unwritable file.
void write_map_picture(const std::filesystem::path& path, std::span<const MapPanel> panels,
                       const PictureLayout& layout);

/// Smallest and largest known depth, widened when they are equal; 0..1 m if nothing is known.
ColourRange depth_range(std::span<const MapPanel> panels);

/// Half range of a symmetric scale that holds 98 % of all |errors|, at least 1 mm.
double error_range(std::span<const MapPanel> panels);

}  // namespace dtof
