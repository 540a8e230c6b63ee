// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// Parameters of an array, for the model and the test bench.
struct ArrayParameters {
  ReadoutParameters readout;
  int rows = 0;     ///< PIXELS_PER_SRAM
  int columns = 0;  ///< SRAM_NUM
};

/// Parses `NAME=value` settings of an RTL top. Accepts names that do not change results (POINTER_PORTS,
/// SIGNALLED_CLEAR, ENGINE_COLUMNS, ACQ_WIDTH). Throws InputError for any other name, a value that is no
/// number, or parameters that the model refuses.
ArrayParameters parse_rtl_parameters(Readout readout, std::span<const std::string> settings);

}  // namespace dtof
