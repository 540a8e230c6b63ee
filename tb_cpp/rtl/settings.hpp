// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rtl/configuration.hpp"

namespace dtof {

/// Top modules with the parameters of an array.
enum class RtlTop { kArray, kPoolArray, kSubsystem };

/// dtof_array or dtof_pool_pointer_array, depending on the read-out.
RtlTop array_top(Readout readout);

/// A parameter of a top and its value.
struct RtlSetting {
  std::string_view name;
  int value;
};

/// Value of the parameter READOUT (dtof_pkg::READOUT_*).
int rtl_readout_number(Readout readout);

/// All parameters of `top` with the array of `configuration`, in a fixed order. A subsystem always has the
/// time gate.
std::vector<RtlSetting> rtl_settings(const RtlConfiguration& configuration, RtlTop top);

/// The array of `configuration` as an entry of configurations.toml.
std::string configuration_toml(const std::string& name, const RtlConfiguration& configuration);

/// Sets a parameter; false if no top module has it. Also accepts parameters that do not change results.
bool set_rtl_parameter(RtlConfiguration& configuration, std::string_view name, int value);

}  // namespace dtof
