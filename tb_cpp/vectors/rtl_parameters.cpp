// SPDX-License-Identifier: Apache-2.0
#include "vectors/rtl_parameters.hpp"

#include <fmt/format.h>

#include <charconv>
#include <functional>
#include <map>
#include <string_view>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

int parse_value(std::string_view setting, std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError(fmt::format("'{}': the value must be an integer", setting));
  }
  return value;
}

using Setter = std::function<void(int)>;

std::map<std::string_view, Setter> setters(ArrayParameters& array, int& time_gate) {
  ReadoutParameters& readout = array.readout;
  PoolPointerParameters& pool = readout.pool;
  const auto number = [](int& target) { return [&target](int value) { target = value; }; };
  const auto flag = [](bool& target) { return [&target](int value) { target = value != 0; }; };
  const Setter nothing = [](int) {};
  return {{"NP", number(readout.np)},
          {"NB", number(readout.nb)},
          {"PIXELS_PER_SRAM", number(array.rows)},
          {"SRAM_NUM", number(array.columns)},
          {"SLOTS", number(readout.slots)},
          {"COUNT_WIDTH", number(readout.count_width)},
          {"POINTER_STEP", number(readout.pointer_step)},
          {"FRACTION_BITS", number(readout.fraction_bits)},
          {"CONFIDENCE_WIDTH", number(readout.confidence_width)},
          {"GUARD", number(readout.guard)},
          {"WINDOW_CENTRED", flag(readout.window_centred)},
          {"TIME_GATE", number(time_gate)},
          {"GROUP_SIZE", number(pool.group_size)},
          {"LABELS", number(pool.labels)},
          {"SCORE_BITS", number(pool.score_bits)},
          {"OFFSET_BITS", number(pool.offset_bits)},
          {"ADVANTAGE_WIDTH", number(pool.count_bits)},
          {"POINTER_SHIFT", number(pool.pointer_shift)},
          {"RIVAL_MOVES", flag(pool.rival_moves)},
          {"CELL_SHIFT", number(pool.cell_shift)},
          {"SECOND_TARGET", flag(pool.second_target)},
          {"PRIOR", flag(pool.prior)},
          {"POINTER_PORTS", nothing},
          {"SIGNALLED_CLEAR", nothing},
          {"RAW_HISTOGRAM", nothing},
          {"ENGINE_COLUMNS", number(pool.engine_columns)},
          {"ACQ_WIDTH", nothing},
          {"BROADCAST_STAGES", nothing}};
}

}  // namespace

ArrayParameters parse_rtl_parameters(Readout readout, std::span<const std::string> settings) {
  ArrayParameters array{.readout = ReadoutParameters::defaults(readout)};
  int time_gate = 0;
  const std::map<std::string_view, Setter> known = setters(array, time_gate);
  for (const std::string& setting : settings) {
    const std::size_t equals = std::min(setting.find('='), setting.size());
    const auto found = known.find(std::string_view(setting).substr(0, equals));
    if (found == known.end() || equals == setting.size()) {
      throw InputError(fmt::format("'{}' is no NAME=value of an RTL parameter", setting));
    }
    found->second(parse_value(setting, std::string_view(setting).substr(equals + 1)));
  }
  if (is_pool_readout(readout)) {
    array.readout.fraction_bits = ReadoutParameters::defaults(readout, array.readout.np).fraction_bits;
  }
  if (time_gate != 0) {
    array.readout.time_gate = CodeGate{};
  }
  array.readout.validate();
  if (array.rows < 1 || array.columns < 1) {
    throw InputError("PIXELS_PER_SRAM and SRAM_NUM must be given and be at least 1");
  }
  return array;
}

}  // namespace dtof
