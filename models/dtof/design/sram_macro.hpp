// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace dtof {

/// Size of an SRAM macro. ports: 1 (1RW) or 2 (1R1W). parts: parts of a word with a write enable each.
struct MacroSize {
  int ports = 1;
  int words = 0;
  int bits = 0;
  int parts = 1;

  [[nodiscard]] long capacity() const { return static_cast<long>(words) * bits; }
  bool operator==(const MacroSize&) const = default;
};

/// Area, timing and energy of a macro.
struct SramMacro {
  double area_um2;
  double access_slow_ns;
  double read_pj;
  double write_pj;
  double leakage_uw;
};

/// Physical model of a 40 nm SRAM macro: the organisation of least area, and laws of words and bits. Same
/// model as the synthesis flow's (synth/dtof_synth/sram_model.py). Throws InputError for a size without a
/// macro.
SramMacro sram_macro(const MacroSize& size);

}  // namespace dtof
