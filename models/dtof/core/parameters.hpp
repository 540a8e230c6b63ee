// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dtof/core/readout.hpp"

namespace dtof {

/// Read-out by its command-line name. Throws InputError that lists the known names.
Readout parse_readout(std::string_view name);

/// TEMPLATE registers of poolPointer (docs/reference/poolpointer.md, Template), in units of
/// pool_template_unit(). The decode step subtracts entry b from coarse bin b's sum over a group and its
/// neighbours.
using PoolTemplate = std::array<std::uint8_t, 32>;
/// Unit of a TEMPLATE entry, in counts: 2^(COUNT_WIDTH - 5), at least 1. 255 units exceed the largest sum.
constexpr int pool_template_unit(int count_width) { return count_width > 5 ? 1 << (count_width - 5) : 1; }

/// Parameters of the pool read-outs beyond those they share with the others (docs/reference/poolpointer.md).
/// The limits are in parameter_limits.hpp.
struct PoolPointerParameters {
  // members of a pool read-out: written by scripts/generate.py from readouts.toml
  // clang-format off
  /// GROUP_SIZE: rows of a group, which shares a coarse histogram
  int group_size = 4;
  /// LABELS: candidates of a group
  int labels = 5;
  /// SCORE_BITS: bits of a candidate's score
  int score_bits = 4;
  /// OFFSET_BITS: bits of a leader's offset in the track phase, 0 for none
  int offset_bits = 6;
  /// ADVANTAGE_WIDTH: bits of the leader's advantage
  int count_bits = 7;
  /// POINTER_SHIFT: a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins
  int pointer_shift = 1;
  /// RIVAL_MOVES: 1: the rival has a pointer of its own
  bool rival_moves = true;
  /// CELL_SHIFT: windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25
  int cell_shift = 9;
  /// SECOND_TARGET: 1: a result has the position of the label that lost, too
  bool second_target = false;
  /// AMPLITUDE: 1: a result has amplitude and ambient, too
  bool amplitude = false;
  /// PRIOR: 1: candidates may begin from those that were used in the last frame (`prior_i`)
  bool prior = false;
  /// ENGINE_COLUMNS: columns that share an engine
  int engine_columns = 34;
  /// COARSE_SHARE: 64ths of a frame that the coarse phase is recommended to take
  int coarse_share = 14;
  /// TRACK_SHARE: 64ths of a frame that the track phase is recommended to take
  int track_share = 30;
  // clang-format on
  // end of members of a pool read-out
  bool smooth = true;              ///< smoothing S1 is on
  PoolTemplate coarse_template{};  ///< TEMPLATE registers for crosstalk and fog; 0: no correction

  static PoolPointerParameters defaults(Readout readout);
  /// Throws InputError if a parameter is outside its range. `count_width`: bits of a coarse bin.
  void validate(int count_width) const;
  /// Width of a pixel word, bits.
  [[nodiscard]] int word_bits() const;
  /// Bits of the group's background in a group word (the highest ones): 4 to 6, as many as two pixel words
  /// leave beside the candidates.
  [[nodiscard]] int background_bits() const;
  /// Bits of a candidate's significance in a group word: 3, 2 or 0, as many as two pixel words leave. 0 if
  /// ADVANTAGE_WIDTH is 4 or RIVAL_MOVES is 0. With 0 bits, a result's confidence is its margin.
  [[nodiscard]] int significance_bits() const;
  /// Memory half-words for eight coarse bins of `count_width` bits: 1 or 2.
  [[nodiscard]] int bin_halves(int count_width) const;
  bool operator==(const PoolPointerParameters&) const = default;
};

/// Ends of a pool read-out's phases, in acquisitions; the driver writes these values to the schedule
/// registers.
struct PoolSchedule {
  std::uint32_t coarse_end;  ///< first acquisition after the coarse phase
  std::uint32_t track_end;   ///< first acquisition after the track phase

  PoolSchedule(std::uint32_t acquisitions, const PoolPointerParameters& parameters);
};

/// Rows of a column in the thesis's array and in the compiled arrays.
inline constexpr int kArrayRows = 160;

/// Full width of a group's background in a pool read-out, whose values are 0 .. 39.
inline constexpr int kPoolBackgroundBits = 6;

/// Digital time gate in codes 0 .. 2^NP - 1. A timestamp x counts if begin <= x < end; any other is no
/// detection. With end <= begin nothing counts.
struct CodeGate {
  int begin = 0;
  int end = 0;

  [[nodiscard]] bool contains(int timestamp) const { return timestamp >= begin && timestamp < end; }
  bool operator==(const CodeGate&) const = default;
};

/// Parameters of a read-out, named as in the RTL. The limits are in parameter_limits.hpp.
struct ReadoutParameters {
  Readout readout = Readout::kEzPointer;
  // members of all read-outs: written by scripts/generate.py from readouts.toml
  // clang-format off
  /// NP: bits of a TDC timestamp
  int np = 10;
  /// NB: bits of the coarse histogram index
  int nb = 5;
  /// SLOTS: timestamps per pixel and acquisition
  int slots = 2;
  /// COUNT_WIDTH: bits of a histogram bin's counter, which never wraps
  int count_width = 10;
  /// POINTER_STEP: bins a pointer moves per timestamp
  int pointer_step = 1;
  /// FRACTION_BITS: fractional bits of the pointer
  int fraction_bits = 0;
  /// CONFIDENCE_WIDTH: bits of a pointer's confidence, 0 for none
  int confidence_width = 4;
  /// GUARD: hisPointer: codes by which the window is wider than half a coarse bin on either side; default: a FWHM of 2 ns in a range of 45 ns
  int guard = 46;
  /// WINDOW_CENTRED: SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5
  bool window_centred = false;
  // clang-format on
  // end of members of all read-outs
  /// Values of gate_begin_i and gate_end_i at the frame's start; none: TIME_GATE = 0.
  std::optional<CodeGate> time_gate;
  PoolPointerParameters pool;  ///< pool read-outs

  /// Default parameters. NB = floor(NP/2) + 1 for SiFH (Eq. 2.3), floor(NP/2) for FiFH and hisPointer,
  /// min(NP, 6) for PiFH, NP for the histogram. GUARD = ceil(FWHM / T_res) scaled to NP. The pool read-outs
  /// have NB = 5, COUNT_WIDTH = 7 and FRACTION_BITS = 16 - NP, which is fixed. Throws InputError for an NP
  /// outside 3 to 16.
  static ReadoutParameters defaults(Readout readout, int np = 10);

  /// Throws InputError with the RTL's own sentence and the value if a parameter is outside its range.
  void validate() const;

  /// Number of neighbouring columns, counted from column 0, whose pixels use each other's results: the
  /// columns of a pool read-out's engine, else 1.
  [[nodiscard]] int columns_together() const { return is_pool_readout(readout) ? pool.engine_columns : 1; }
  /// Bins of the histogram in a raw frame (RAW_HISTOGRAM); 0 if the read-out holds no whole histogram at the
  /// frame's end.
  [[nodiscard]] int raw_bins() const;
  /// Number of codes, 2^NP.
  [[nodiscard]] int code_count() const { return 1 << np; }
  /// The no-detection code, 2^NP - 1.
  [[nodiscard]] int no_detection() const { return (1 << np) - 1; }
  /// For messages, e.g. "sifh NP=10 SLOTS=2 NB=6 COUNT_WIDTH=10 WINDOW_CENTRED=0".
  [[nodiscard]] std::string to_string() const;

  bool operator==(const ReadoutParameters&) const = default;
};

}  // namespace dtof
