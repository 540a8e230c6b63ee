// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detection.hpp"
#include "core/parameters.hpp"
#include "readout/model.hpp"

namespace dtof {

// poolPointer, step by step (docs/reference/poolpointer.md, which has the same names). Positions are in units
// of 2^-11 coarse bin: 16 bits for the range, whatever NP. A cell is a quarter of a coarse bin, 512 units.

inline constexpr std::size_t kCoarseBins = 32;
inline constexpr std::size_t kMostLabels = 8;
inline constexpr std::int32_t kUnitsPerCoarseBin = 2048;
inline constexpr std::int32_t kUnitsPerCell = 512;

using CoarseHistogram = std::array<std::uint16_t, kCoarseBins>;

/// What a group keeps of its coarse histogram: the group word.
struct PoolGroup {
  int labels;                                         ///< candidates in use
  int score_limit;                                    ///< 2^score bits - 1
  int background;                                     ///< B, 0 .. 39
  std::array<std::int32_t, kMostLabels> centre_cell;  ///< 0 .. 127; the candidate's position is its low end

  [[nodiscard]] std::int32_t centre(int label) const {
    return kUnitsPerCell * centre_cell[static_cast<std::size_t>(label)];
  }
};

/// Candidates of a group from its own histogram and those of the groups above and below (its own where there
/// is none); `count_width`: bits of a bin.
PoolGroup decode_group(const CoarseHistogram& own, const CoarseHistogram& above, const CoarseHistogram& below,
                       int count_width, const PoolPointerParameters& parameters);

/// Track word of a pixel.
struct PoolTracks {
  std::array<int, kMostLabels> score{};
  int leader = 0;
  int offset = 0;  ///< of the leader, 32nds of a coarse bin
};
/// The word after a timestamp at `position`.
void follow_tracks(PoolTracks& word, const PoolGroup& group, std::int32_t position,
                   const PoolPointerParameters& parameters);

/// Pointer word of a pixel.
struct PoolPointerWord {
  int leader;            ///< its label; only kept if the rival does not move
  int advantage;         ///< of the leader over the rival, 0 .. 2^count_bits - 1
  std::int32_t pointer;  ///< of the leader, units
  int rival;             ///< rival's pointer, cells, or its label if it does not move
};
PoolPointerWord first_pointer_word(const PoolTracks& tracks, const PoolGroup& group,
                                   std::span<const int> beliefs, const PoolPointerParameters& parameters);
/// The word after a timestamp at `position` of acquisition `acquisition`; `late`: the last 3/8 of the phase.
void follow_pointers(PoolPointerWord& word, const PoolGroup& group, std::int32_t position,
                     std::uint32_t acquisition, bool late, const PoolPointerParameters& parameters);

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

}  // namespace dtof
