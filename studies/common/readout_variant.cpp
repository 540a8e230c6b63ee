// SPDX-License-Identifier: Apache-2.0
#include "common/readout_variant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parameter_entry.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

/// A parameter that a variant may change. All but SMOOTH, a register, are in readouts.toml.
struct Parameter {
  std::string_view name;
  bool pool;       ///< of the pool read-outs
  bool pixelwise;  ///< of the others
};

constexpr std::string_view kSmooth = "SMOOTH";
constexpr std::array<Parameter, 9> kParameters = {{
    {"COUNT_WIDTH", true, true},
    {"FRACTION_BITS", false, true},
    {"WINDOW_CENTRED", false, true},
    {"LABELS", true, false},
    {"SCORE_BITS", true, false},
    {"CELL_SHIFT", true, false},
    {"COARSE_SHARE", true, false},
    {"TRACK_SHARE", true, false},
    {kSmooth, true, false},
}};

int value_of(const ReadoutParameters& parameters, std::string_view name) {
  return name == kSmooth ? (parameters.pool.smooth ? 1 : 0) : find_parameter_entry(name)->get(parameters);
}

void change(ReadoutParameters& parameters, std::string_view name, int value) {
  if (name == kSmooth) {
    parameters.pool.smooth = value != 0;
  } else {
    find_parameter_entry(name)->set(parameters, value);
  }
}

bool has(Readout readout, const Parameter& parameter) {
  return is_pool_readout(readout) ? parameter.pool
                                  : parameter.pixelwise && has_parameter(readout, parameter.name);
}

std::string names(bool Parameter::*owner) {
  std::string list;
  for (const Parameter& parameter : kParameters) {
    if (parameter.*owner) {
      list += (list.empty() ? "" : ", ") + std::string(parameter.name);
    }
  }
  return list;
}

bool parse_number(std::string_view text, int& value) {
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end;
}

}  // namespace

std::string variant_parameters_help() {
  return fmt::format("{}; pool read-outs: {}", names(&Parameter::pixelwise), names(&Parameter::pool));
}

ReadoutParameters parse_variant(const std::string& text, const SensorModel& sensor) {
  const auto malformed = [&] {
    return InputError(fmt::format("variant {}: expected READOUT:PARAMETER=NUMBER,...", text));
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    throw malformed();
  }
  ReadoutParameters parameters = default_parameters(parse_readout(text.substr(0, colon)), sensor);
  std::string_view rest = std::string_view(text).substr(colon + 1);
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    const std::string_view setting = rest.substr(0, comma);
    more = comma != std::string_view::npos;
    rest.remove_prefix(more ? comma + 1 : rest.size());
    const std::size_t equals = setting.find('=');
    int value = 0;
    if (equals == std::string_view::npos || !parse_number(setting.substr(equals + 1), value)) {
      throw malformed();
    }
    const auto parameter = std::ranges::find(kParameters, setting.substr(0, equals), &Parameter::name);
    if (parameter == kParameters.end() || !has(parameters.readout, *parameter)) {
      throw InputError(fmt::format("variant {}: {} has no {} to change; known are {}", text,
                                   readout_name(parameters.readout), setting.substr(0, equals),
                                   variant_parameters_help()));
    }
    change(parameters, parameter->name, value);
  }
  parameters.validate();
  return parameters;
}

std::string variant_title(const ReadoutParameters& parameters, const SensorModel& sensor) {
  SensorModel own = sensor;
  own.np = parameters.np;
  const ReadoutParameters defaults = default_parameters(parameters.readout, own);
  std::string title(readout_title(parameters.readout));
  for (const Parameter& parameter : kParameters) {
    const int value = value_of(parameters, parameter.name);
    if (has(parameters.readout, parameter) && value != value_of(defaults, parameter.name)) {
      title += fmt::format(" {}={}", parameter.name, value);
    }
  }
  return title;
}

}  // namespace dtof
