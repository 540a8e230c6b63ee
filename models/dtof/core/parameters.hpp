// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dtof/core/readout.hpp"

namespace dtof {

/// Throws InputError naming the legal names.
Readout parse_readout(std::string_view name);

/// What decode takes from each coarse bin's sum over a group and its neighbours, in units of
/// pool_template_unit(): the TEMPLATE registers of poolPointer (docs/reference/poolpointer.md, Template).
using PoolTemplate = std::array<std::uint8_t, 32>;
/// 2^(COUNT_WIDTH - 5), at least 1: 255 units are more than the largest sum.
constexpr int pool_template_unit(int count_width) { return count_width > 5 ? 1 << (count_width - 5) : 1; }

/// Parameters of the pool read-outs beyond those they share with the others (docs/reference/poolpointer.md).
/// Lengths are fractions of a coarse bin, a 32nd of the range.
struct PoolPointerParameters {
  int group_size =
      4;           ///< GROUP_SIZE, rows of a group, which shares a coarse histogram, a power of two, 4 .. 32
  int labels = 5;  ///< candidate depths of a group, 2 .. 8
  int score_bits = 4;  ///< width of a candidate's score in a pixel word, 1 .. 4
  int offset_bits =
      6;               ///< leader's offset in the track phase, 32nds of a coarse bin, signed, 2 .. 6; 0: none
  int count_bits = 7;  ///< ADVANTAGE_WIDTH: the leader's advantage in the pointer phase, 4 or 7
  /// The unit of the leader's pointer is 2^(pointer_shift - 11) coarse bins; 0 .. 2, or 0 .. 4 if count_bits
  /// is 4.
  int pointer_shift = 1;
  bool rival_moves = true;  ///< the rival has a pointer of 7 bits; else it stays at its candidate
  /// CELL_SHIFT: cells of a settled pointer have 2^cell_shift positions, 8 .. 10
  int cell_shift = 9;
  bool second_target = false;  ///< SECOND_TARGET: a result has the position of the label that lost, too
  bool prior = false;          ///< PRIOR: the array keeps which candidates a frame has used, for the next one
  int coarse_share = 14;       ///< 64ths of the frame: coarse phase
  int track_share = 20;        ///< 64ths of the frame: track phase
  int engine_columns = 34;     ///< ENGINE_COLUMNS, columns that share an engine and hear each other, even
  bool smooth = true;          ///< S1 is on
  PoolTemplate coarse_template{};  ///< TEMPLATE registers, of crosstalk and fog; 0: none

  static PoolPointerParameters defaults(Readout readout);
  /// Throws InputError; `count_width`: bits of a coarse bin.
  void validate(int count_width) const;
  /// Bits of a pixel word.
  [[nodiscard]] int word_bits() const;
  /// Highest bits of a group's background that its word keeps: 4 to 6, as many as two pixel words leave
  /// beside the candidates.
  [[nodiscard]] int background_bits() const;
  /// Bits of a candidate's significance that a group's word keeps, as many as two pixel words leave: 3, 2 or
  /// none, and none with an advantage of 4 bits or a rival that rests. Without it a result's confidence is
  /// its margin.
  [[nodiscard]] int significance_bits() const;
  /// Halves of a memory word that eight coarse bins of `count_width` bits take, 1 or 2.
  [[nodiscard]] int bin_halves(int count_width) const;
  bool operator==(const PoolPointerParameters&) const = default;
};

/// Ends of a pool read-out's phases in a frame, the schedule registers that a driver writes.
struct PoolSchedule {
  std::uint32_t coarse_end;
  std::uint32_t track_end;

  PoolSchedule(std::uint32_t acquisitions, const PoolPointerParameters& parameters);
};

/// Rows of a column of the thesis's array, and of the compiled ones.
inline constexpr int kArrayRows = 160;

/// Bits of a group's background in a pool read-out, 0 .. 39.
inline constexpr int kPoolBackgroundBits = 6;

/// Digital time gate: a timestamp x with begin <= x < end counts, any other is no detection. Codes, 0 ..
/// 2^NP - 1; with end <= begin nothing counts.
struct CodeGate {
  int begin = 0;
  int end = 0;

  [[nodiscard]] bool contains(int timestamp) const { return timestamp >= begin && timestamp < end; }
  bool operator==(const CodeGate&) const = default;
};

/// Parameters of a read-out, named as the RTL's (spec section 1; ranges in docs/reference/readouts.md).
struct ReadoutParameters {
  Readout readout = Readout::kEzPointer;
  int np = 10;               ///< NP, bits of a timestamp
  int nb = 5;                ///< NB, bits of the coarse index (unused by ezPointer, three steps, histogram)
  int slots = 2;             ///< SLOTS
  int count_width = 10;      ///< COUNT_WIDTH
  int pointer_step = 1;      ///< POINTER_STEP, bins
  int fraction_bits = 0;     ///< FRACTION_BITS (pointer read-outs, coarse histogram)
  int confidence_width = 4;  ///< CONFIDENCE_WIDTH (pointer read-outs)
  int guard = 46;            ///< GUARD, bins (hisPointer v2)
  bool window_centred = false;  ///< WINDOW_CENTRED (SiFH)
  /// TIME_GATE = 1 and what gate_begin_i and gate_end_i say when the frame starts.
  std::optional<CodeGate> time_gate;
  PoolPointerParameters pool;  ///< pool read-outs

  /// Spec defaults: NB = floor(NP/2) + 1 for SiFH (Eq. 2.3), floor(NP/2) for FiFH and hisPointer,
  /// min(NP, 6) for PiFH, NP for the histogram; GUARD = ceil(FWHM / T_res) scaled to NP. The pool read-outs
  /// have NB = 5, COUNT_WIDTH = 7 and FRACTION_BITS = 16 - NP, which is no free choice there.
  /// Throws InputError for an NP outside 3 to 16.
  static ReadoutParameters defaults(Readout readout, int np = 10);

  /// Throws InputError with the RTL's own sentence and the value if a parameter is outside its range.
  void validate() const;

  /// Neighbouring columns whose pixels hear each other, counted from column 0: those of a pool read-out's
  /// engine, else 1.
  [[nodiscard]] int columns_together() const { return is_pool_readout(readout) ? pool.engine_columns : 1; }
  /// Bins of the histogram that a raw frame shows (RAW_HISTOGRAM); 0 if the read-out holds none that is whole
  /// at a frame's end.
  [[nodiscard]] int raw_bins() const;
  /// 2^NP.
  [[nodiscard]] int code_count() const { return 1 << np; }
  /// 2^NP - 1.
  [[nodiscard]] int no_detection() const { return (1 << np) - 1; }
  /// E.g. "sifh NP=10 SLOTS=2 NB=6 COUNT_WIDTH=10 WINDOW_CENTRED=0".
  [[nodiscard]] std::string to_string() const;

  bool operator==(const ReadoutParameters&) const = default;
};

}  // namespace dtof
