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

/// Share of the light that a surface sends back, for each pixel; 0 or more.
struct ReflectivityImage {
  int width = 0;
  int height = 0;
  std::vector<float> values = {};  ///< [row][column], row 0 on top
};

// Maps are PNGs of 8 or 16 bits, PFMs ("Pf") or NPY arrays of shape (rows, columns), told apart by content;
// at most 65535 pixels in a row or column and, as a PNG, 2^26 in all. A PNG is grey: as greyscale or with
// red, green and blue equal in every pixel. Its pixels may be transparent, by alpha below its largest value
// or by the key of a tRNS chunk: such a pixel has no value. The magnitude of a PFM's scale multiplies its
// numbers, the sign is their byte order. An NPY's axes of one element before or behind the two are left out.
// A file is read once. Readers throw InputError "<path>: <reason>" for anything else, a damaged file, a scale
// that is not above 0, or a value that the map cannot hold.

/// Distances in m: the file's numbers times `metres_per_unit`, by default 0.001 for a PNG of 16 bits and 1
/// for PFM and NPY; a PNG of 8 bits has no default. Numbers that are 0, NaN or infinite and transparent
/// pixels are unknown and become 0; negative ones are refused.
DepthImage read_depth_image(const std::filesystem::path& path,
                            std::optional<double> metres_per_unit = std::nullopt);

/// The same of an array that `path` has given.
DepthImage depth_image_of(const std::filesystem::path& path, NpyArray array,
                          std::optional<double> metres_per_unit = std::nullopt);

/// The file's numbers times `per_unit`; by default a PNG's full range becomes 0 to 1, and PFM and NPY are
/// taken as they are. Negative numbers, NaN, infinity and transparent pixels are refused.
ReflectivityImage read_reflectivity_image(const std::filesystem::path& path,
                                          std::optional<double> per_unit = std::nullopt);

/// Disparity map as a grey PNG of 8 bits (e.g. Middlebury stereo; 0 or transparent = unknown); depth =
/// `metres_at_one` / disparity.
DepthImage read_disparity_png(const std::filesystem::path& path, double metres_at_one);

/// A photograph as an 8-bit greyscale or RGB PNG of gamma 2.2; its relative luminance, 0 to 1, stands for the
/// reflectivity. Throws InputError as the others do.
ReflectivityImage read_photograph(const std::filesystem::path& path);

/// Why a map does not fit a PNG of 16 bits in mm: a depth above 65.535 m. Empty if it fits.
std::string depth_png_obstacle(const DepthImage& image);

/// Rounds to millimetres; unknown, 0 and negative depths become 0. Throws InputError for what
/// depth_png_obstacle says.
void write_depth_png(const std::filesystem::path& path, const DepthImage& image);

/// Little-endian PFM, any values.
void write_pfm(const std::filesystem::path& path, const DepthImage& image);

}  // namespace dtof
