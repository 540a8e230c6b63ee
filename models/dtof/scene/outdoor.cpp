// SPDX-License-Identifier: Apache-2.0
#include "dtof/scene/outdoor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "dtof/core/random.hpp"

namespace dtof {
namespace {

/// Uniform numbers of one shape of a scene.
class ShapeRandom {
 public:
  ShapeRandom(std::uint64_t seed, std::uint32_t kind, int shape)
      : random_(seed, static_cast<std::uint32_t>(RandomPurpose::kScene), kind,
                static_cast<std::uint32_t>(shape)) {}
  double between(double low, double high) { return std::lerp(low, high, random_.uniform()); }

 private:
  CounterRandom random_;
};

enum ShapeKind : std::uint32_t { kPlaneStrip = 1, kBranch, kLeaf, kPole };

void put_in_front(TargetMap& map, int column, int row, const PixelTarget& target) {
  if (column >= 0 && column < map.columns() && row >= 0 && row < map.rows() &&
      target.depth_m < map.at(column, row).depth_m) {
    map.at(column, row) = target;
  }
}

struct Line {
  double column;  // of its middle
  double row;
  double angle;  // from the row direction
  double length;
  double thickness;
  double first_depth_m;  // at its ends
  double last_depth_m;
  double reflectivity;
};

/// A pixel belongs to a line if its middle is at most half a thickness from the axis.
void draw(TargetMap& map, const Line& line) {
  const double right = std::cos(line.angle);
  const double down = std::sin(line.angle);
  const double half = 0.5 * (line.length * std::abs(right) + line.thickness) + 1.0;
  const int first = std::max(0, static_cast<int>(line.column - half));
  const int last = std::min(map.columns() - 1, static_cast<int>(line.column + half));
  for (int column = first; column <= last; ++column) {
    for (int row = 0; row < map.rows(); ++row) {
      const double x = column + 0.5 - line.column;
      const double y = row + 0.5 - line.row;
      const double along = (x * right + y * down) / line.length + 0.5;
      const double across = y * right - x * down;
      if (along >= 0.0 && along <= 1.0 && std::abs(across) <= 0.5 * line.thickness) {
        put_in_front(map, column, row,
                     {std::lerp(line.first_depth_m, line.last_depth_m, along), line.reflectivity});
      }
    }
  }
}

void draw_leaf(TargetMap& map, ShapeRandom& random, double reflectivity) {
  const double column = random.between(0.0, map.columns());
  const double row = random.between(0.0, map.rows());
  const double half_width = random.between(0.6, 4.0);
  const double half_height = random.between(0.6, 4.0);
  const PixelTarget leaf = {random.between(1.0, 3.5), reflectivity * random.between(0.3, 0.9)};
  for (int x = static_cast<int>(column - half_width) - 1; x <= static_cast<int>(column + half_width) + 1;
       ++x) {
    for (int y = static_cast<int>(row - half_height) - 1; y <= static_cast<int>(row + half_height) + 1; ++y) {
      if (std::hypot((x + 0.5 - column) / half_width, (y + 0.5 - row) / half_height) <= 1.0) {
        put_in_front(map, x, y, leaf);
      }
    }
  }
}

/// How many shapes an array gets that has `per_full_size` of them at 200 x 160 pixels.
int shape_count(const TargetMap& map, int per_full_size) {
  constexpr std::int64_t kFullSize = 32000;
  return static_cast<int>(std::int64_t{per_full_size} * map.columns() * map.rows() / kFullSize);
}

}  // namespace

TargetMap make_planes(int columns, int rows, double reflectivity, std::uint64_t seed) {
  constexpr int kStrips = 28;
  constexpr int kShuffle = 11;  // has no factor in common with the strips: neighbours differ in reflectivity
  TargetMap map(columns, rows);
  for (int column = 0; column < columns; ++column) {
    const auto strip = static_cast<int>(std::int64_t{column} * kStrips / columns);
    ShapeRandom random(seed, kPlaneStrip, strip);
    double top_m = random.between(0.5, 2.5);
    double bottom_m = random.between(2.0, 5.0);
    if (strip % 2 == 1) {
      std::swap(top_m, bottom_m);
    }
    const double share = static_cast<double>(strip * kShuffle % kStrips) / (kStrips - 1);
    for (int row = 0; row < rows; ++row) {
      map.at(column, row) = {std::lerp(top_m, bottom_m, (row + 0.5) / rows),
                             reflectivity * std::lerp(0.1, 0.9, share)};
    }
  }
  return map;
}

TargetMap make_clutter(int columns, int rows, double reflectivity, std::uint64_t seed) {
  TargetMap map(columns, rows);
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      map.at(column, row) = {std::lerp(4.5, 3.5, (row + 0.5) / rows), 0.5 * reflectivity};
    }
  }
  for (int branch = 0; branch < shape_count(map, 60); ++branch) {
    ShapeRandom random(seed, kBranch, branch);
    const double depth_m = random.between(1.0, 3.4);
    draw(map, {random.between(0.0, columns), random.between(0.0, rows), random.between(0.0, std::numbers::pi),
               random.between(20.0, 120.0), random.between(1.0, 3.0), depth_m,
               depth_m + random.between(-0.2, 0.2), reflectivity * random.between(0.2, 0.6)});
  }
  for (int leaf = 0; leaf < shape_count(map, 800); ++leaf) {
    ShapeRandom random(seed, kLeaf, leaf);
    draw_leaf(map, random, reflectivity);
  }
  return map;
}

TargetMap make_poles(int columns, int rows, double reflectivity, std::uint64_t seed) {
  TargetMap map(columns, rows, {4.0, 0.6 * reflectivity});
  for (int pole = 0; pole < shape_count(map, 40); ++pole) {
    ShapeRandom random(seed, kPole, pole);
    const double depth_m = random.between(0.8, 3.4);
    draw(map, {random.between(0.0, columns), random.between(0.0, rows), random.between(0.0, std::numbers::pi),
               random.between(40.0, 300.0), random.between(1.0, 3.0), depth_m,
               depth_m + random.between(0.0, 0.1), reflectivity * random.between(0.2, 0.9)});
  }
  return map;
}

TargetMap make_isolated(int columns, int rows, double reflectivity) {
  constexpr int kRowPitch = 20;
  constexpr int kStagger = 7;
  TargetMap map(columns, rows, {4.0, reflectivity});
  for (int column = 0; column < columns; ++column) {
    for (int row = column * kStagger % kRowPitch; row < rows; row += kRowPitch) {
      map.at(column, row).depth_m = 3.0;
    }
  }
  return map;
}

TargetMap make_sky(int columns, int rows, double reflectivity) {
  constexpr int kPattern = 34;
  constexpr int kTeeth = 12;  // columns of a tooth of the wall's top
  constexpr int kToothRows = 8;
  constexpr int kBoxRows = 14;
  const int middle = rows / 2;
  const double surface = 0.5 * reflectivity;
  TargetMap map(columns, rows, {0.0, reflectivity});
  for (int column = 0; column < columns; ++column) {
    const int top = middle - kToothRows / 2 + column % kTeeth * kToothRows / kTeeth;
    const int place = column % kPattern;
    const bool box = place >= 4 && place < 12;
    const bool thin = place == 18;
    const bool pole = place == 26 || place == 27;
    for (int row = 0; row < rows; ++row) {
      if (thin) {
        map.at(column, row) = {2.0, surface};
      } else if (pole || (box && row >= middle - kBoxRows)) {
        map.at(column, row) = {3.0, surface};
      } else if (row >= top) {
        map.at(column, row) = {4.0, surface};
      }
    }
  }
  return map;
}

}  // namespace dtof
