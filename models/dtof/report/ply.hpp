// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "dtof/io/depth_image.hpp"
#include "dtof/io/point_cloud.hpp"
#include "dtof/report/colour_png.hpp"

namespace dtof {

/// Writes the known pixels as a binary little-endian PLY (x, y, z float m; red, green, blue), coloured by
/// depth over `range`. Throws InputError if ply_obstacle is not empty.
void write_ply(const std::filesystem::path& path, const DepthImage& image, const ColourRange& range,
               double degrees_per_pixel = kPixelAngle);

}  // namespace dtof
