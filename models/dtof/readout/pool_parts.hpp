// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

// The parts of poolPointer below the level of its phases (docs/reference/poolpointer.md, which has the
// same names). Positions are in units of 2^-11 coarse bin: 16 bits for the range, whatever NP. A cell is a
// quarter of a coarse bin, 512 units; only around a pointer that has settled cells are as large as the pulse
// asks.

inline constexpr std::size_t kCoarseBins = 32;
inline constexpr std::size_t kMostLabels = 8;
inline constexpr std::int32_t kUnitsPerCoarseBin = 2048;
inline constexpr std::int32_t kUnitsPerCell = 512;
inline constexpr std::size_t kCoarsePairs = kCoarseBins - 1;
inline constexpr int kFirstPenalisedLabel = 2;
inline constexpr int kCellShift = 9;            // log2 kUnitsPerCell
inline constexpr std::int32_t kHitCells = 5;    // a timestamp this near to a pointer supports it
inline constexpr std::int32_t kReachCells = 8;  // farther timestamps move nothing
inline constexpr std::int32_t kUnitsPerOffset = kUnitsPerCoarseBin / 32;
inline constexpr std::int32_t kPoolPositions = 1 << 16;

using CoarseHistogram = std::array<std::uint16_t, kCoarseBins>;

/// The last acquisition of each kSweepPeriod is a sweep: nothing counts in it, and full histograms make room.
inline constexpr std::uint32_t kSweepPeriod = 64;
/// Adds the counts of one period to a group's histogram; bins saturate at 2^count_width - 1. With `sweep`, a
/// histogram that has a full bin makes room: every bin falls by 2^(count_width - 2). Returns false where some
/// bin is too small for that: the histogram is then frozen, and nothing may be added any more.
bool count_period(CoarseHistogram& histogram, const CoarseHistogram& counts, bool sweep, int count_width);

/// What a group keeps of its coarse histogram: the group word.
struct PoolGroup {
  int labels;                                         ///< candidates in use
  int score_limit;                                    ///< 2^score bits - 1
  int background;                                     ///< B, 0 .. 39
  bool tilted;                                        ///< the first octet has far more than the emptiest one
  std::array<int, kMostLabels> significance;          ///< of a candidate, as kept
  std::array<std::int32_t, kMostLabels> centre_cell;  ///< 0 .. 127; the candidate's position is its low end

  [[nodiscard]] std::int32_t centre(int label) const {
    return kUnitsPerCell * centre_cell[static_cast<std::size_t>(label)];
  }
};

/// Track word of a pixel.
struct PoolTracks {
  std::array<int, kMostLabels> score{};
  int leader = 0;
  int offset = 0;  ///< of the leader, 32nds of a coarse bin
};

/// Pointer word of a pixel.
struct PoolPointerWord {
  int leader;            ///< its label; only kept if the rival does not move
  int advantage;         ///< of the leader over the rival, 0 .. 2^count_bits - 1
  std::int32_t pointer;  ///< of the leader, units
  int rival;             ///< rival's pointer, cells, or its label if it does not move
};

/// Sums over adjacent pairs of coarse bins, and which of them are taken by a candidate or beside one.
using PairSums = std::array<int, kCoarsePairs>;
using TakenPairs = std::array<bool, kCoarsePairs>;

/// Distances are floored to whole cells: a window of n of them begins at -n and ends before n.
constexpr bool within(std::int32_t distance, std::int32_t reach) {
  return distance >= -reach && distance < reach;
}
constexpr std::int32_t in_cells(std::int32_t distance, int shift = kCellShift) { return distance >> shift; }

/// B of a group from the emptiest octet of its histogram's bins.
int group_background(const CoarseHistogram& histogram, int count_width);
/// True where the first octet has more than one and a half times as many counts as the emptiest one, and 16:
/// where
/// light is so strong that a pixel's two timestamps come early, margins say little.
bool group_tilted(const CoarseHistogram& histogram);
/// Pairs that have a hidden bin, or lie up to two beyond: one of the first kMostHiddenBins whose entry of
/// TEMPLATE is kHiddenFrom or more. They are no candidates: a pointer that starts there would follow the
/// crosstalk.
inline constexpr std::size_t kMostHiddenBins = 7;  // so that 8 candidates find their pairs
inline constexpr int kHiddenFrom = 128;
inline constexpr std::size_t kHiddenReach = 3;  // pairs from a hidden bin's own on
TakenPairs hidden_pairs(const PoolTemplate& coarse_template);
/// The largest sum not taken, the lowest on a tie; kCoarsePairs if all are taken.
std::size_t highest_pair(const PairSums& sums, const TakenPairs& taken);
void take_pairs(TakenPairs& taken, std::size_t peak);
/// Takes `excess` from the pairs two before and two after the peak, where the peak's pulse leaks.
void take_leakage(PairSums& sums, std::size_t peak, int excess);
std::int32_t centre_cell(const PairSums& sums, std::size_t peak);

/// Moves the leader's offset by `step` towards the timestamp.
void move_offset(PoolTracks& word, const PoolGroup& group, std::int32_t position, int step, int offset_bits);
/// Scores the first candidate whose window, `reach` cells either side, has the timestamp; it may become the
/// leader if `leads`.
void score_candidate(PoolTracks& word, const PoolGroup& group, std::int32_t position, std::int32_t reach,
                     bool leads);

struct BestLabels {
  int best;    ///< lowest label on a tie
  int second;  ///< of the others
};
BestLabels best_labels(std::span<const int> values);

/// What a pixel begins the pointer phase with.
PoolPointerWord first_pointer_word(const PoolTracks& tracks, const PoolGroup& group,
                                   std::span<const int> beliefs, const PoolPointerParameters& parameters);

/// Windows of the pointer phase, in cells.
struct PointerWindows {
  std::array<std::int32_t, 8> weight;  ///< of a timestamp by its distance: a redescending M-estimator
  std::int32_t rival_reach;            ///< a timestamp this near supports the rival
  bool operator==(const PointerWindows&) const = default;
};
/// The word after a timestamp at `position` of acquisition `acquisition`.
void follow_pointers(PoolPointerWord& word, const PoolGroup& group, std::int32_t position,
                     std::uint32_t acquisition, const PointerWindows& windows,
                     const PoolPointerParameters& parameters);

/// A pixel's labels in a chain along the column.
struct ChainNode {
  int labels;
  int penalty;                                     ///< lambda of messages that this pixel sends
  std::array<std::int32_t, kMostLabels> position;  ///< units
  std::array<int, kMostLabels> evidence;
};
/// Max-marginals: for each pixel and label the largest sum of evidences along the chain less `penalty`
/// wherever neighbours are more than a coarse bin apart, but for a constant of the pixel.
std::vector<std::array<int, kMostLabels>> chain_beliefs(std::span<const ChainNode> chain);

/// Code and fraction of a position as one number.
std::uint16_t pool_word(std::int32_t position, unsigned fraction_bits);
/// The result of a winner at `position`.
PixelResult pool_result(std::int32_t position, int confidence, unsigned fraction_bits);

/// What two adjacent pixels of a column count in the coarse phase: a timestamp per acquisition, the even
/// row's in even ones, the odd row's in odd ones, and the other's where that one has none. Both are ascending
/// by their member `acquisition`.
template <typename Timed, typename Count>
void count_one_of_two_rows(std::span<const Timed> even, std::span<const Timed> odd, const Count& count) {
  std::size_t e = 0;
  std::size_t o = 0;
  while (e < even.size() || o < odd.size()) {
    const bool has_even = e < even.size() && (o == odd.size() || even[e].acquisition <= odd[o].acquisition);
    const bool has_odd = o < odd.size() && (e == even.size() || odd[o].acquisition <= even[e].acquisition);
    const bool takes_even = has_even && (!has_odd || even[e].acquisition % 2 == 0);
    count(takes_even ? even[e] : odd[o]);
    e += has_even ? 1 : 0;
    o += has_odd ? 1 : 0;
  }
}

}  // namespace dtof
