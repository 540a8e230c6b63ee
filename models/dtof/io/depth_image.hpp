// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dtof/io/npy.hpp"

namespace dtof {

/// A map in metres: depth (0 or NaN = unknown) or a signed error (NaN = unknown).
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<float> metres = {};  ///< [row][column], row 0 on top

  [[nodiscard]] float at(int column, int row) const {
    return metres[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(column)];
  }
};

/// Reflectivity of the surface in each pixel; 0 or more.
struct ReflectivityImage {
  int width = 0;
  int height = 0;
  std::vector<float> values = {};  ///< [row][column], row 0 on top
};

// Maps are PNGs of 8 or 16 bits, PFMs ("Pf") or NPY arrays of shape (rows, columns); the format is recognised
// by content. Limits: 65535 pixels in a row or column, for PNG also 2^26 in all.
// PNG: grey, either greyscale or with equal red, green and blue in every pixel. A transparent pixel (alpha
// below its largest value, or the key of a tRNS chunk) has no value.
// PFM: the magnitude of the scale multiplies the numbers, its sign gives the byte order.
// NPY: leading and trailing axes of one element are dropped.
// A file is read once. Readers throw InputError "<path>: <reason>" for any other format, a damaged file, a
// scale that is not above 0, or a value that the map cannot hold.

/// Reads distances in m: the file's numbers times `metres_per_unit`. The default is 0.001 for a PNG of 16
/// bits and 1 for PFM and NPY; a PNG of 8 bits has none. Numbers that are 0, NaN or infinite and transparent
/// pixels are unknown and become 0. Throws InputError for negative numbers.
DepthImage read_depth_image(const std::filesystem::path& path,
                            std::optional<double> metres_per_unit = std::nullopt);

/// Converts an array that was read from `path`, as read_depth_image does.
DepthImage depth_image_of(const std::filesystem::path& path, NpyArray array,
                          std::optional<double> metres_per_unit = std::nullopt);

/// Reads reflectivities: the file's numbers times `per_unit`. By default a PNG's full range maps to 0 .. 1,
/// and PFM and NPY numbers stay unchanged. Throws InputError for negative numbers, NaN, infinity and
/// transparent pixels.
ReflectivityImage read_reflectivity_image(const std::filesystem::path& path,
                                          std::optional<double> per_unit = std::nullopt);

/// Reads a disparity map, a grey PNG of 8 bits (e.g. Middlebury stereo; 0 or transparent = unknown). Depth in
/// m = `metres_at_one` / disparity.
DepthImage read_disparity_png(const std::filesystem::path& path, double metres_at_one);

/// Reads a photograph, an 8-bit greyscale or RGB PNG of gamma 2.2, as reflectivities: the relative luminance,
/// 0 .. 1. Throws InputError as read_reflectivity_image does.
ReflectivityImage read_photograph(const std::filesystem::path& path);

/// Why a map cannot be written as a PNG of 16 bits in mm (a depth above 65.535 m); empty if it can.
std::string depth_png_obstacle(const DepthImage& image);

/// Writes depths in mm, rounded, as a PNG of 16 bits; unknown, 0 and negative depths become 0. Throws
/// InputError if depth_png_obstacle is not empty.
void write_depth_png(const std::filesystem::path& path, const DepthImage& image);

/// Writes a little-endian PFM; any values.
void write_pfm(const std::filesystem::path& path, const DepthImage& image);

}  // namespace dtof
