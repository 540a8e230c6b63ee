// SPDX-License-Identifier: Apache-2.0
#include "vectors/rtl_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "dtof/core/error.hpp"
#include "rtl/settings.hpp"

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

}  // namespace

ArrayParameters parse_rtl_parameters(Readout readout, std::span<const std::string> settings) {
  RtlConfiguration array{
      .parameters = ReadoutParameters::defaults(readout), .pixels_per_sram = 0, .sram_num = 0};
  for (const std::string& setting : settings) {
    const std::size_t equals = std::min(setting.find('='), setting.size());
    const std::string_view name = std::string_view(setting).substr(0, equals);
    if (equals == setting.size() ||
        !set_rtl_parameter(array, name, parse_value(setting, std::string_view(setting).substr(equals + 1)))) {
      throw InputError(fmt::format("'{}' is no NAME=value of an RTL parameter", setting));
    }
  }
  if (is_pool_readout(readout)) {
    array.parameters.fraction_bits = ReadoutParameters::defaults(readout, array.parameters.np).fraction_bits;
  }
  array.parameters.validate();
  if (array.pixels_per_sram < 1 || array.sram_num < 1) {
    throw InputError("PIXELS_PER_SRAM and SRAM_NUM must be given and be at least 1");
  }
  return {.readout = array.parameters, .rows = array.pixels_per_sram, .columns = array.sram_num};
}

}  // namespace dtof
