// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// What the model and the test bench need to know about an array.
struct ArrayParameters {
  ReadoutParameters readout;
  int rows = 0;     ///< PIXELS_PER_SRAM
  int columns = 0;  ///< SRAM_NUM
};

/// From `NAME=value` settings of an RTL top. Names that do not change results (POINTER_PORTS,
/// SIGNALLED_CLEAR, ENGINE_COLUMNS, ACQ_WIDTH) are accepted. Throws InputError for any other name, a value
/// that is no number, or parameters that the model refuses.
ArrayParameters parse_rtl_parameters(Readout readout, std::span<const std::string> settings);

}  // namespace dtof
