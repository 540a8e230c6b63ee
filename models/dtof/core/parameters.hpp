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
/// Lengths are fractions of a coarse bin, a 32nd of the range.
struct PoolPointerParameters {
  int group_size =
      4;           ///< GROUP_SIZE: rows of a group, which shares a coarse histogram; a power of two, 4 .. 32
  int labels = 5;  ///< LABELS: candidate depths of a group, 2 .. 8
  int score_bits = 4;  ///< SCORE_BITS: width of a candidate's score in a pixel word, 1 .. 4
  int offset_bits =
      6;  ///< OFFSET_BITS: width of the leader's offset (signed, 32nds of a coarse bin), 2 .. 6; 0: none
  int count_bits = 7;  ///< ADVANTAGE_WIDTH: bits of the leader's advantage in the pointer phase, 4 or 7
  /// POINTER_SHIFT: the leader's pointer has the unit 2^(pointer_shift - 11) coarse bins; 0 .. 2, or 0 .. 4
  /// if count_bits is 4.
  int pointer_shift = 1;
  /// RIVAL_MOVES: true: the rival has a pointer of 7 bits; false: it stays at its candidate.
  bool rival_moves = true;
  /// CELL_SHIFT: cells around a settled pointer have 2^cell_shift positions; 8 .. 10.
  int cell_shift = 9;
  bool second_target = false;  ///< SECOND_TARGET: a result also has the position of the losing label
  bool amplitude = false;      ///< AMPLITUDE: a result also has amplitude and ambient
  /// PRIOR: the array keeps the candidates that a frame used, as a prior for the next frame.
  bool prior = false;
  int coarse_share = 14;  ///< COARSE_SHARE: length of the coarse phase, 64ths of the frame
  int track_share = 30;   ///< TRACK_SHARE: length of the track phase, 64ths of the frame
  /// ENGINE_COLUMNS: columns that share an engine and use each other's results; even.
  int engine_columns = 34;
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

/// Parameters of a read-out, with the names of the RTL (spec section 1; ranges in
/// docs/reference/readouts.md).
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
