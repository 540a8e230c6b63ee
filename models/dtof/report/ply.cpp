// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/ply.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/report/colour_map.hpp"

namespace dtof {

void write_ply(const std::filesystem::path& path, const DepthImage& image, const ColourRange& range,
               double degrees_per_pixel) {
  static_assert(std::endian::native == std::endian::little);
  if (const std::string obstacle = ply_obstacle(image.width, image.height, degrees_per_pixel);
      !obstacle.empty()) {
    throw InputError(fmt::format("{}: {}", path.string(), obstacle));
  }
  std::string vertices;
  std::size_t count = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const double depth = image.at(column, row);
      if (!is_known_distance(depth)) {
        continue;
      }
      const Point point = point_of_pixel(image, column, row, degrees_per_pixel);
      const auto bytes = std::bit_cast<std::array<char, sizeof point>>(point);
      vertices.append(bytes.data(), bytes.size());
      for (const double channel : viridis((depth - range.lowest) / (range.highest - range.lowest))) {
        vertices += static_cast<char>(static_cast<unsigned char>(std::lround(channel * 255.0)));
      }
      ++count;
    }
  }
  AtomicFile file(path);
  file.append(fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", count));
  for (const char* const axis : {"x", "y", "z"}) {
    file.append(fmt::format("property float {}\n", axis));
  }
  for (const char* const channel : {"red", "green", "blue"}) {
    file.append(fmt::format("property uchar {}\n", channel));
  }
  file.append("end_header\n");
  file.append(vertices);
  file.commit();
}

}  // namespace dtof
