// SPDX-License-Identifier: Apache-2.0
#include "src/scene.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/scene/scene.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"
#include "src/limits.hpp"

namespace dtof::python {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Map = InputArray<float>;

struct MapSize {
  int width;
  int height;
};

MapSize size_of(const Map& map, const char* name) {
  if (map.ndim() != 2) {
    throw InputError(fmt::format("{}: needs an array of two axes (rows, columns), not {}", name, map.ndim()));
  }
  return {static_cast<int>(map.shape(1)), static_cast<int>(map.shape(0))};
}

void set_reflectivities(TargetMap& targets, const Map& map) {
  const MapSize size = size_of(map, "reflectivity");
  set_reflectivity(targets, size.width, size.height, {map.data(), static_cast<std::size_t>(map.size())});
  check_reflectivities(targets);
}

using Reflectivity = std::variant<double, Map>;

constexpr const char* kOnlySloped = "only the scenes staircase and plane have a near and a far end";

SceneMap scene_of_depth(const Map& depth, const Reflectivity& reflectivity, const std::optional<int>& columns,
                        const std::optional<int>& rows) {
  const MapSize size = size_of(depth, "depth");
  const auto* share = std::get_if<double>(&reflectivity);
  check_size(columns.value_or(size.width), rows.value_or(size.height));
  check_reflectivity(share == nullptr ? 1.0 : *share);
  TargetMap targets = scene_from_depth_image(
      size.width, size.height, {depth.data(), static_cast<std::size_t>(depth.size())},
      columns.value_or(size.width), rows.value_or(size.height), share == nullptr ? 1.0 : *share);
  if (share == nullptr) {
    set_reflectivities(targets, std::get<Map>(reflectivity));
  }
  return {std::move(targets), "depth map"};
}

SceneMap scene_of_cube(const InputArray<double>& events, double bin_width_s, double start_s,
                       double events_per_unit, const std::optional<SensorModel>& sensor,
                       const std::optional<Reflectivity>& reflectivity, const std::optional<int>& columns,
                       const std::optional<int>& rows) {
  const std::vector<std::size_t> shape(events.shape(), events.shape() + events.ndim());
  const auto [width, height] = transient_cube_size(shape);
  const SensorModel thesis;
  const SensorModel& whose = sensor ? *sensor : thesis;
  const double* share = reflectivity ? std::get_if<double>(&*reflectivity) : nullptr;
  check_size(columns.value_or(width), rows.value_or(height));
  check_reflectivity(share == nullptr ? whose.default_reflectivity : *share);
  TargetMap targets = scene_from_transient_cube(
      shape, {events.data(), static_cast<std::size_t>(events.size())},
      {.bin_width_s = bin_width_s, .start_s = start_s, .events_per_unit = events_per_unit},
      whose.pulse_fwhm_s, columns.value_or(width), rows.value_or(height),
      share == nullptr ? whose.default_reflectivity : *share);
  if (reflectivity && share == nullptr) {
    set_reflectivities(targets, std::get<Map>(*reflectivity));
  }
  return {std::move(targets), "transient cube"};
}

SceneMap scene_of_name(const std::string& name, const std::optional<SensorModel>& sensor,
                       const std::optional<int>& columns, const std::optional<int>& rows,
                       const std::optional<Reflectivity>& reflectivity,
                       const std::optional<double>& distance_m, const std::optional<double>& near_m,
                       const std::optional<double>& far_m, const std::optional<int>& steps,
                       std::uint64_t seed) {
  const SensorModel thesis;
  const SensorModel& whose = sensor ? *sensor : thesis;
  const double* share = reflectivity ? std::get_if<double>(&*reflectivity) : nullptr;
  const Scene scene = parse_scene(name);
  const bool sloped = scene == Scene::kStaircase || scene == Scene::kPlane;
  refuse_without_effect(distance_m.has_value() && scene != Scene::kFlat, "distance_m",
                        "only the scene flat has one distance");
  refuse_without_effect(near_m.has_value() && !sloped, "near_m", kOnlySloped);
  refuse_without_effect(far_m.has_value() && !sloped, "far_m", kOnlySloped);
  refuse_without_effect(steps.has_value() && scene != Scene::kStaircase, "steps",
                        "only the scene staircase has steps");
  SceneParameters parameters{.columns = columns.value_or(whose.columns),
                             .rows = rows.value_or(whose.rows),
                             .reflectivity = share == nullptr ? whose.default_reflectivity : *share,
                             .seed = seed};
  check_size(parameters.columns, parameters.rows);
  check_reflectivity(parameters.reflectivity);
  parameters.distance_m = distance_m.value_or(parameters.distance_m);
  parameters.near_m = near_m.value_or(parameters.near_m);
  parameters.far_m = far_m.value_or(parameters.far_m);
  parameters.steps = steps.value_or(parameters.steps);
  TargetMap targets = make_scene(scene, parameters);
  if (reflectivity && share == nullptr) {
    set_reflectivities(targets, std::get<Map>(*reflectivity));
  }
  return {std::move(targets), name};
}

/// One number of each pixel, row by row, where it lies in the map.
py::array_t<double> pixel_array(const SceneMap& scene, double PixelTarget::*member) {
  const TargetMap& targets = *scene.targets;
  constexpr auto kStep = static_cast<py::ssize_t>(sizeof(PixelTarget));
  return shared_array<double>(scene.targets, &(targets.at(0, 0).*member), {targets.rows(), targets.columns()},
                              {kStep, kStep * targets.rows()});
}

}  // namespace

void bind_scenes(py::module_& module) {
  py::class_<SceneMap>(
      module, "Scene",
      "A scene in front of the sensor: a distance and a reflectivity for each pixel. scenes() has the names. "
      "Size and\nreflectivity are the sensor's by default; reflectivity may be an array (rows, columns). "
      "flat: distance_m, by default 1.\nstaircase and plane: near_m, 0.8, and far_m, 5; staircase: "
      "steps, 8.")
      .def(py::init(&scene_of_name), "name"_a = "room", "sensor"_a = py::none(), py::kw_only(),
           "columns"_a = py::none(), "rows"_a = py::none(), "reflectivity"_a = py::none(),
           "distance_m"_a = py::none(), "near_m"_a = py::none(), "far_m"_a = py::none(),
           "steps"_a = py::none(), "seed"_a = 1)
      .def_static(
          "from_depth", &scene_of_depth, "depth_m"_a, "reflectivity"_a = 1.0, py::kw_only(),
          "columns"_a = py::none(), "rows"_a = py::none(),
          "A scene from your own depth map: an array (rows, columns) in m, taken as float32; 0, NaN and "
          "infinity are unknown.\nWith `columns` and `rows` it is resampled by nearest neighbour.")
      .def_static(
          "from_cube", &scene_of_cube, "events"_a, "bin_width_s"_a, py::kw_only(), "start_s"_a = 0.0,
          "events_per_unit"_a = 1.0, "sensor"_a = py::none(), "reflectivity"_a = py::none(),
          "columns"_a = py::none(), "rows"_a = py::none(),
          "A scene from a transient cube: an array (rows, columns, time bins) of the mean detected events of "
          "a "
          "pixel and pulse,\nas `dtof frame --cube` reads it. depth_m is the strongest return of each pixel, "
          "for "
          "the pulse of `sensor`; `reflectivity`\nscales the sunlight alone. Only the exact photon model has "
          "cubes.")
      .def_property_readonly("columns", [](const SceneMap& scene) { return scene.targets->columns(); })
      .def_property_readonly("rows", [](const SceneMap& scene) { return scene.targets->rows(); })
      .def_readonly("name", &SceneMap::name)
      .def_property_readonly(
          "depth_m", [](const SceneMap& scene) { return pixel_array(scene, &PixelTarget::depth_m); },
          "float64 (rows, columns), m; 0 or infinity: no target. No copy.")
      .def_property_readonly(
          "reflectivity",
          [](const SceneMap& scene) { return pixel_array(scene, &PixelTarget::reflectivity); },
          "float64 (rows, columns). No copy.")
      .def("__repr__", [](const SceneMap& scene) {
        return fmt::format("<dtof.Scene {}: {} x {} pixels>", scene.name, scene.targets->columns(),
                           scene.targets->rows());
      });
  module.def(
      "scenes",
      [] {
        py::dict found;
        for (const Scene scene : kAllScenes) {
          found[py::str(std::string(scene_name(scene)))] = std::string(scene_summary(scene));
        }
        return found;
      },
      "Built-in scenes: name and one sentence.");
  module.def(
      "read_depth",
      [](const std::filesystem::path& file, const std::optional<double>& metres_per_unit) {
        DepthImage image = read_depth_image(file, metres_per_unit);
        return taken_array(std::move(image.metres), {image.height, image.width});
      },
      "file"_a, "metres_per_unit"_a = py::none(),
      "Reads a depth map from a file (PNG of 8 or 16 bits, PFM, NPY): float32 (rows, columns), m; 0 is "
      "unknown.");
}

}  // namespace dtof::python
