// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/design/sram_macro.hpp"

namespace dtof {

/// A read-out's array of a sensor, or several equal ones side by side.
struct ArrayChoice {
  ReadoutParameters parameters;
  int rows = kArrayRows;  ///< PIXELS_PER_SRAM
  int columns = 200;      ///< SRAM_NUM, of each
  int arrays = 1;
  int pointer_ports = 2;  ///< POINTER_PORTS

  /// Columns that share a memory: four of a pool read-out, two where engines are as small, else one.
  [[nodiscard]] int module_columns() const;
  /// Column modules.
  [[nodiscard]] int modules() const;
  /// Engines of a pool read-out; else 0.
  [[nodiscard]] int engines() const;
};

/// The memories of one column module, as readouts.toml has them.
std::vector<MacroSize> column_memories(const ArrayChoice& array);
/// Those of one engine.
std::vector<MacroSize> engine_memories(const ArrayChoice& array);
/// Bits of the column modules' memories that a pixel has.
double bits_per_pixel(const ArrayChoice& array);

}  // namespace dtof
