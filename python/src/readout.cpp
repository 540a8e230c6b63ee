// SPDX-License-Identifier: Apache-2.0
#include "src/readout.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/pipeline/readout_choice.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "src/bindings.hpp"

namespace dtof::python {

namespace py = pybind11;
using namespace py::literals;

namespace {

std::string letters(std::string_view text, int (*change)(int)) {
  std::string changed(text);
  std::ranges::transform(changed, changed.begin(),
                         [&](unsigned char c) { return static_cast<char>(change(c)); });
  return changed;
}

int whole_number(const py::handle& value, const std::string& name) {
  try {
    return py::int_(py::module_::import("operator").attr("index")(value)).cast<int>();
  } catch (const py::error_already_set&) {
    throw InputError(fmt::format("{}: {} is no whole number", name, py::repr(value).cast<std::string>()));
  } catch (const py::cast_error&) {
    throw InputError(
        fmt::format("{}: {} is no whole number of 32 bits", name, py::repr(value).cast<std::string>()));
  }
}

ReadoutParameters make_readout(const std::string& name, const std::optional<SensorModel>& sensor,
                               const std::optional<std::pair<int, int>>& code_gate,
                               const py::kwargs& changes) {
  const Readout readout = parse_readout(name);
  SensorModel asked = sensor.value_or(SensorModel());
  if (changes.contains("np")) {  // other defaults follow from NP
    asked.np = whole_number(changes["np"], "np");
  }
  ReadoutParameters parameters = default_parameters(readout, asked);
  for (const auto& [key, value] : changes) {
    const auto word = key.cast<std::string>();
    set_parameter(parameters, letters(word, std::toupper), whole_number(value, word));
  }
  if (code_gate) {
    parameters.time_gate = CodeGate{code_gate->first, code_gate->second};
  }
  parameters.validate();
  return parameters;
}

py::dict parameter_dict(const ReadoutParameters& parameters) {
  py::dict found;
  for (const std::string_view name : parameter_names(parameters.readout)) {
    found[py::str(letters(name, std::tolower))] = get_parameter(parameters, name);
  }
  return found;
}

}  // namespace

ReadoutParameters to_readout(const py::handle& readout, const SensorModel& sensor) {
  return py::isinstance<py::str>(readout)
             ? default_parameters(parse_readout(readout.cast<std::string>()), sensor)
             : readout.cast<ReadoutParameters>();
}

void bind_readouts(py::module_& module) {
  py::class_<ReadoutParameters>(
      module, "Readout",
      "A read-out and its parameters, which are keywords with the names of readouts.toml in small letters\n"
      "(nb=6, count_width=8). What no keyword says follows from the sensor, by default that of the thesis.\n"
      "code_gate: codes begin <= x < end count.")
      .def(py::init(&make_readout), "name"_a, "sensor"_a = py::none(), py::kw_only(),
           "code_gate"_a = py::none())
      .def_property_readonly("name",
                             [](const ReadoutParameters& p) { return std::string(readout_name(p.readout)); })
      .def_property_readonly("title",
                             [](const ReadoutParameters& p) { return std::string(readout_title(p.readout)); })
      .def_property_readonly(
          "summary", [](const ReadoutParameters& p) { return std::string(readout_summary(p.readout)); })
      .def_property_readonly("parameters", &parameter_dict,
                             "The parameters that can be chosen, with their values.")
      .def_property_readonly(
          "pools_pixels", [](const ReadoutParameters& p) { return is_pool_readout(p.readout); },
          "Whether pixels help each other.")
      .def("__eq__", [](const ReadoutParameters& p, const ReadoutParameters& other) { return p == other; })
      .def("__repr__",
           [](const ReadoutParameters& p) { return fmt::format("<dtof.Readout {}>", p.to_string()); });
  module.def(
      "readouts",
      [] {
        py::dict found;
        for (const Readout readout : kAllReadouts) {
          found[py::str(std::string(readout_name(readout)))] = std::string(readout_summary(readout));
        }
        return found;
      },
      "All read-outs: a name and a sentence each.");
}

}  // namespace dtof::python
