// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "dtof/io/depth_image.hpp"
#include "dtof/report/colour_png.hpp"

namespace dtof {

/// Angle of view of one pixel (AFOV, spec section 4), degrees.
inline constexpr double kPixelAngle = 0.48;

/// Point of a range measured along the ray of a pixel. Equiangular: a pixel's column and row turn the ray by
/// `degrees_per_pixel` each about the image's middle. Axes as cameras have them: x right, y down, z ahead; m.
struct Point {
  float x;
  float y;
  float z;
};
Point point_of_pixel(const DepthImage& image, int column, int row, double degrees_per_pixel = kPixelAngle);

/// Why an image of so many pixels has no point cloud: a ray would turn by 90 degrees or more, as with 375
/// pixels of 0.48 degrees. Empty if it has one.
std::string ply_obstacle(int width, int height, double degrees_per_pixel = kPixelAngle);

/// Writes the known pixels as a binary little-endian PLY (x, y, z float m; red, green, blue), coloured by
/// depth over `range`. Throws InputError for what ply_obstacle says.
void write_ply(const std::filesystem::path& path, const DepthImage& image, const ColourRange& range,
               double degrees_per_pixel = kPixelAngle);

}  // namespace dtof
