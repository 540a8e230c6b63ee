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
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

struct Parameter {
  std::string_view name;
  bool pool;       ///< of the pool read-outs
  bool pixelwise;  ///< of the others
  int (*get)(const ReadoutParameters&);
  void (*set)(ReadoutParameters&, int);
};

constexpr std::array<Parameter, 9> kParameters = {{
    {"COUNT_WIDTH", true, true, [](const ReadoutParameters& p) { return p.count_width; },
     [](ReadoutParameters& p, int value) { p.count_width = value; }},
    {"FRACTION_BITS", false, true, [](const ReadoutParameters& p) { return p.fraction_bits; },
     [](ReadoutParameters& p, int value) { p.fraction_bits = value; }},
    {"WINDOW_CENTRED", false, true, [](const ReadoutParameters& p) { return p.window_centred ? 1 : 0; },
     [](ReadoutParameters& p, int value) { p.window_centred = value != 0; }},
    {"LABELS", true, false, [](const ReadoutParameters& p) { return p.pool.labels; },
     [](ReadoutParameters& p, int value) { p.pool.labels = value; }},
    {"SCORE_BITS", true, false, [](const ReadoutParameters& p) { return p.pool.score_bits; },
     [](ReadoutParameters& p, int value) { p.pool.score_bits = value; }},
    {"CELL_SHIFT", true, false, [](const ReadoutParameters& p) { return p.pool.cell_shift; },
     [](ReadoutParameters& p, int value) { p.pool.cell_shift = value; }},
    {"COARSE_SHARE", true, false, [](const ReadoutParameters& p) { return p.pool.coarse_share; },
     [](ReadoutParameters& p, int value) { p.pool.coarse_share = value; }},
    {"TRACK_SHARE", true, false, [](const ReadoutParameters& p) { return p.pool.track_share; },
     [](ReadoutParameters& p, int value) { p.pool.track_share = value; }},
    {"SMOOTH", true, false, [](const ReadoutParameters& p) { return p.pool.smooth ? 1 : 0; },
     [](ReadoutParameters& p, int value) { p.pool.smooth = value != 0; }},
}};

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
    const std::string_view change = rest.substr(0, comma);
    more = comma != std::string_view::npos;
    rest.remove_prefix(more ? comma + 1 : rest.size());
    const std::size_t equals = change.find('=');
    int value = 0;
    if (equals == std::string_view::npos || !parse_number(change.substr(equals + 1), value)) {
      throw malformed();
    }
    const auto parameter = std::ranges::find(kParameters, change.substr(0, equals), &Parameter::name);
    if (parameter == kParameters.end() || !has(parameters.readout, *parameter)) {
      throw InputError(fmt::format("variant {}: {} has no {} to change; known are {}", text,
                                   readout_name(parameters.readout), change.substr(0, equals),
                                   variant_parameters_help()));
    }
    parameter->set(parameters, value);
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
    const int value = parameter.get(parameters);
    if (has(parameters.readout, parameter) && value != parameter.get(defaults)) {
      title += fmt::format(" {}={}", parameter.name, value);
    }
  }
  return title;
}

}  // namespace dtof
