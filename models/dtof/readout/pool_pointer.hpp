// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/readout/pool_parts.hpp"

namespace dtof {

// poolPointer: combines two columns and several rows in a group, and columns with their neighbours within an
// engine. Names as in docs/reference/poolpointer.md.

/// Cost base + (slope * B >> 4), where B is the background of a group.
struct PoolCost {
  int base;
  int slope;

  [[nodiscard]] int at(int background) const { return base + ((slope * background) >> 4); }
  bool operator==(const PoolCost&) const = default;
};

/// Constants and parameters of poolPointer. A cell is a quarter of a coarse bin, a unit 2^-11 of a coarse
/// bin.
struct PoolNumbers {
  int count_width = 7;  ///< bits of a coarse bin
  int group_rows = 4;   ///< rows of a group, in two columns
  int labels = 5;       ///< candidates of a group
  int score_bits = 4;   ///< width of a candidate's score
  /// Width of the leader's offset in the track phase (signed, 32nds of a coarse bin); 0: no offset.
  int offset_bits = 6;
  int count_bits = 7;       ///< n, width of the leader's advantage
  int pointer_shift = 1;    ///< unit of the leader's pointer: 2^pointer_shift units
  int rival_moves = 1;      ///< 1: the rival has a pointer of 7 bits; 0: it stays at its candidate
  int cell_shift = 9;       ///< cells around a settled pointer have 2^cell_shift units
  int engine_columns = 34;  ///< columns that share an engine; even
  int coarse_share = 14;    ///< 64ths of the frame: coarse phase
  int track_share = 30;     ///< 64ths of the frame: track phase

  int own_weight = 3;  ///< weight of a group's own histogram relative to its four neighbours'
  /// 2^-leak_shift of a candidate's height above the floor leaks into the pairs two further on.
  int leak_shift = 3;
  int track_reach = 4;  ///< half width of a candidate's window, cells
  std::array<int, 2> offset_gear = {
      3, 8};  ///< the offset moves by 4 below the first score, by 2 below the second

  PoolCost label_cost = {0, 2};      ///< in choose, cost of each candidate from the third on
  PoolCost choose_penalty = {2, 5};  ///< lambda of choose
  PoolCost left_cost = {2, 3};       ///< cost of a choice that differs from the left column's
  PoolCost right_limit = {1, 3};     ///< largest message from the column to the right
  int lateral_reach = 4;             ///< distance in cells at which columns still agree
  PoolCost decide_penalty = {2, 0};  ///< lambda of decide

  PointerWindows windows = {.weight = {1, 3, 4, 4, 4, 3, 2, 1}, .rival_reach = 6};

  int prior_weight = 28;  ///< added to a pair of bins where the last frame used a candidate
  int prior_reach = 2;    ///< largest distance from that candidate, cells

  int left_needs_margin =
      0;  ///< 1: a pixel whose best two labels tie sends no message to the column to the right

  bool smooth = true;  ///< S1
  std::array<int, 2> smooth_reach = {1024,
                                     1536};  ///< units: T of dark and of bright groups, for S1 and for starts
  int smooth_bright_from = 6;                ///< background B from which a group counts as bright

  PoolTemplate coarse_template{};  ///< subtracted from the coarse bins in decode (TEMPLATE)

  bool keeps_prior = false;    ///< the array has PRIOR = 1, whose group words have less room
  bool second_target = false;  ///< results also have the position of the losing label, before S1
  bool amplitude = false;      ///< results also have amplitude and ambient

  /// Throws InputError if a parameter is outside its range.
  void validate() const;
  /// The parameters that PoolPointerParameters has, too.
  [[nodiscard]] PoolPointerParameters common() const;
  bool operator==(const PoolNumbers&) const = default;
};

/// T in dark and in bright groups for a CELL_SHIFT: larger for long pulses.
std::array<int, 2> smooth_reach_of(int cell_shift);
/// Numbers for the parameters of a read-out; constants that are no parameters keep their defaults. Throws
/// InputError for illegal parameters.
PoolNumbers pool_pointer_parameters(const ReadoutParameters& parameters);

/// Timestamps of a pixel in one acquisition. Only the first two count: the first is preferred in even
/// acquisitions, the second in odd ones. With a single timestamp, both members hold it.
struct PoolEvent {
  std::uint32_t acquisition;
  std::uint16_t preferred;  ///< units
  std::uint16_t other;

  bool operator==(const PoolEvent&) const = default;
};
/// Events of a column: [row][event].
using PoolColumn = std::vector<std::vector<PoolEvent>>;
/// Converts a column's detections to events. Throws InputError for an NP outside 8 to 16, a timestamp above
/// the largest code or an acquisition outside the frame.
PoolColumn pool_column_events(const ColumnStream& column, int np, std::uint32_t acquisitions);

/// Cells of the candidates that pixels of a group chose. A group word can keep them for the next frame, with
/// one flag per candidate.
using UsedCells = std::vector<std::int32_t>;

/// Coarse histogram of a group of one or two columns after the coarse phase: of `rows` rows from `first` on.
/// Only events before acquisition `until` count. `coarse_end` ends the phase.
CoarseHistogram group_histogram(std::span<const PoolColumn> columns, std::size_t first, std::size_t rows,
                                std::uint32_t until, std::uint32_t coarse_end, int count_width);

/// A group's own histogram and those of its neighbours above, below, to the left and to the right. The
/// group's own histogram replaces each of the `missing` neighbours.
struct GroupHistograms {
  const CoarseHistogram* own;
  std::array<const CoarseHistogram*, 4> neighbours;
  int missing;
};
/// Decode: the group word. `used`: cells of the last frame's candidates. `acquisitions`: of the frame.
PoolGroup decode_group(const GroupHistograms& histograms, const UsedCells& used, std::uint32_t acquisitions,
                       const PoolNumbers& parameters);

/// Track: updates a pixel's track word by its timestamps of one acquisition.
void track_event(PoolTracks& word, const PoolGroup& group, const PoolEvent& event,
                 const PoolNumbers& parameters);

/// Result of a pixel after decide, before S1; or after choose, before its pointer starts.
struct PoolWinner {
  std::int32_t position;  ///< units
  std::int32_t lost;      ///< position of the losing label, units
  int advantage;          ///< n of the leader; 0 if the rival wins
  int margin;             ///< belief of the leader minus the rival's
  int background;         ///< background B of its group
  int significance = 0;   ///< significance of its group's candidates near the position
  bool tilted = false;    ///< its group is tilted (group_tilted)
};
using PoolWinners = std::vector<PoolWinner>;

/// Used cells of an engine's groups, by pair of columns, each from row 0 down. Empty before the first frame.
using PoolPrior = std::vector<UsedCells>;

/// Reads out the columns of one engine, from left to right; all must have the same number of rows. Returns
/// winners [column][row]. With `prior`, the candidates of the last frame in it get extra weight, and this
/// frame's candidates replace them.
std::vector<PoolWinners> read_engine(std::span<const PoolColumn> columns, std::uint32_t acquisitions,
                                     const PoolNumbers& parameters, PoolPrior* prior = nullptr);

/// Positions of a column's winners after smoothing S1. Each moves by a quarter of the summed distances to the
/// neighbours above, below and to the left that are within T; all positions are those before S1. `left`:
/// winners of the column to the left; empty for an engine's first column.
std::vector<std::int32_t> smoothed_positions(std::span<const PoolWinner> winners,
                                             std::span<const PoolWinner> left, const PoolNumbers& parameters);

/// Confidences of a column's winners: the evidence for a target, or the margins if the group words keep no
/// significance.
std::vector<int> pool_confidences(std::span<const PoolWinner> winners, std::span<const PoolWinner> left,
                                  const PoolNumbers& parameters);

/// Reads out an array of `count` columns from left to right, engine by engine. Returns results [column][row].
/// `priors` is for arrays with PRIOR = 1: one prior per engine, or none before the first frame; each frame
/// updates them. Throws InputError for illegal parameters, malformed streams, columns of different lengths,
/// or priors of another array.
std::vector<std::vector<PixelResult>> run_pool_pointer(int count, const ColumnReader& column, int np,
                                                       std::uint32_t acquisitions,
                                                       const PoolNumbers& parameters,
                                                       std::vector<PoolPrior>* priors = nullptr);

}  // namespace dtof
