// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "rtl/rtl_readout.hpp"

namespace dtof {

/// What an SRAM of an array holds.
enum class SramKind { kHistogram, kPointer, kCoarsePeak, kBestPeak, kPoolQuad, kEngineScratch };

/// E.g. "coarse peak".
std::string_view sram_title(SramKind kind);

/// Columns of an array, neighbours: first, first + 1, .. first + count - 1.
struct ColumnRange {
  int first = 0;
  int count = 0;

  [[nodiscard]] bool contains(int column) const { return column >= first && column < first + count; }
  bool operator==(const ColumnRange&) const = default;
};

/// The columns that may change with these: of a pool read-out those of every engine that has one of them,
/// since columns of an engine hear each other. `together`: ReadoutParameters::columns_together(); `sram_num`:
/// of the array.
ColumnRange heard_by(ColumnRange columns, int together, int sram_num);

/// An SRAM and the columns that use it.
struct ArraySram {
  SramKind kind = SramKind::kHistogram;
  ColumnRange columns;
  RtlSram sram;
};

/// All SRAMs of the array in the order of their columns. Throws std::logic_error for one that has no kind.
std::vector<ArraySram> array_srams(const RtlReadout& rtl);

/// The kinds among them, each once.
std::vector<SramKind> sram_kinds(const std::vector<ArraySram>& srams);

}  // namespace dtof
