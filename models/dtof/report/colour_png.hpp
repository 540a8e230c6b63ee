// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "dtof/io/depth_image.hpp"

namespace dtof {

/// Kind of a map, which decides its colours.
enum class MapKind {
  kDepth,  ///< viridis; 0, negative and NaN are unknown
  kError,  ///< blue - white - red, symmetric about 0; NaN is unknown
};

/// Range of a colour scale in m. Values beyond it get the end colours, and that end of the scale bar is
/// pointed.
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

/// Arrangement and texts of a picture.
struct PictureLayout {
  std::string title;
  std::string caption = {};  ///< last line, e.g. command, seed and preset
  int panels_per_row = 1;
  int pixel_size = 0;  ///< screen pixels per map pixel; 0: automatic, 1..16, for a map about 480 wide
  std::optional<ColourRange> depth_range = std::nullopt;  ///< none: smallest to largest depth of all maps
  std::optional<double> largest_error = std::nullopt;     ///< m; none: holds 98 % of all |errors|
};

/// Draws the panels in a grid, with one scale bar for each kind of map. Throws InputError without panels, for
/// an illegal layout, or if the file cannot be written.
void write_map_picture(const std::filesystem::path& path, std::span<const MapPanel> panels,
                       const PictureLayout& layout);

/// Smallest and largest known depth of all panels; widened if they are equal, 0..1 m if no depth is known.
ColourRange depth_range(std::span<const MapPanel> panels);

/// Half range of a symmetric scale that holds 98 % of all |errors|, m; at least 1 mm.
double error_range(std::span<const MapPanel> panels);

}  // namespace dtof
