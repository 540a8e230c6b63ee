// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/enlarger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

std::size_t pixels_of(int columns, int rows) {
  return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
}

/// The two spots around a coordinate and how far it is from the first to the second one.
struct Between {
  int first;
  int second;
  double share;
};

std::vector<Between> between_spots(const std::vector<int>& spots, int count) {
  std::vector<Between> all;
  const auto last = static_cast<int>(spots.size()) - 1;
  for (int i = 0; i < count; ++i) {
    const auto right = static_cast<int>(std::ranges::upper_bound(spots, i) - spots.begin());
    if (right == 0 || right > last) {
      const int end = right == 0 ? 0 : last;
      all.push_back({end, end, 0.0});
      continue;
    }
    const int begin = spots[static_cast<std::size_t>(right - 1)];
    const int end = spots[static_cast<std::size_t>(right)];
    all.push_back({right - 1, right, static_cast<double>(i - begin) / (end - begin)});
  }
  return all;
}

}  // namespace

void check_small_map(const SmallMap& map) {
  const std::size_t pixels = pixels_of(map.grid.small_columns(), map.grid.small_rows());
  if (map.distance_m.size() != pixels || map.confidence.size() != pixels) {
    throw InputError(fmt::format("a small map of {} x {} pixels cannot have {} distances and {} confidences",
                                 map.grid.small_columns(), map.grid.small_rows(), map.distance_m.size(),
                                 map.confidence.size()));
  }
}

void check_image(const SmallMap& map, const IntensityImage& image) {
  if (image.columns != map.grid.columns || image.rows != map.grid.rows ||
      image.values.size() != pixels_of(image.columns, image.rows)) {
    throw InputError(
        fmt::format("an intensity image of {} x {} pixels with {} values cannot guide a map of "
                    "{} x {} pixels",
                    image.columns, image.rows, image.values.size(), map.grid.columns, map.grid.rows));
  }
}

std::vector<double> enlarge_nearest(const SmallMap& map) {
  check_small_map(map);
  std::vector<double> large;
  large.reserve(pixels_of(map.grid.columns, map.grid.rows));
  for (int row = 0; row < map.grid.rows; ++row) {
    const int j = nearest_spot(map.grid.y, row);
    for (int column = 0; column < map.grid.columns; ++column) {
      large.push_back(map.distance(nearest_spot(map.grid.x, column), j));
    }
  }
  return large;
}

std::vector<double> enlarge_bilinear(const SmallMap& map) {
  check_small_map(map);
  const std::vector<Between> across = between_spots(map.grid.x, map.grid.columns);
  const std::vector<Between> down = between_spots(map.grid.y, map.grid.rows);
  std::vector<double> large;
  large.reserve(pixels_of(map.grid.columns, map.grid.rows));
  for (const Between& y : down) {
    for (const Between& x : across) {
      const double above =
          std::lerp(map.distance(x.first, y.first), map.distance(x.second, y.first), x.share);
      const double below =
          std::lerp(map.distance(x.first, y.second), map.distance(x.second, y.second), x.share);
      large.push_back(std::lerp(above, below, y.share));
    }
  }
  return large;
}

std::vector<double> enlarge_joint_bilateral(const SmallMap& map, const IntensityImage& image,
                                            const JointBilateral& widths) {
  constexpr int kReach = 2;
  check_small_map(map);
  check_image(map, image);
  if (!(widths.spatial > 0.0) || !(widths.range > 0.0)) {
    throw InputError(fmt::format("a joint bilateral filter's widths are above 0, not {:g} and {:g}",
                                 widths.spatial, widths.range));
  }
  const SpotGrid& grid = map.grid;
  const std::vector<double> bright = brightness(image);
  const auto bright_at = [&](int column, int row) {
    return bright[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                  static_cast<std::size_t>(column)];
  };
  const double pitch_x = static_cast<double>(grid.columns) / grid.small_columns();
  const double pitch_y = static_cast<double>(grid.rows) / grid.small_rows();
  std::vector<double> large;
  large.reserve(pixels_of(grid.columns, grid.rows));
  for (int row = 0; row < grid.rows; ++row) {
    const int middle_j = nearest_spot(grid.y, row);
    for (int column = 0; column < grid.columns; ++column) {
      const int middle_i = nearest_spot(grid.x, column);
      double weights = 0.0;
      double weighted = 0.0;
      for (int j = std::max(0, middle_j - kReach); j <= std::min(grid.small_rows() - 1, middle_j + kReach);
           ++j) {
        for (int i = std::max(0, middle_i - kReach);
             i <= std::min(grid.small_columns() - 1, middle_i + kReach); ++i) {
          const int x = grid.x[static_cast<std::size_t>(i)];
          const int y = grid.y[static_cast<std::size_t>(j)];
          const double away = std::hypot((column - x) / pitch_x, (row - y) / pitch_y) / widths.spatial;
          const double unlike = (bright_at(column, row) - bright_at(x, y)) / widths.range;
          const double weight = std::exp(-0.5 * (away * away + unlike * unlike));
          weights += weight;
          weighted += weight * map.distance(i, j);
        }
      }
      large.push_back(weights > 0.0 ? weighted / weights : map.distance(middle_i, middle_j));
    }
  }
  return large;
}

}  // namespace dtof
