// SPDX-License-Identifier: Apache-2.0
#include "dtof/scene/sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/scene/room.hpp"

namespace dtof {
namespace {

constexpr double kFirstKlux = 2.0;
constexpr double kLastKlux = 50.0;
constexpr double kDegreesPerColumn = 0.48;  // of the room, at 200 columns

struct Description {
  Motion motion;
  std::string_view name;
  std::string_view summary;
};

constexpr std::array<Description, kAllMotions.size()> kDescriptions = {{
    {Motion::kStill, "still", "nothing moves"},
    {Motion::kPan, "pan", "the camera turns to the right"},
    {Motion::kRoll, "roll", "the camera turns about its axis (room alone)"},
    {Motion::kObject, "object", "the sphere moves to the right (room alone)"},
    {Motion::kCut, "cut", "in the middle frame the scene becomes its mirror image"},
    {Motion::kLight, "light", "the light changes from 2 to 50 klux"},
}};

const Description& description(Motion motion) {
  return *std::ranges::find(kDescriptions, motion, &Description::motion);
}

void validate(const Sequence& sequence, int frame) {
  if (sequence.frames < 2 || frame < 0 || frame >= sequence.frames) {
    throw InputError(fmt::format("a video needs at least 2 frames, and frame {} is none of its {}", frame,
                                 sequence.frames));
  }
  if (!std::isfinite(sequence.speed) || sequence.speed <= 0.0) {
    throw InputError(fmt::format("the speed must be above 0, not {}", sequence.speed));
  }
  if (!has_motion(sequence.scene, sequence.motion)) {
    throw InputError(fmt::format("motion {} is one of the room, not of scene {}",
                                 motion_name(sequence.motion), scene_name(sequence.scene)));
  }
  if (sequence.scene != Scene::kRoom && sequence.motion == Motion::kPan &&
      sequence.speed != std::floor(sequence.speed)) {
    throw InputError(fmt::format("scene {} pans by whole columns per frame, not by {}",
                                 scene_name(sequence.scene), sequence.speed));
  }
}

/// The room as it is seen in this frame.
RoomView view_of(const Sequence& sequence, int frame) {
  const double way = sequence.speed * frame;
  RoomView view;
  switch (sequence.motion) {
    case Motion::kPan:
      view.pan_degrees = way * kDegreesPerColumn;
      break;
    case Motion::kRoll:
      view.roll_degrees = way;
      break;
    case Motion::kObject:
      view.sphere_right_m = 0.01 * way;
      break;
    default:
      break;
  }
  return view;
}

/// `columns` columns of a wider map, from column `first` on.
TargetMap window(const TargetMap& map, int first, int columns) {
  TargetMap part(columns, map.rows());
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < map.rows(); ++row) {
      part.at(column, row) = map.at(first + column, row);
    }
  }
  return part;
}

TargetMap mirrored(const TargetMap& map) {
  TargetMap image(map.columns(), map.rows());
  for (int column = 0; column < map.columns(); ++column) {
    for (int row = 0; row < map.rows(); ++row) {
      image.at(column, row) = map.at(map.columns() - 1 - column, row);
    }
  }
  return image;
}

TargetMap targets_of(const Sequence& sequence, int frame) {
  SceneParameters parameters = sequence.parameters;
  if (sequence.scene == Scene::kRoom) {
    return make_room(parameters.columns, parameters.rows, parameters.reflectivity, view_of(sequence, frame));
  }
  if (sequence.motion == Motion::kPan) {
    const int step = static_cast<int>(sequence.speed);
    const int columns = parameters.columns;
    parameters.columns += step * (sequence.frames - 1);
    return window(make_scene(sequence.scene, parameters), step * frame, columns);
  }
  return make_scene(sequence.scene, parameters);
}

}  // namespace

std::string_view motion_name(Motion motion) { return description(motion).name; }

bool has_motion(Scene scene, Motion motion) {
  return scene == Scene::kRoom || (motion != Motion::kRoll && motion != Motion::kObject);
}

std::string_view motion_summary(Motion motion) { return description(motion).summary; }

Motion parse_motion(std::string_view name) {
  std::vector<std::string_view> known;
  for (const Description& each : kDescriptions) {
    if (each.name == name) {
      return each.motion;
    }
    known.push_back(each.name);
  }
  throw InputError(unknown_name("motion", name, known));
}

int cut_frame(const Sequence& sequence) { return sequence.frames / 2; }

SequenceFrame sequence_frame(const Sequence& sequence, int frame) {
  validate(sequence, frame);
  TargetMap targets = targets_of(sequence, frame);
  if (sequence.motion == Motion::kCut && frame >= cut_frame(sequence)) {
    targets = mirrored(targets);
  }
  const double part = static_cast<double>(frame) / (sequence.frames - 1);
  const double klux =
      sequence.motion == Motion::kLight ? kFirstKlux * std::pow(kLastKlux / kFirstKlux, part) : sequence.klux;
  return {std::move(targets), klux};
}

}  // namespace dtof
