// SPDX-License-Identifier: Apache-2.0
#include "rtl/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "dtof/core/parameter_entry.hpp"
#include "rtl/rtl_parameters.hpp"

namespace dtof {
namespace {

/// A parameter of an array that changes no result of a model.
struct OwnParameter {
  std::string_view name;
  int (*get)(const RtlConfiguration&);
  void (*set)(RtlConfiguration&, int);
};

template <auto Member>
constexpr OwnParameter own(std::string_view name) {
  return {name, [](const RtlConfiguration& from) { return static_cast<int>(from.*Member); },
          [](RtlConfiguration& to, int value) {
            to.*Member = static_cast<std::remove_reference_t<decltype(to.*Member)>>(value);
          }};
}

void ignore(RtlConfiguration& /*configuration*/, int /*value*/) {}

using C = RtlConfiguration;

constexpr int kAcquisitionBits = 16;  // of tb_cpp/rtl/*_testbench.sv

constexpr auto kOwn = std::to_array<OwnParameter>({
    own<&C::pixels_per_sram>("PIXELS_PER_SRAM"),
    own<&C::sram_num>("SRAM_NUM"),
    own<&C::pointer_ports>("POINTER_PORTS"),
    own<&C::signalled_clear>("SIGNALLED_CLEAR"),
    own<&C::parity>("PARITY"),
    own<&C::raw_histogram>("RAW_HISTOGRAM"),
    {"TIME_GATE", [](const C& c) { return c.parameters.time_gate ? 1 : 0; },
     [](C& c, int value) { c.parameters.time_gate = value != 0 ? std::optional(CodeGate{}) : std::nullopt; }},
    {"ACQ_WIDTH", [](const C& /*c*/) { return kAcquisitionBits; }, ignore},
    {"BROADCAST_STAGES",
     [](const C& c) { return default_value(c.parameters.readout, "BROADCAST_STAGES", c.parameters.np); },
     ignore},
});

const OwnParameter* find_own(std::string_view name) {
  const auto* const found = std::ranges::find(kOwn, name, &OwnParameter::name);
  return found == kOwn.end() ? nullptr : found;
}

int value_of(const RtlConfiguration& configuration, std::string_view name) {
  if (const OwnParameter* const own = find_own(name)) {
    return own->get(configuration);
  }
  if (name == "FRACTION_BITS" && is_pool_readout(configuration.parameters.readout)) {
    return 0;  // the RTL computes a pool read-out's from NP
  }
  const ParameterEntry* const entry = find_parameter_entry(name);
  if (entry == nullptr) {
    throw std::logic_error(fmt::format("{} of readouts.toml has no member in C++", name));
  }
  return entry->get(configuration.parameters);
}

bool is_in(RtlTop top, const RtlParameter& parameter) {
  switch (top) {
    case RtlTop::kArray:
      return parameter.in_array;
    case RtlTop::kPoolArray:
      return parameter.in_pool_array;
    default:
      return true;
  }
}

}  // namespace

RtlTop array_top(Readout readout) { return is_pool_readout(readout) ? RtlTop::kPoolArray : RtlTop::kArray; }

int rtl_readout_number(Readout readout) {
  constexpr int kPoolPointer = 64;
  return is_pool_readout(readout) ? kPoolPointer : static_cast<int>(readout);
}

std::vector<RtlSetting> rtl_settings(const RtlConfiguration& configuration, RtlTop top) {
  std::vector<RtlSetting> settings;
  if (top != RtlTop::kPoolArray) {
    settings.push_back({"READOUT", rtl_readout_number(configuration.parameters.readout)});
  }
  for (const RtlParameter& parameter : rtl_parameters()) {
    if (is_in(top, parameter)) {
      const bool gate = top == RtlTop::kSubsystem && parameter.name == "TIME_GATE";
      settings.push_back({parameter.name, gate ? 1 : value_of(configuration, parameter.name)});
    }
  }
  return settings;
}

bool set_rtl_parameter(RtlConfiguration& configuration, std::string_view name, int value) {
  if (const OwnParameter* const own = find_own(name)) {
    own->set(configuration, value);
    return true;
  }
  if (const ParameterEntry* const entry = find_parameter_entry(name)) {
    entry->set(configuration.parameters, value);
    return true;
  }
  return false;
}

std::string configuration_toml(const std::string& name, const RtlConfiguration& configuration) {
  std::string parameters;
  for (const RtlSetting& setting : rtl_settings(configuration, array_top(configuration.parameters.readout))) {
    if (setting.name != "READOUT") {
      parameters += fmt::format("{}{} = {}", parameters.empty() ? "" : ", ", setting.name, setting.value);
    }
  }
  return fmt::format("[configuration.{}]\nreadout = \"{}\"\nparameters = {{ {} }}\n", name,
                     readout_name(configuration.parameters.readout), parameters);
}

}  // namespace dtof
