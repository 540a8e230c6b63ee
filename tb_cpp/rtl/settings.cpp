// SPDX-License-Identifier: Apache-2.0
#include "rtl/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace dtof {
namespace {

using Get = int (*)(const RtlConfiguration&);
using Set = void (*)(RtlConfiguration&, int);

constexpr unsigned kInArray = 1;
constexpr unsigned kInPoolArray = 2;
constexpr unsigned kInSubsystem = 4;
constexpr unsigned kInAll = kInArray | kInPoolArray | kInSubsystem;
constexpr unsigned kOfArray = kInArray | kInSubsystem;
constexpr unsigned kOfPool = kInPoolArray | kInSubsystem;

struct Parameter {
  std::string_view name;
  unsigned tops;
  Get get;
  Set set;
};

template <int ReadoutParameters::*Member>
constexpr Get kGet = [](const RtlConfiguration& c) { return c.parameters.*Member; };
template <int ReadoutParameters::*Member>
constexpr Set kSet = [](RtlConfiguration& c, int value) { c.parameters.*Member = value; };
template <int PoolPointerParameters::*Member>
constexpr Get kGetPool = [](const RtlConfiguration& c) { return c.parameters.pool.*Member; };
template <int PoolPointerParameters::*Member>
constexpr Set kSetPool = [](RtlConfiguration& c, int value) { c.parameters.pool.*Member = value; };
template <bool PoolPointerParameters::*Member>
constexpr Get kGetPoolFlag = [](const RtlConfiguration& c) { return c.parameters.pool.*Member ? 1 : 0; };
template <bool PoolPointerParameters::*Member>
constexpr Set kSetPoolFlag = [](RtlConfiguration& c, int value) { c.parameters.pool.*Member = value != 0; };
template <bool RtlConfiguration::*Member>
constexpr Get kGetFlag = [](const RtlConfiguration& c) { return c.*Member ? 1 : 0; };
template <bool RtlConfiguration::*Member>
constexpr Set kSetFlag = [](RtlConfiguration& c, int value) { c.*Member = value != 0; };
template <int RtlConfiguration::*Member>
constexpr Get kGetSize = [](const RtlConfiguration& c) { return c.*Member; };
template <int RtlConfiguration::*Member>
constexpr Set kSetSize = [](RtlConfiguration& c, int value) { c.*Member = value; };

void ignore(RtlConfiguration& /*configuration*/, int /*value*/) {}

using R = ReadoutParameters;
using P = PoolPointerParameters;
using C = RtlConfiguration;

constexpr int kAcquisitionBits = 16;  // of tb_cpp/rtl/*_testbench.sv

constexpr std::array<Parameter, 30> kParameters = {{
    {"NP", kInAll, kGet<&R::np>, kSet<&R::np>},
    {"NB", kOfArray, kGet<&R::nb>, kSet<&R::nb>},
    {"PIXELS_PER_SRAM", kInAll, kGetSize<&C::pixels_per_sram>, kSetSize<&C::pixels_per_sram>},
    {"SRAM_NUM", kInAll, kGetSize<&C::sram_num>, kSetSize<&C::sram_num>},
    {"SLOTS", kInAll, kGet<&R::slots>, kSet<&R::slots>},
    {"COUNT_WIDTH", kInAll, kGet<&R::count_width>, kSet<&R::count_width>},
    {"POINTER_STEP", kOfArray, kGet<&R::pointer_step>, kSet<&R::pointer_step>},
    // A pool read-out's follows from NP.
    {"FRACTION_BITS", kOfArray,
     [](const C& c) { return is_pool_readout(c.parameters.readout) ? 0 : c.parameters.fraction_bits; },
     kSet<&R::fraction_bits>},
    {"CONFIDENCE_WIDTH", kOfArray, kGet<&R::confidence_width>, kSet<&R::confidence_width>},
    {"GUARD", kOfArray, kGet<&R::guard>, kSet<&R::guard>},
    {"WINDOW_CENTRED", kOfArray, [](const C& c) { return c.parameters.window_centred ? 1 : 0; },
     [](C& c, int value) { c.parameters.window_centred = value != 0; }},
    {"POINTER_PORTS", kOfArray, kGetSize<&C::pointer_ports>, kSetSize<&C::pointer_ports>},
    {"SIGNALLED_CLEAR", kOfArray, kGetFlag<&C::signalled_clear>, kSetFlag<&C::signalled_clear>},
    {"TIME_GATE", kInAll, [](const C& c) { return c.parameters.time_gate ? 1 : 0; },
     [](C& c, int value) { c.parameters.time_gate = value != 0 ? std::optional(CodeGate{}) : std::nullopt; }},
    {"RAW_HISTOGRAM", kOfArray, kGetFlag<&C::raw_histogram>, kSetFlag<&C::raw_histogram>},
    {"GROUP_SIZE", kOfPool, kGetPool<&P::group_size>, kSetPool<&P::group_size>},
    {"LABELS", kOfPool, kGetPool<&P::labels>, kSetPool<&P::labels>},
    {"SCORE_BITS", kOfPool, kGetPool<&P::score_bits>, kSetPool<&P::score_bits>},
    {"OFFSET_BITS", kOfPool, kGetPool<&P::offset_bits>, kSetPool<&P::offset_bits>},
    {"ADVANTAGE_WIDTH", kOfPool, kGetPool<&P::count_bits>, kSetPool<&P::count_bits>},
    {"POINTER_SHIFT", kOfPool, kGetPool<&P::pointer_shift>, kSetPool<&P::pointer_shift>},
    {"RIVAL_MOVES", kOfPool, kGetPoolFlag<&P::rival_moves>, kSetPoolFlag<&P::rival_moves>},
    {"CELL_SHIFT", kOfPool, kGetPool<&P::cell_shift>, kSetPool<&P::cell_shift>},
    {"SECOND_TARGET", kOfPool, kGetPoolFlag<&P::second_target>, kSetPoolFlag<&P::second_target>},
    {"PRIOR", kOfPool, kGetPoolFlag<&P::prior>, kSetPoolFlag<&P::prior>},
    {"ENGINE_COLUMNS", kOfPool, kGetPool<&P::engine_columns>, kSetPool<&P::engine_columns>},
    {"COARSE_SHARE", kInSubsystem, kGetPool<&P::coarse_share>, kSetPool<&P::coarse_share>},
    {"TRACK_SHARE", kInSubsystem, kGetPool<&P::track_share>, kSetPool<&P::track_share>},
    {"ACQ_WIDTH", kInSubsystem, [](const C& /*c*/) { return kAcquisitionBits; }, ignore},
    {"BROADCAST_STAGES", kInAll,
     [](const C& c) { return default_value(c.parameters.readout, "BROADCAST_STAGES", c.parameters.np); },
     ignore},
}};

unsigned bit_of(RtlTop top) {
  switch (top) {
    case RtlTop::kArray:
      return kInArray;
    case RtlTop::kPoolArray:
      return kInPoolArray;
    default:
      return kInSubsystem;
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
  for (const Parameter& parameter : kParameters) {
    if ((parameter.tops & bit_of(top)) != 0) {
      const bool gate = top == RtlTop::kSubsystem && parameter.name == "TIME_GATE";
      settings.push_back({parameter.name, gate ? 1 : parameter.get(configuration)});
    }
  }
  return settings;
}

bool set_rtl_parameter(RtlConfiguration& configuration, std::string_view name, int value) {
  const auto* found = std::ranges::find(kParameters, name, &Parameter::name);
  if (found == kParameters.end()) {
    return false;
  }
  found->set(configuration, value);
  return true;
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
