// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dtof/io/depth_image.hpp"

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

/// Whether the pixel has a point: its distance is finite and above 0.
bool is_known_distance(double metres);

/// A number of each pixel that its point takes along, for instance the confidence.
struct PointField {
  std::string name;           ///< letters, digits and _
  std::vector<float> values;  ///< [row][column], as many as the image has pixels
};

/// PLY (Stanford) and PCD 0.7 (Point Cloud Library), each as little-endian numbers or as text.
enum class PointCloudFormat { kPly, kPlyText, kPcd, kPcdText };

/// Writes the known pixels in the order of the image: x, y, z in m, then the fields, all as float. Throws
/// InputError for what ply_obstacle says, std::logic_error for a field of another size.
void write_point_cloud(const std::filesystem::path& path, const DepthImage& image,
                       std::span<const PointField> fields, PointCloudFormat format, double degrees_per_pixel);

}  // namespace dtof
