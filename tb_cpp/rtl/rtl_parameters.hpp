// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace dtof {

/// A parameter of the RTL, and which arrays have the parameter. A subsystem has all parameters.
struct RtlParameter {
  std::string_view name;
  bool in_array;       ///< of dtof_array
  bool in_pool_array;  ///< of dtof_pool_pointer_array
};

/// All parameters of readouts.toml (rtl_parameters.cpp is generated). Those with one value for all compiled
/// arrays come last.
std::span<const RtlParameter> rtl_parameters();

}  // namespace dtof
