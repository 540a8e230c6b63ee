// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "rtl/rtl_readout.hpp"

namespace dtof {

/// Contents of an SRAM of an array.
enum class SramKind { kHistogram, kPointer, kCoarsePeak, kBestPeak, kPoolQuad, kEngineScratch };

/// E.g. "coarse peak".
std::string_view sram_title(SramKind kind);

/// Neighbouring columns of an array: first .. first + count - 1.
struct ColumnRange {
  int first = 0;
  int count = 0;

  [[nodiscard]] bool contains(int column) const { return column >= first && column < first + count; }
  bool operator==(const ColumnRange&) const = default;
};

/// Columns whose results may change with those of `columns`. In a pool read-out these are all columns of the
/// affected engines. `together`: ReadoutParameters::columns_together(); `sram_num`: columns of the array.
ColumnRange affected_columns(ColumnRange columns, int together, int sram_num);

/// An SRAM and the columns that use it.
struct ArraySram {
  SramKind kind = SramKind::kHistogram;
  ColumnRange columns;
  RtlSram sram;
};

/// All SRAMs of the array, sorted by column. Throws std::logic_error for an SRAM of unknown kind.
std::vector<ArraySram> array_srams(const RtlReadout& rtl);

/// The kinds of these SRAMs, each once.
std::vector<SramKind> sram_kinds(const std::vector<ArraySram>& srams);

}  // namespace dtof
