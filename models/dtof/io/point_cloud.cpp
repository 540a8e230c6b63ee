// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/point_cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they stand in memory");

bool is_text(PointCloudFormat format) {
  return format == PointCloudFormat::kPlyText || format == PointCloudFormat::kPcdText;
}

std::string ply_header(std::span<const std::string> names, std::size_t points, bool text) {
  std::string header =
      fmt::format("ply\nformat {} 1.0\nelement vertex {}\n", text ? "ascii" : "binary_little_endian", points);
  for (const std::string& name : names) {
    header += fmt::format("property float {}\n", name);
  }
  return header + "end_header\n";
}

std::string pcd_header(std::span<const std::string> names, std::size_t points, bool text) {
  std::string fields;
  std::string sizes;
  std::string types;
  std::string counts;
  for (const std::string& name : names) {
    fields += " " + name;
    sizes += " 4";
    types += " F";
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\nCOUNT{}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      fields, sizes, types, counts, points, points, text ? "ascii" : "binary");
}

void append_point(AtomicFile& file, std::span<const float> numbers, bool text) {
  if (!text) {
    file.append({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
    return;
  }
  std::string line;
  for (const float number : numbers) {
    line += fmt::format("{}{}", line.empty() ? "" : " ", number);
  }
  file.append(line + "\n");
}

}  // namespace

Point point_of_pixel(const DepthImage& image, int column, int row, double degrees_per_pixel) {
  const double radians = degrees_per_pixel * std::numbers::pi / 180.0;
  const double azimuth = (column - (image.width - 1) / 2.0) * radians;
  const double elevation = (row - (image.height - 1) / 2.0) * radians;
  const double range = image.at(column, row);
  return {.x = static_cast<float>(range * std::sin(azimuth) * std::cos(elevation)),
          .y = static_cast<float>(range * std::sin(elevation)),
          .z = static_cast<float>(range * std::cos(azimuth) * std::cos(elevation))};
}

std::string ply_obstacle(int width, int height, double degrees_per_pixel) {
  if (degrees_per_pixel > 0.0 && std::max(width, height) * degrees_per_pixel < 180.0) {
    return "";
  }
  return fmt::format(
      "a point cloud of {} x {} pixels of {:g} degrees each: its sides must be above 0 and below 180 degrees",
      width, height, degrees_per_pixel);
}

bool is_known_distance(double metres) { return std::isfinite(metres) && metres > 0.0; }

void write_point_cloud(const std::filesystem::path& path, const DepthImage& image,
                       std::span<const PointField> fields, PointCloudFormat format,
                       double degrees_per_pixel) {
  if (const std::string obstacle = ply_obstacle(image.width, image.height, degrees_per_pixel);
      !obstacle.empty()) {
    throw InputError(fmt::format("{}: {}", path.string(), obstacle));
  }
  std::vector<std::string> names = {"x", "y", "z"};
  for (const PointField& field : fields) {
    if (field.values.size() != image.metres.size()) {
      throw std::logic_error("write_point_cloud: a field has another size than the image");
    }
    names.push_back(field.name);
  }
  const auto points =
      static_cast<std::size_t>(std::count_if(image.metres.begin(), image.metres.end(), is_known_distance));
  const bool text = is_text(format);
  const bool ply = format == PointCloudFormat::kPly || format == PointCloudFormat::kPlyText;
  AtomicFile file(path);
  file.append(ply ? ply_header(names, points, text) : pcd_header(names, points, text));
  std::vector<float> numbers(names.size());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      if (!is_known_distance(image.at(column, row))) {
        continue;
      }
      const Point point = point_of_pixel(image, column, row, degrees_per_pixel);
      numbers.assign({point.x, point.y, point.z});
      const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(column);
      for (const PointField& field : fields) {
        numbers.push_back(field.values[pixel]);
      }
      append_point(file, numbers, text);
    }
  }
  file.commit();
}

}  // namespace dtof
