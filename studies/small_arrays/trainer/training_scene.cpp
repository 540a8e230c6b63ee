// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/trainer/training_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dtof/core/random.hpp"

namespace dtof {
namespace {

class Draw {
 public:
  Draw(std::uint64_t seed, std::uint32_t scene, std::uint32_t shape)
      : random_(seed, static_cast<std::uint32_t>(RandomPurpose::kTrainingScene), scene, shape) {}
  double between(double low, double high) { return std::lerp(low, high, random_.uniform()); }
  /// Small and large ones alike.
  double log_between(double low, double high) { return low * std::pow(high / low, random_.uniform()); }
  int below(int count) { return static_cast<int>(random_.uniform() * count); }
  bool chance(double probability) { return random_.uniform() < probability; }

 private:
  CounterRandom random_;
};

/// Reflectivity over a surface.
class Texture {
 public:
  explicit Texture(Draw& draw)
      : kind_(draw.below(4)),
        first_(draw.log_between(0.05, 1.0)),
        second_(draw.log_between(0.05, 1.0)),
        period_(draw.log_between(3.0, 60.0)),
        angle_(draw.between(0.0, std::numbers::pi)),
        phase_(draw.between(0.0, period_)) {}

  [[nodiscard]] double at(double x, double y) const {
    const double along = (x * std::cos(angle_) + y * std::sin(angle_) + phase_) / period_;
    const double across = (y * std::cos(angle_) - x * std::sin(angle_)) / period_;
    const auto odd = [](double value) { return std::fmod(std::abs(std::floor(value)), 2.0) == 1.0; };
    switch (kind_) {
      case 0:
        return first_;
      case 1:
        return odd(along) ? second_ : first_;
      case 2:
        return odd(along) != odd(across) ? second_ : first_;
      default:
        return std::lerp(first_, second_, 0.5 + 0.25 * (std::sin(4.0 * along) + std::sin(5.0 * across)));
    }
  }

 private:
  int kind_;
  double first_;
  double second_;
  double period_;
  double angle_;
  double phase_;
};

/// Depth that changes linearly over the map.
struct Plane {
  double depth_m;
  double right;  // m a pixel
  double down;

  [[nodiscard]] double at(double x, double y) const {
    constexpr double kNearest = 0.4;
    constexpr double kFarthest = 6.0;
    return std::clamp(depth_m + x * right + y * down, kNearest, kFarthest);
  }
};

void put_walls(TargetMap& map, std::uint64_t seed, std::uint32_t number) {
  Draw draw(seed, number, 0);
  const int walls = 2 + draw.below(3);
  double begin = 0.0;
  for (int wall = 0; wall < walls; ++wall) {
    const Texture texture(draw);
    const Plane plane{draw.between(2.0, 5.5), draw.between(-0.03, 0.03), draw.between(-0.02, 0.02)};
    const double end = wall + 1 == walls ? map.columns() : begin + draw.between(0.2, 0.6) * map.columns();
    const double lean = draw.chance(0.5) ? draw.between(-0.3, 0.3) : 0.0;
    for (int row = 0; row < map.rows(); ++row) {
      const double left = wall == 0 ? 0.0 : std::max(0.0, begin + lean * row);
      for (int column = static_cast<int>(left); column < map.columns(); ++column) {
        map.at(column, row) = {plane.at(column - begin, row - 0.5 * map.rows()), texture.at(column, row)};
      }
    }
    begin = end;
  }
}

void put_shape(TargetMap& map, Draw& draw) {
  const int kind = draw.below(3);  // ellipse, box, bar
  const double x = draw.between(0.0, map.columns());
  const double y = draw.between(0.0, map.rows());
  const double half_width = 0.5 * draw.log_between(2.0, 100.0);
  const double half_height =
      kind == 2 ? 0.5 * draw.log_between(1.0, 6.0) : half_width * draw.log_between(0.4, 2.5);
  const double angle = draw.chance(0.4) ? 0.0 : draw.between(0.0, std::numbers::pi);
  const bool flat = draw.chance(0.5);
  const double slope = flat ? 0.0 : 0.01;
  const Plane plane{draw.log_between(0.5, 4.0), draw.between(-slope, slope), draw.between(-slope, slope)};
  const Texture texture(draw);
  const bool hidden = draw.chance(0.2);  // by the texture of what lies behind
  const double reach = std::hypot(half_width, half_height) + 1.0;
  for (int column = std::max(0, static_cast<int>(x - reach));
       column < std::min<double>(map.columns(), x + reach); ++column) {
    for (int row = std::max(0, static_cast<int>(y - reach)); row < std::min<double>(map.rows(), y + reach);
         ++row) {
      const double right = column + 0.5 - x;
      const double down = row + 0.5 - y;
      const double u = (right * std::cos(angle) + down * std::sin(angle)) / half_width;
      const double v = (down * std::cos(angle) - right * std::sin(angle)) / half_height;
      const bool inside = kind == 0 ? u * u + v * v <= 1.0 : std::max(std::abs(u), std::abs(v)) <= 1.0;
      const double depth_m = plane.at(right, down);
      if (inside && depth_m < map.at(column, row).depth_m) {
        PixelTarget& target = map.at(column, row);
        target.depth_m = depth_m;
        target.reflectivity = hidden ? target.reflectivity : texture.at(right, down);
      }
    }
  }
}

}  // namespace

TargetMap make_training_scene(int columns, int rows, std::uint64_t seed, std::uint32_t number) {
  TargetMap map(columns, rows);
  put_walls(map, seed, number);
  Draw shapes(seed, number, 1);
  const int count = 10 + shapes.below(71);
  for (int shape = 0; shape < count; ++shape) {
    Draw draw(seed, number, 2 + static_cast<std::uint32_t>(shape));
    put_shape(map, draw);
  }
  return map;
}

}  // namespace dtof
