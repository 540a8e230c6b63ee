// SPDX-License-Identifier: Apache-2.0
#include "src/readout.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/frame/empty_frame.hpp"
#include "dtof/pipeline/readout_choice.hpp"
#include "dtof/readout/pool_template.hpp"
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

/// Whether there is a template of the sensor's own light, a frame without a target to measure it from, or
/// its entries.
using TemplateChoice = std::variant<bool, std::shared_ptr<StreamSource>, std::vector<int>>;

PoolTemplate template_of_entries(const std::vector<int>& entries) {
  PoolTemplate made{};
  if (entries.size() != made.size()) {
    throw InputError(fmt::format("template: needs {} entries, not {}", made.size(), entries.size()));
  }
  for (std::size_t bin = 0; bin < made.size(); ++bin) {
    if (entries[bin] < 0 || entries[bin] > std::numeric_limits<std::uint8_t>::max()) {
      throw InputError(fmt::format("template: entries are 0 to 255, not {}", entries[bin]));
    }
    made[bin] = static_cast<std::uint8_t>(entries[bin]);
  }
  return made;
}

PoolTemplate template_of_frame(const StreamSource& photons, const ReadoutParameters& parameters) {
  std::vector<ColumnStream> columns;
  columns.reserve(static_cast<std::size_t>(photons.columns()));
  for (int column = 0; column < photons.columns(); ++column) {
    columns.push_back(photons.column(column));
  }
  return measured_template(columns, photons.acquisitions(), parameters);
}

PoolTemplate chosen_template(const TemplateChoice& choice, const SensorModel& sensor,
                             const ReadoutParameters& parameters) {
  if (const auto* wanted = std::get_if<bool>(&choice); wanted != nullptr && !*wanted) {
    return {};
  }
  if (!is_pool_readout(parameters.readout)) {
    throw InputError(
        fmt::format("template has no effect: {} has no TEMPLATE", readout_name(parameters.readout)));
  }
  if (const auto* photons = std::get_if<std::shared_ptr<StreamSource>>(&choice)) {
    return template_of_frame(**photons, parameters);
  }
  if (const auto* entries = std::get_if<std::vector<int>>(&choice)) {
    return template_of_entries(*entries);
  }
  if (!has_own_light(sensor)) {
    throw InputError("template has no effect: the sensor has neither cover glass nor fog");
  }
  return template_of(sensor, parameters);
}

ReadoutParameters make_readout(const std::string& name, const std::optional<SensorModel>& sensor,
                               const std::optional<std::pair<int, int>>& code_gate,
                               const TemplateChoice& coarse_template, const py::kwargs& changes) {
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
    if (code_gate->first >= code_gate->second) {
      throw InputError(
          fmt::format("code_gate: no code is at least {} and below {}", code_gate->first, code_gate->second));
    }
    parameters.time_gate = CodeGate{code_gate->first, code_gate->second};
  }
  parameters.validate();
  asked.slots = parameters.slots;
  parameters.pool.coarse_template = chosen_template(coarse_template, asked, parameters);
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
  if (py::isinstance<py::str>(readout)) {
    return default_parameters(parse_readout(readout.cast<std::string>()), sensor);
  }
  if (!py::isinstance<ReadoutParameters>(readout)) {
    throw py::type_error(fmt::format("{} is neither the name of a read-out nor a dtof.Readout",
                                     py::repr(readout).cast<std::string>()));
  }
  return readout.cast<ReadoutParameters>();
}

void bind_readouts(py::module_& module) {
  py::class_<ReadoutParameters>(
      module, "Readout",
      "A read-out and its parameters. Keywords are the names of readouts.toml in lower case\n(nb=6, "
      "count_width=8). Other parameters follow from the sensor, by default the thesis's.\ncode_gate: codes "
      "begin <= x < end count. template, for pool read-outs: what decode subtracts from the coarse\nbins. "
      "True: measured for the sensor's cover glass and fog; or Photons of a frame without a target, "
      "from\nwhich it is measured; or 32 entries.")
      .def(py::init(&make_readout), "name"_a, "sensor"_a = py::none(), py::kw_only(),
           "code_gate"_a = py::none(), "template"_a = false)
      .def_property_readonly("name",
                             [](const ReadoutParameters& p) { return std::string(readout_name(p.readout)); })
      .def_property_readonly("title",
                             [](const ReadoutParameters& p) { return std::string(readout_title(p.readout)); })
      .def_property_readonly(
          "summary", [](const ReadoutParameters& p) { return std::string(readout_summary(p.readout)); })
      .def_property_readonly("parameters", &parameter_dict,
                             "Names and values of the parameters that can be chosen.")
      .def_property_readonly(
          "template",
          [](const ReadoutParameters& p) {
            const PoolTemplate& entries = p.pool.coarse_template;
            return std::vector<int>(entries.begin(), entries.end());
          },
          "What decode subtracts from each of the 32 coarse bins; zeros without a template.")
      .def_property_readonly(
          "pools_pixels", [](const ReadoutParameters& p) { return is_pool_readout(p.readout); },
          "True for pool read-outs, whose pixels use their neighbours' results.")
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
      "All read-outs: name and one sentence.");
}

}  // namespace dtof::python
