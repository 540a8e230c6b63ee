// SPDX-License-Identifier: Apache-2.0
#include "dtof/scene/room.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace dtof {
namespace {

/// Axes as cameras have them, sensor at the origin: x right, y down, z ahead; metres.
using Vector = std::array<double, 3>;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kWidthDegrees = 96.0;
constexpr double kHeightDegrees = 76.8;

struct Sphere {
  Vector centre;
  double radius;
  double reflectivity;
};

/// Axis-parallel.
struct Box {
  Vector low;
  Vector high;
  double reflectivity;
};

constexpr Vector kRoomLow = {-2.2, -1.4, -1.0};
constexpr Vector kRoomHigh = {2.2, 1.4, 4.2};
// By axis x, y, z, the reflectivity at its low and its high end: left, right; ceiling, floor; (behind the
// sensor), back.
constexpr std::array<std::array<double, 2>, 3> kRoomReflectivity = {{{0.6, 0.6}, {1.0, 0.3}, {0.0, 0.8}}};

constexpr Sphere kSphere = {{-0.45, 0.0, 1.6}, 0.5, 0.7};
constexpr std::array<Box, 4> kBoxes = {{
    {{0.15, 0.15, 0.78}, {0.55, 0.55, 1.1}, 0.2},  // near, dark
    {{0.9, -0.5, 2.3}, {1.5, 1.4, 2.8}, 0.5},      // tall, standing on the floor
    {{-1.9, 0.7, 2.6}, {-1.1, 1.4, 3.3}, 0.9},     // low, bright
    {{-0.2, -1.2, 3.4}, {0.6, -0.7, 3.6}, 0.35},   // hanging before the back wall
}};

/// Ranges at which the ray enters and leaves the box, with the axis of each; empty if it misses.
struct Passage {
  double enter;
  double leave;
  std::size_t leave_axis;
};
std::optional<Passage> cross(const Vector& direction, const Vector& low, const Vector& high) {
  Passage passage = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double first = low[axis] / direction[axis];
    double second = high[axis] / direction[axis];
    if (first > second) {
      std::swap(first, second);
    }
    passage.enter = std::max(passage.enter, first);
    if (second < passage.leave) {
      passage.leave = second;
      passage.leave_axis = axis;
    }
  }
  if (passage.enter > passage.leave || passage.leave <= 0.0) {
    return std::nullopt;
  }
  return passage;
}

/// What the sensor sees along `ahead` in its own axes, in those of the room.
Vector turned(const Vector& ahead, const RoomView& view) {
  const double roll = view.roll_degrees * kDegree;
  const double pan = view.pan_degrees * kDegree;
  const Vector rolled = {std::cos(roll) * ahead[0] - std::sin(roll) * ahead[1],
                         std::sin(roll) * ahead[0] + std::cos(roll) * ahead[1], ahead[2]};
  return {std::cos(pan) * rolled[0] + std::sin(pan) * rolled[2], rolled[1],
          std::cos(pan) * rolled[2] - std::sin(pan) * rolled[0]};
}

std::optional<double> range_to(const Sphere& sphere, const Vector& direction) {
  double along = 0.0;
  double distance_squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    along += direction[axis] * sphere.centre[axis];
    distance_squared += sphere.centre[axis] * sphere.centre[axis];
  }
  const double half_chord_squared = sphere.radius * sphere.radius - (distance_squared - along * along);
  if (half_chord_squared < 0.0) {
    return std::nullopt;
  }
  return along - std::sqrt(half_chord_squared);
}

PixelTarget look(const Vector& direction, const Sphere& sphere) {
  // The sensor is inside the room: the ray leaves it through a wall.
  const Passage walls = *cross(direction, kRoomLow, kRoomHigh);
  const std::size_t end = direction[walls.leave_axis] > 0.0 ? 1 : 0;
  PixelTarget nearest = {.depth_m = walls.leave, .reflectivity = kRoomReflectivity[walls.leave_axis][end]};
  if (const auto range = range_to(sphere, direction); range && *range > 0.0 && *range < nearest.depth_m) {
    nearest = {.depth_m = *range, .reflectivity = sphere.reflectivity};
  }
  for (const Box& box : kBoxes) {
    if (const auto passage = cross(direction, box.low, box.high);
        passage && passage->enter > 0.0 && passage->enter < nearest.depth_m) {
      nearest = {.depth_m = passage->enter, .reflectivity = box.reflectivity};
    }
  }
  return nearest;
}

/// Angle of a pixel's ray from the middle, over an equally divided field of view.
double pixel_angle(int index, int count, double field_degrees) {
  return ((index + 0.5) / count - 0.5) * field_degrees * kDegree;
}

}  // namespace

TargetMap make_room(int columns, int rows, double reflectivity, const RoomView& view) {
  TargetMap map(columns, rows);
  Sphere sphere = kSphere;
  sphere.centre[0] += view.sphere_right_m;
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const double yaw = pixel_angle(column, columns, kWidthDegrees);
      const double pitch = pixel_angle(row, rows, kHeightDegrees);
      const Vector ahead = {std::cos(pitch) * std::sin(yaw), std::sin(pitch),
                            std::cos(pitch) * std::cos(yaw)};
      PixelTarget target = look(turned(ahead, view), sphere);
      target.reflectivity *= reflectivity;
      map.at(column, row) = target;
    }
  }
  return map;
}

}  // namespace dtof
