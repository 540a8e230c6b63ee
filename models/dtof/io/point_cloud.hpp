// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dtof/io/depth_image.hpp"

namespace dtof {

/// Field of view of one pixel, degrees (AFOV, spec section 4).
inline constexpr double kPixelAngle = 0.48;

/// A point in m, from a range along a pixel's ray. The projection is equiangular: column and row each turn
/// the ray by `degrees_per_pixel` about the image's middle. Camera axes: x right, y down, z ahead.
struct Point {
  float x;
  float y;
  float z;
};
Point point_of_pixel(const DepthImage& image, int column, int row, double degrees_per_pixel = kPixelAngle);

/// Why an image of this size has no point cloud: a ray would turn by 90 degrees or more, e.g. with 375 pixels
/// of 0.48 degrees. Empty if it has one.
std::string ply_obstacle(int width, int height, double degrees_per_pixel = kPixelAngle);

/// True if the pixel has a point: its distance is finite and above 0.
bool is_known_distance(double metres);

/// A number per pixel that is stored with its point, e.g. the confidence.
struct PointField {
  std::string name;           ///< letters, digits and _
  std::vector<float> values;  ///< [row][column], as many as the image has pixels
};

/// Formats: PLY (Stanford) and PCD 0.7 (Point Cloud Library), each with little-endian binary numbers or as
/// text.
enum class PointCloudFormat { kPly, kPlyText, kPcd, kPcdText };

/// Writes the known pixels in image order: x, y, z in m, then the fields, all as float. Throws InputError if
/// ply_obstacle is not empty, std::logic_error if a field and the image differ in size.
void write_point_cloud(const std::filesystem::path& path, const DepthImage& image,
                       std::span<const PointField> fields, PointCloudFormat format, double degrees_per_pixel);

}  // namespace dtof
