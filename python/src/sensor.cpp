// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dtof/frame/frame_truth.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/sensor/condition.hpp"
#include "dtof/sensor/preset.hpp"
#include "dtof/sensor/sensor_file.hpp"
#include "src/bindings.hpp"
#include "src/limits.hpp"

namespace dtof::python {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Nanoseconds = std::optional<double>;
using Span = std::optional<std::pair<double, double>>;

template <typename T>
void replace(T& value, const std::optional<T>& with) {
  value = with.value_or(value);
}

SensorModel replaced(const SensorModel& sensor, const std::optional<std::uint32_t>& acquisitions,
                     const std::optional<int>& np, const std::optional<int>& slots,
                     const std::optional<int>& columns, const std::optional<int>& rows,
                     const std::optional<int>& binning, const Nanoseconds& dead_time_ns,
                     const Span& time_gate_ns, const Nanoseconds& coincidence_ns) {
  constexpr double kNanosecondsPerSecond = 1e9;  // divided by, as the program does: the same bits
  check_sensor_number("acquisitions", acquisitions);
  check_sensor_number("slots", slots);
  check_sensor_number("columns", columns);
  check_sensor_number("rows", rows);
  SensorModel changed = sensor;
  replace(changed.acquisitions, acquisitions);
  replace(changed.np, np);
  replace(changed.slots, slots);
  replace(changed.columns, columns);
  replace(changed.rows, rows);
  replace(changed.binning, binning);
  if (dead_time_ns) {
    changed.dead_time_s = *dead_time_ns / kNanosecondsPerSecond;
  }
  if (time_gate_ns) {
    changed.time_gate =
        TimeGate{time_gate_ns->first / kNanosecondsPerSecond, time_gate_ns->second / kNanosecondsPerSecond};
  }
  if (coincidence_ns) {
    changed.coincidence_window_s = *coincidence_ns / kNanosecondsPerSecond;
  }
  changed.validate();
  return changed;
}

}  // namespace

void bind_sensors(py::module_& module) {
  py::class_<SensorModel>(
      module, "Sensor",
      "A laser, its SPADs and their TDC, by a preset's name or the path of a sensor file. Conditions "
      "may\nfollow, each after a plus: \"thesis+fog\". Cannot be changed; replace() makes another sensor.")
      .def(py::init(
               [](const std::filesystem::path& name_or_file) { return find_sensor(name_or_file.string()); }),
           "name_or_file"_a = "thesis")
      .def_static(
          "parse", [](const std::string& toml, const std::string& name) { return parse_sensor(toml, name); },
          "toml"_a, "name"_a = "sensor.toml",
          "Sensor from the text of a sensor file. Files that the text names are searched in the folder of "
          "the path `name`.")
      .def(
          "under",
          [](const SensorModel& sensor, const std::string& condition) {
            return under_condition(sensor, condition);
          },
          "condition"_a, "The sensor with one of conditions() added.")
      .def("replace", &replaced, py::kw_only(), "acquisitions"_a = py::none(), "np"_a = py::none(),
           "slots"_a = py::none(), "columns"_a = py::none(), "rows"_a = py::none(), "binning"_a = py::none(),
           "dead_time_ns"_a = py::none(), "time_gate_ns"_a = py::none(), "coincidence_ns"_a = py::none(),
           "Copy of the sensor with other values, named as the options of `dtof frame`; times in ns.")
      .def_readonly("name", &SensorModel::name)
      .def_readonly("columns", &SensorModel::columns, "Columns of the array.")
      .def_readonly("rows", &SensorModel::rows, "Rows of the array, pixels of a column.")
      .def_readonly("np", &SensorModel::np, "NP, bits of a timestamp.")
      .def_readonly("slots", &SensorModel::slots, "Timestamps that the TDC keeps for a pixel and pulse.")
      .def_readonly("acquisitions", &SensorModel::acquisitions, "Laser pulses of a frame.")
      .def_readonly("integration_time_s", &SensorModel::integration_time_s, "T_int in s.")
      .def_property_readonly("time_resolution_s", &SensorModel::time_resolution_s, "T_int / 2^NP in s.")
      .def_readonly("pulse_fwhm_s", &SensorModel::pulse_fwhm_s, "Width of the pulse in s.")
      .def_readonly("dead_time_s", &SensorModel::dead_time_s, "Dead time of a pixel in s.")
      .def_readonly("default_reflectivity", &SensorModel::default_reflectivity,
                    "Reflectivity of scenes that specify none.")
      .def_property_readonly(
          "range_m", [](const SensorModel& sensor) { return sensor_range_m(sensor); },
          "Distance from which light returns after T_int, in m.")
      .def_property_readonly("degrees_per_pixel", &SensorModel::degrees_per_pixel,
                             "Field of view of a pixel, degrees.")
      .def("signal_events", &SensorModel::signal_events, "distance_m"_a, "reflectivity"_a = 1.0,
           "Mean signal events per pixel and pulse.")
      .def("background_events", &SensorModel::background_events, "klux"_a, "reflectivity"_a = 1.0,
           "Mean background events per pixel and pulse, dark counts included.")
      .def("__repr__", [](const SensorModel& sensor) {
        return fmt::format("<dtof.Sensor {}: {} x {} pixels, {} pulses a frame, NP {}, {:g} ns>", sensor.name,
                           sensor.columns, sensor.rows, sensor.acquisitions, sensor.np,
                           sensor.integration_time_s * 1e9);
      });
  module.def("presets", &preset_names, "Names of the built-in sensors.");
  module.def(
      "preset_text", [](const std::string& name) { return std::string(preset_text(name)); }, "name"_a,
      "Text of a preset's sensor file, as a start for your own file.");
  module.def(
      "conditions",
      [] {
        py::dict found;
        for (const Condition& condition : conditions()) {
          found[py::str(condition.name)] = condition.says;
        }
        return found;
      },
      "Conditions that can be added to a sensor: name and one sentence.");
}

}  // namespace dtof::python
