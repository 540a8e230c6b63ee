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

// poolPointer: pools over two columns and four rows, and from column to column within an engine
// (docs/reference/poolpointer.md, which has the same names).

/// base + (slope * B >> 4), B the background of a group.
struct PoolCost {
  int base;
  int slope;

  [[nodiscard]] int at(int background) const { return base + ((slope * background) >> 4); }
  bool operator==(const PoolCost&) const = default;
};

/// Numbers of poolPointer. Lengths in cells are a quarter of a coarse bin, units 2^-11 of one.
struct PoolNumbers {
  int count_width = 7;      ///< bits of a coarse bin
  int group_rows = 4;       ///< of two columns
  int labels = 5;           ///< candidates of a group
  int score_bits = 4;       ///< of each
  int offset_bits = 6;      ///< leader's offset in the track phase, 32nds of a coarse bin, signed; 0: none
  int count_bits = 7;       ///< n, the leader's advantage
  int pointer_shift = 1;    ///< the leader's pointer has the unit 2^pointer_shift
  int rival_moves = 1;      ///< 1: the rival has a pointer of 7 bits; 0: it stays at its candidate
  int cell_shift = 9;       ///< cells of a settled pointer have 2^cell_shift units
  int engine_columns = 34;  ///< columns that share an engine; even
  int coarse_share = 14;    ///< 64ths of the frame: coarse phase
  int track_share = 20;     ///< 64ths of the frame: track phase

  int own_weight = 3;   ///< of a group's own histogram beside its four neighbours
  int leak_shift = 3;   ///< of a candidate's height above the floor, what leaks into the pair two further on
  int track_reach = 4;  ///< cells: window of a candidate
  std::array<int, 2> offset_gear = {
      3, 8};  ///< the offset moves by 4 below the first score, by 2 below the other

  PoolCost label_cost = {0, 2};      ///< what the candidates from the third on pay in choose
  PoolCost choose_penalty = {2, 5};  ///< lambda of choose
  PoolCost left_cost = {2, 3};       ///< for a candidate unlike the column to the left's choice
  PoolCost right_limit = {1, 3};     ///< largest message of the column to the right
  int lateral_reach = 4;             ///< cells: as far apart columns still agree
  PoolCost decide_penalty = {2, 0};  ///< lambda of decide

  PointerWindows windows = {.weight = {1, 3, 4, 4, 4, 3, 2, 1}, .rival_reach = 6};

  int prior_weight = 28;  ///< what a pair of bins gains where a candidate of the last frame was used
  int prior_reach = 2;    ///< cells: as far from that candidate

  int left_needs_margin =
      0;  ///< 1: a pixel whose best two labels are equal tells the column to the right nothing

  bool smooth = true;  ///< S1
  std::array<int, 2> smooth_reach = {1024,
                                     1536};  ///< units: T of dark and of bright groups, S1's and starts'
  int smooth_bright_from = 6;                ///< B from which a group is bright there

  PoolTemplate coarse_template{};  ///< what decode takes from the coarse bins

  bool keeps_prior = false;    ///< the array is one with PRIOR = 1, whose group words have less room
  bool second_target = false;  ///< a result has the position of the label that lost, too, without S1

  /// Throws InputError.
  void validate() const;
  /// Those that other read-outs have, too.
  [[nodiscard]] PoolPointerParameters common() const;
  bool operator==(const PoolNumbers&) const = default;
};

/// T in dark and in bright groups, longer for long pulses.
std::array<int, 2> smooth_reach_of(int cell_shift);
/// Those of a read-out as every other is described, with the numbers that have no description at their
/// defaults. Throws InputError for illegal ones.
PoolNumbers pool_pointer_parameters(const ReadoutParameters& parameters);

/// What a pixel had in an acquisition: the timestamp it prefers and its other one, the same if it has none.
/// The first two of an acquisition count; the first is preferred in even ones, the second in odd ones.
struct PoolEvent {
  std::uint32_t acquisition;
  std::uint16_t preferred;  ///< units
  std::uint16_t other;

  bool operator==(const PoolEvent&) const = default;
};
/// A column's events, pixel by pixel.
using PoolColumn = std::vector<std::vector<PoolEvent>>;
/// Throws InputError for an NP outside 8 to 16, a timestamp above its largest code or an acquisition outside
/// the frame.
PoolColumn pool_column_events(const ColumnStream& column, int np, std::uint32_t acquisitions);

/// A pixel after decide, before S1; or after choose, before its pointer starts.
struct PoolWinner {
  std::int32_t position;  ///< units
  std::int32_t lost;      ///< units: of the label that lost
  int margin;             ///< belief of the leader less the rival's
  int background;         ///< B of its group
  int significance = 0;   ///< of its group's candidates near the position
  bool tilted = false;    ///< its group
};
using PoolWinners = std::vector<PoolWinner>;

/// Cells of the candidates that some pixel of a group chose, which the group's word can keep for the next
/// frame: the candidates are there anyway, a flag of each says whether it was used.
using UsedCells = std::vector<std::int32_t>;
/// Those of an engine's groups, pair of columns by pair, from row 0 down; empty before the first frame.
using PoolPrior = std::vector<UsedCells>;

/// Reads the columns of one engine, left to right, all with the same number of rows; index: column, row.
/// With `prior`, candidates begin from what the last frame left there, and this frame leaves its own.
std::vector<PoolWinners> read_engine(std::span<const PoolColumn> columns, std::uint32_t acquisitions,
                                     const PoolNumbers& parameters, PoolPrior* prior = nullptr);

/// Positions of a column's winners after S1: each moves by a quarter of the sum of its neighbours' distances,
/// as far as these are within T: those above and below and the one to the left, all before they have moved.
/// `left`: the winners of the column to the left, empty for an engine's first column.
std::vector<std::int32_t> smoothed_positions(std::span<const PoolWinner> winners,
                                             std::span<const PoolWinner> left, const PoolNumbers& parameters);

/// Confidences of a column's winners: how much speaks for a target, or their margins where the parameters
/// keep no significance.
std::vector<int> pool_confidences(std::span<const PoolWinner> winners, std::span<const PoolWinner> left,
                                  const PoolNumbers& parameters);

/// Reads an array of `count` columns, column by column from left to right, engine by engine; index: column,
/// row. With `priors`, one for each engine or none before the first frame, a video's frame that the last one
/// helps (read_engine), of an array with PRIOR = 1. Throws InputError for illegal parameters, malformed
/// streams, columns of different lengths or priors of another array.
std::vector<std::vector<PixelResult>> run_pool_pointer(int count, const ColumnReader& column, int np,
                                                       std::uint32_t acquisitions,
                                                       const PoolNumbers& parameters,
                                                       std::vector<PoolPrior>* priors = nullptr);

}  // namespace dtof
