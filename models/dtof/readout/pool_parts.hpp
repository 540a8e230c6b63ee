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

// Building blocks of poolPointer's phases. Names as in docs/reference/poolpointer.md. Positions are in units
// of 2^-11 coarse bin: 16 bits for the range, for any NP. A cell is a quarter of a coarse bin, 512 units.
// Only around a settled pointer does the size of cells follow the pulse (CELL_SHIFT).

inline constexpr std::size_t kCoarseBins = 32;
inline constexpr std::size_t kMostLabels = 8;
inline constexpr std::int32_t kUnitsPerCoarseBin = 2048;
inline constexpr std::int32_t kUnitsPerCell = 512;
inline constexpr std::size_t kCoarsePairs = kCoarseBins - 1;
inline constexpr int kFirstPenalisedLabel = 2;
inline constexpr int kCellShift = 9;            // log2 kUnitsPerCell
inline constexpr std::int32_t kHitCells = 5;    // a timestamp within this distance supports the pointer
inline constexpr std::int32_t kReachCells = 8;  // timestamps beyond this distance do not move the pointer
inline constexpr std::int32_t kUnitsPerOffset = kUnitsPerCoarseBin / 32;
inline constexpr std::int32_t kPoolPositions = 1 << 16;
inline constexpr int kThinnedFrom = 4;  // background B of a group from which its scores are thinned

using CoarseHistogram = std::array<std::uint16_t, kCoarseBins>;

/// The last acquisition of each kSweepPeriod is a sweep, which counts nothing and lowers full histograms.
inline constexpr std::uint32_t kSweepPeriod = 64;
/// Adds the counts of one period to a group's histogram; bins saturate at 2^count_width - 1. With `sweep`,
/// every bin of a histogram with a full bin falls by 2^(count_width - 2). Returns false if some bin is too
/// small for that: the histogram is then frozen, and nothing may be added any more.
bool count_period(CoarseHistogram& histogram, const CoarseHistogram& counts, bool sweep, int count_width);

/// The group word: what a group keeps of its coarse histogram.
struct PoolGroup {
  int labels;                                 ///< candidates in use
  int score_limit;                            ///< 2^score bits - 1
  int background;                             ///< B, 0 .. 39
  bool tilted;                                ///< the first octet has far more counts than the emptiest one
  std::array<int, kMostLabels> significance;  ///< significance of each candidate, as stored
  /// 0 .. 127; a candidate's position is the cell's low end.
  std::array<std::int32_t, kMostLabels> centre_cell;

  [[nodiscard]] std::int32_t centre(int label) const {
    return kUnitsPerCell * centre_cell[static_cast<std::size_t>(label)];
  }
};

/// Track word of a pixel.
struct PoolTracks {
  std::array<int, kMostLabels> score{};
  int leader = 0;
  int offset = 0;  ///< offset of the leader, 32nds of a coarse bin
};

/// Pointer word of a pixel.
struct PoolPointerWord {
  int leader;            ///< label of the leader; only stored if the rival does not move
  int advantage;         ///< advantage of the leader over the rival, 0 .. 2^count_bits - 1
  std::int32_t pointer;  ///< pointer of the leader, units
  int rival;             ///< pointer of the rival, cells; its label if the rival does not move
};

/// Sums over adjacent pairs of coarse bins, and which pairs a candidate or its neighbourhood occupies.
using PairSums = std::array<int, kCoarsePairs>;
using TakenPairs = std::array<bool, kCoarsePairs>;

/// True if `distance` lies in -reach <= distance < reach. Distances in cells are rounded down.
constexpr bool within(std::int32_t distance, std::int32_t reach) {
  return distance >= -reach && distance < reach;
}
constexpr std::int32_t in_cells(std::int32_t distance, int shift = kCellShift) { return distance >> shift; }

/// Background B of a group, from the emptiest octet of its histogram.
int group_background(const CoarseHistogram& histogram, int count_width);
/// True if the first octet has more than 1.5 times as many counts as the emptiest one, plus 16. Then light is
/// so strong that both timestamps of a pixel come early, and margins mean little.
bool group_tilted(const CoarseHistogram& histogram);
/// Pairs that are excluded as candidates because a pointer there would follow crosstalk. Excluded are pairs
/// with a hidden bin and the two pairs above it. A bin is hidden if it is one of the first kMostHiddenBins
/// and its TEMPLATE entry is at least kHiddenFrom.
inline constexpr std::size_t kMostHiddenBins = 7;  // so that 8 candidates always find free pairs
inline constexpr int kHiddenFrom = 128;
inline constexpr std::size_t kHiddenReach = 3;  // pairs excluded for each hidden bin
TakenPairs hidden_pairs(const PoolTemplate& coarse_template);
/// Index of the largest sum of a free pair, the lowest on a tie; kCoarsePairs if no pair is free.
std::size_t highest_pair(const PairSums& sums, const TakenPairs& taken);
void take_pairs(TakenPairs& taken, std::size_t peak);
/// Subtracts `excess` from the sums two pairs below and two pairs above the peak, into which its pulse leaks.
void take_leakage(PairSums& sums, std::size_t peak, int excess);
std::int32_t centre_cell(const PairSums& sums, std::size_t peak);

/// True if the timestamp at `position` is thinned in this acquisition: it counts for no label. Pile-up leaves
/// more background in the early part of the range. In the first eighth 7 of 32 acquisitions are thinned, in
/// each later eighth one less, so that an early label gains nothing from this background.
bool thinned(std::int32_t position, std::uint32_t acquisition);

/// Moves the leader's offset by `step` towards the timestamp at `position`.
void move_offset(PoolTracks& word, const PoolGroup& group, std::int32_t position, int step, int offset_bits);
/// Raises the score of the first candidate whose window (`reach` cells to either side) holds the timestamp at
/// `position`. If `leads`, the candidate may become the leader.
void score_candidate(PoolTracks& word, const PoolGroup& group, std::int32_t position, std::int32_t reach,
                     bool leads);

struct BestLabels {
  int best;    ///< lowest label on a tie
  int second;  ///< best of the other labels
};
BestLabels best_labels(std::span<const int> values);

/// First pointer word of a pixel, from its track word.
PoolPointerWord first_pointer_word(const PoolTracks& tracks, const PoolGroup& group,
                                   std::span<const int> beliefs, const PoolPointerParameters& parameters);

/// Windows of the pointer phase. Distances are in cells.
struct PointerWindows {
  std::array<std::int32_t, 8> weight;  ///< weight of a timestamp by its distance (redescending M-estimator)
  std::int32_t rival_reach;            ///< a timestamp within this distance supports the rival
  bool operator==(const PointerWindows&) const = default;
};
/// Updates the pointer word by a timestamp at `position`.
void follow_pointers(PoolPointerWord& word, const PoolGroup& group, std::int32_t position,
                     std::uint32_t acquisition, const PointerWindows& windows,
                     const PoolPointerParameters& parameters);

/// Labels of one pixel in the chain along a column.
struct ChainNode {
  int labels;
  int penalty;                                     ///< lambda of the messages that this pixel sends
  std::array<std::int32_t, kMostLabels> position;  ///< units
  std::array<int, kMostLabels> evidence;
};
/// Max-marginals of a chain, result[pixel][label], up to a constant per pixel. A max-marginal is the largest
/// sum of evidences along the chain, minus the pixel's `penalty` wherever neighbours are more than a coarse
/// bin apart.
std::vector<std::array<int, kMostLabels>> chain_beliefs(std::span<const ChainNode> chain);

/// Counts that an advantage of `count_bits` bits stands for. It counts every hit below half of its range,
/// every fourth below three quarters, and every sixteenth above.
int pool_amplitude(int advantage, int count_bits);

/// Code and fraction of a position as one number.
std::uint16_t pool_word(std::int32_t position, unsigned fraction_bits);
/// Result of a winner at `position`.
PixelResult pool_result(std::int32_t position, int confidence, unsigned fraction_bits);

/// Calls `count` for each timestamp that two adjacent pixels of a column count in the coarse phase. Each
/// acquisition counts one timestamp: in even acquisitions the even row's, in odd ones the odd row's, and the
/// other row's if that one has none. Both spans must be sorted by `acquisition`.
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
