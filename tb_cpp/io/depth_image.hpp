// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

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

/// Reads a 16-bit greyscale PNG in millimetres (0 = unknown) or a greyscale PFM in metres, told apart by
/// content. Throws InputError "<path>: <reason>".
DepthImage read_depth_image(const std::filesystem::path& path);

/// 16-bit greyscale PNG, millimetres, 0 = unknown. Throws InputError for another bit depth or colour type, or
/// a damaged file.
DepthImage read_depth_png(const std::filesystem::path& path);

/// PFM ("Pf", scale 1 or -1: big- or little-endian), metres. Values that are 0, NaN or infinite are unknown.
/// Throws InputError for a colour PFM, another scale, a negative depth or a wrong number of bytes.
DepthImage read_depth_pfm(const std::filesystem::path& path);

/// Disparity map as an 8-bit greyscale PNG (e.g. Middlebury stereo, 0 = unknown); depth = `metres_at_one` /
/// disparity.
DepthImage read_disparity_png(const std::filesystem::path& path, double metres_at_one);

/// Rounds to millimetres; unknown, 0 and negative depths become 0. Throws InputError for a depth above 65.535
/// m.
void write_depth_png(const std::filesystem::path& path, const DepthImage& image);

/// Little-endian PFM, any values.
void write_pfm(const std::filesystem::path& path, const DepthImage& image);

}  // namespace dtof
