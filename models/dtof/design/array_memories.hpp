// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/design/sram_macro.hpp"

namespace dtof {

/// Most rows of dtof_subsystem's results, which number a pixel of an SRAM in 12 bits, and most lines of an
/// acquisition (rows times SLOTS).
inline constexpr int kMostSubsystemRows = 4096;
inline constexpr int kMostSubsystemLines = 65530;

/// A read-out's array for a sensor, or several equal arrays side by side.
struct ArrayChoice {
  ReadoutParameters parameters;
  int rows = kArrayRows;  ///< PIXELS_PER_SRAM: the sensor's rows times `columns_per_sram`
  int columns = 200;      ///< SRAM_NUM of each array
  int arrays = 1;
  int pointer_ports = 2;     ///< POINTER_PORTS
  int columns_per_sram = 1;  ///< columns of the sensor that share an SRAM, one after the other (FoldedSource)

  /// Columns that share a memory: 1, or for a pool read-out 4 (2 if ENGINE_COLUMNS is 2), at most `columns`.
  [[nodiscard]] int module_columns() const;
  /// Number of column modules of an array.
  [[nodiscard]] int modules() const;
  /// Number of engines of a pool read-out's array; 0 for others.
  [[nodiscard]] int engines() const;
};

/// Memories of one column module (readouts.toml).
std::vector<MacroSize> column_memories(const ArrayChoice& array);
/// Memories of one engine.
std::vector<MacroSize> engine_memories(const ArrayChoice& array);
/// Memory bits of the column modules divided by the number of pixels.
double bits_per_pixel(const ArrayChoice& array);

}  // namespace dtof
