// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_parts.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

namespace dtof {
namespace {

constexpr std::int32_t kLeanReach = kUnitsPerCoarseBin;  // of a pointer whose rival stays

struct Gear {
  int from;  // advantage
  std::int32_t step;
};
// Near the optimal gain 1 / (number of hits); the counts beyond half of the range are slowed down (below).
constexpr std::array<Gear, 9> kGears = {
    {{0, 256}, {8, 128}, {16, 64}, {32, 32}, {64, 16}, {80, 8}, {100, 4}, {116, 2}, {124, 1}}};
constexpr std::array<Gear, 6> kShortGears = {{{0, 512}, {4, 256}, {8, 128}, {12, 64}, {14, 32}, {15, 16}}};
constexpr int kShortCountBits = 4;
constexpr int kLeastTilt = 32;             // of two first octets over three emptiest ones
constexpr std::int32_t kSettledStep = 64;  // a pointer that moves by no more is near its pulse

std::array<int, 4> octets(const CoarseHistogram& histogram) {
  std::array<int, 4> sums{};
  for (std::size_t i = 0; i < kCoarseBins; ++i) {
    sums[i / 8] += histogram[i];
  }
  return sums;
}

std::int32_t gear_step(std::span<const Gear> gears, int advantage) {
  std::int32_t step = gears[0].step;
  for (const Gear& gear : gears) {
    step = advantage >= gear.from ? gear.step : step;
  }
  return step;
}

}  // namespace

bool count_period(CoarseHistogram& histogram, const CoarseHistogram& counts, bool sweep, int count_width) {
  const int limit = (1 << count_width) - 1;
  for (std::size_t i = 0; i < kCoarseBins; ++i) {
    histogram[i] = static_cast<std::uint16_t>(std::min(histogram[i] + counts[i], limit));
  }
  if (!sweep || std::ranges::max(histogram) < limit) {
    return true;
  }
  const int room = 1 << (count_width - 2);
  if (std::ranges::min(histogram) < room) {
    return false;
  }
  for (std::uint16_t& bin : histogram) {
    bin = static_cast<std::uint16_t>(bin - room);
  }
  return true;
}

int group_background(const CoarseHistogram& histogram, int count_width) {
  return (5 * std::ranges::min(octets(histogram))) >> count_width;
}

bool group_tilted(const CoarseHistogram& histogram) {
  const std::array<int, 4> sums = octets(histogram);
  return 2 * sums[0] > 3 * std::ranges::min(sums) + kLeastTilt;
}

TakenPairs hidden_pairs(const PoolTemplate& coarse_template) {
  TakenPairs hidden{};
  for (std::size_t bin = 0; bin < kMostHiddenBins; ++bin) {
    if (coarse_template[bin] >= kHiddenFrom) {
      std::fill(hidden.begin() + static_cast<std::ptrdiff_t>(bin > 0 ? bin - 1 : 0),
                hidden.begin() + static_cast<std::ptrdiff_t>(bin + kHiddenReach), true);
    }
  }
  return hidden;
}

std::size_t highest_pair(const PairSums& sums, const TakenPairs& taken) {
  std::size_t best = kCoarsePairs;
  for (std::size_t i = 0; i < kCoarsePairs; ++i) {
    if (!taken[i] && (best == kCoarsePairs || sums[i] > sums[best])) {
      best = i;
    }
  }
  return best;
}

void take_pairs(TakenPairs& taken, std::size_t peak) {
  for (std::size_t i = peak > 0 ? peak - 1 : 0; i <= std::min(peak + 1, kCoarsePairs - 1); ++i) {
    taken[i] = true;
  }
}

void take_leakage(PairSums& sums, std::size_t peak, int excess) {
  if (peak >= 2) {
    sums[peak - 2] = std::max(sums[peak - 2] - excess, 0);
  }
  if (peak + 2 < kCoarsePairs) {
    sums[peak + 2] = std::max(sums[peak + 2] - excess, 0);
  }
}

std::int32_t centre_cell(const PairSums& sums, std::size_t peak) {
  const int before = peak > 0 ? sums[peak - 1] : 0;
  const int after = peak + 1 < kCoarsePairs ? sums[peak + 1] : 0;
  const int tilt = after - before;
  const int height = sums[peak] - std::min(before, after);
  const bool tilted = height > 0 && 2 * std::abs(tilt) > height;
  const int shift = tilted ? (tilt > 0 ? 1 : -1) : 0;
  return 4 * (static_cast<std::int32_t>(peak) + 1) + shift;
}

bool thinned(std::int32_t position, std::uint32_t acquisition) {
  if (((acquisition >> 4U) & 3U) != 0) {
    return false;
  }
  // Bits 6 to 8 in reverse order, which spreads the levels over short frames.
  const std::uint32_t level =
      ((acquisition >> 4U) & 4U) | ((acquisition >> 6U) & 2U) | ((acquisition >> 8U) & 1U);
  constexpr unsigned kEighth = 13;
  return level < 7 - (static_cast<std::uint32_t>(position) >> kEighth);
}

void move_offset(PoolTracks& word, const PoolGroup& group, std::int32_t position, int step, int offset_bits) {
  const std::int32_t distance =
      in_cells(position - group.centre(word.leader) - word.offset * kUnitsPerOffset);
  if (within(distance, kReachCells) && distance != 0 && distance != -1) {
    const int end = 1 << (offset_bits - 1);
    word.offset = std::clamp(word.offset + (distance > 0 ? step : -step), -end, end - 1);
  }
}

void score_candidate(PoolTracks& word, const PoolGroup& group, std::int32_t position, std::int32_t reach,
                     bool leads) {
  const std::int32_t cell = in_cells(position);
  for (int label = 0; label < group.labels; ++label) {
    const auto index = static_cast<std::size_t>(label);
    if (!within(cell - group.centre_cell[index], reach)) {
      continue;
    }
    if (word.score[index] < group.score_limit) {
      ++word.score[index];
    } else {
      for (int other = 0; other < group.labels; ++other) {
        int& score = word.score[static_cast<std::size_t>(other)];
        score -= other != label && score > 0 ? 1 : 0;
      }
    }
    if (leads && label != word.leader &&
        word.score[index] > word.score[static_cast<std::size_t>(word.leader)]) {
      word.leader = label;
      word.offset = 0;
    }
    return;  // the first candidate that fits takes the timestamp
  }
}

BestLabels best_labels(std::span<const int> values) {
  const auto best = [&](int except) {
    int winner = -1;
    for (int label = 0; label < static_cast<int>(values.size()); ++label) {
      if (label != except && (winner < 0 || values[static_cast<std::size_t>(label)] >
                                                values[static_cast<std::size_t>(winner)])) {
        winner = label;
      }
    }
    return winner;
  };
  const int first = best(-1);
  return {first, best(first)};
}

PoolPointerWord first_pointer_word(const PoolTracks& tracks, const PoolGroup& group,
                                   std::span<const int> beliefs, const PoolPointerParameters& parameters) {
  const auto start = [&](int label) {
    return group.centre(label) + (label == tracks.leader ? tracks.offset * kUnitsPerOffset : 0);
  };
  const auto [leader, rival] = best_labels(beliefs);
  const int margin = beliefs[static_cast<std::size_t>(leader)] - beliefs[static_cast<std::size_t>(rival)];
  return {.leader = leader,
          .advantage = std::min(margin, (1 << (parameters.count_bits - 1)) - 1),
          .pointer = start(leader),
          .rival = parameters.rival_moves ? start(rival) / kUnitsPerCell : rival};
}

void follow_pointers(PoolPointerWord& word, const PoolGroup& group, std::int32_t position,
                     std::uint32_t acquisition, const PointerWindows& windows,
                     const PoolPointerParameters& parameters) {
  const PoolPointerWord before = word;
  const std::int32_t step =
      gear_step(parameters.count_bits <= kShortCountBits ? std::span<const Gear>(kShortGears) : kGears,
                before.advantage);
  const std::int32_t distance =
      in_cells(position - before.pointer, step <= kSettledStep ? parameters.cell_shift : kCellShift);
  const bool hit = within(distance, kHitCells);
  const std::int32_t rival_distance =
      in_cells(position) -
      (parameters.rival_moves ? before.rival : group.centre_cell[static_cast<std::size_t>(before.rival)]);
  const bool rival_hit = !hit && within(rival_distance, windows.rival_reach);

  if (within(distance, kReachCells)) {
    const std::int32_t weight =
        windows.weight[static_cast<std::size_t>(distance >= 0 ? distance : ~distance)];
    // A quarter of the product, whose part below the pointer's unit becomes a probability.
    const std::int32_t unit = std::int32_t{1} << parameters.pointer_shift;
    const auto number = static_cast<std::int32_t>(acquisition & 0xFFU);
    const std::int32_t dither = (number & 3) * unit + ((number >> 2) & (unit - 1));
    const std::int32_t move = ((step * weight + dither) >> 2) & -unit;
    const std::int32_t lowest = parameters.rival_moves ? 0 : group.centre(before.leader) - kLeanReach;
    const std::int32_t end =
        parameters.rival_moves ? kPoolPositions : group.centre(before.leader) + kLeanReach;
    word.pointer = std::clamp(before.pointer + (distance >= 0 ? move : -move), lowest, end - unit);
  }
  if (rival_hit && parameters.rival_moves) {
    const int move = rival_distance > 0 ? 1 : rival_distance < 0 ? -1 : 0;
    word.rival = before.rival + move;  // towards a timestamp, so within the range
  }
  const int full = 1 << parameters.count_bits;
  const std::uint32_t skip = before.advantage < full / 2 ? 0U : before.advantage < full * 3 / 4 ? 3U : 15U;
  const bool counted = (acquisition & skip) == 0 && !thinned(position, acquisition);
  if (hit) {
    word.advantage = std::min(before.advantage + (counted ? 1 : 0), full - 1);
  } else if (rival_hit && before.advantage == 0) {
    word.advantage = 1;
    if (parameters.rival_moves) {
      word.pointer = before.rival * kUnitsPerCell + kUnitsPerCell / 2;
      word.rival = before.pointer / kUnitsPerCell;
    } else {
      word.pointer = group.centre(before.rival);
      std::swap(word.leader, word.rival);
    }
  } else if (rival_hit && counted) {
    word.advantage = before.advantage - 1;
  }
}

std::vector<std::array<int, kMostLabels>> chain_beliefs(std::span<const ChainNode> chain) {
  using Messages = std::array<int, kMostLabels>;
  const auto send = [](const ChainNode& from, const Messages& incoming, const ChainNode& to) {
    Messages sums{};
    int best = std::numeric_limits<int>::min();
    for (std::size_t k = 0; k < static_cast<std::size_t>(from.labels); ++k) {
      sums[k] = from.evidence[k] + incoming[k];
      best = std::max(best, sums[k]);
    }
    Messages message{};
    for (std::size_t l = 0; l < static_cast<std::size_t>(to.labels); ++l) {
      message[l] = -from.penalty;
      for (std::size_t k = 0; k < static_cast<std::size_t>(from.labels); ++k) {
        if (std::abs(from.position[k] - to.position[l]) <= kUnitsPerCoarseBin) {
          message[l] = std::max(message[l], sums[k] - best);
        }
      }
    }
    return message;
  };
  std::vector<Messages> beliefs(chain.size());
  Messages incoming{};
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (i > 0) {
      incoming = send(chain[i - 1], incoming, chain[i]);
    }
    beliefs[i] = incoming;
  }
  incoming = {};
  for (std::size_t i = chain.size(); i-- > 0;) {
    if (i + 1 < chain.size()) {
      incoming = send(chain[i + 1], incoming, chain[i]);
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(chain[i].labels); ++k) {
      beliefs[i][k] += chain[i].evidence[k] + incoming[k];
    }
  }
  return beliefs;
}

int pool_amplitude(int advantage, int count_bits) {
  const int half = 1 << (count_bits - 1);
  const int three_quarters = half + half / 2;
  if (advantage < half) {
    return advantage;
  }
  const int counts = half + 4 * (std::min(advantage, three_quarters) - half);
  return counts + 16 * std::max(advantage - three_quarters, 0);
}

std::uint16_t pool_word(std::int32_t position, unsigned fraction_bits) {
  // The code's fraction counts from its low end; its middle is what a timestamp stands for.
  const auto half_bin = static_cast<std::int32_t>((1U << fraction_bits) >> 1U);
  const std::int32_t end = kPoolPositions - (1 << fraction_bits);  // 2^NP - 1 is no code
  return static_cast<std::uint16_t>(std::clamp(position - half_bin, 0, end - 1));
}

PixelResult pool_result(std::int32_t position, int confidence, unsigned fraction_bits) {
  const unsigned word = pool_word(position, fraction_bits);
  return {static_cast<std::uint16_t>(word >> fraction_bits),
          static_cast<std::uint16_t>(word & ((1U << fraction_bits) - 1)),
          static_cast<std::uint16_t>(confidence)};
}

}  // namespace dtof
