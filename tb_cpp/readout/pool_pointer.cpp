// SPDX-License-Identifier: Apache-2.0
#include "readout/pool_pointer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "readout/pixelwise_model.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPairs = kCoarseBins - 1;
constexpr int kSmoothedLabels = 3;  // the first candidates use the neighbouring groups too
constexpr int kFirstPenalisedLabel = 2;

constexpr std::int32_t kHitCells = 5;    // a timestamp this near supports a candidate
constexpr std::int32_t kReachCells = 8;  // farther timestamps move nothing
constexpr std::int32_t kUnitsPerOffset = kUnitsPerCoarseBin / 32;
constexpr std::int32_t kLeanReach = kUnitsPerCoarseBin;  // of a pointer whose rival stays
constexpr std::int32_t kPositions = 1 << 16;

/// Distances are floored to whole cells: a window of n of them begins at -n and ends before n.
bool within(std::int32_t distance, std::int32_t reach) { return distance >= -reach && distance < reach; }

std::int32_t in_cells(std::int32_t distance) { return distance >> 9; }

/// Weight of a timestamp by its distance in cells: a redescending M-estimator.
constexpr std::array<std::int32_t, 8> kWeight = {1, 2, 3, 4, 4, 3, 2, 1};
constexpr std::int32_t kLateStep = 64;

struct Gear {
  int from;  // advantage
  std::int32_t step;
};
// Near the optimal gain 1 / (number of hits); the counts beyond half of the range are slowed down (below).
constexpr std::array<Gear, 9> kGears = {
    {{0, 256}, {8, 128}, {16, 64}, {32, 32}, {64, 16}, {80, 8}, {100, 4}, {116, 2}, {124, 1}}};
constexpr std::array<Gear, 6> kShortGears = {{{0, 512}, {4, 256}, {8, 128}, {12, 64}, {14, 32}, {15, 16}}};
constexpr int kShortCountBits = 4;

template <std::size_t kCount>
std::int32_t gear_step(const std::array<Gear, kCount>& gears, int advantage) {
  std::int32_t step = gears[0].step;
  for (const Gear& gear : gears) {
    step = advantage >= gear.from ? gear.step : step;
  }
  return step;
}

std::int32_t rival_position(const PoolPointerWord& word, const PoolGroup& group,
                            const PoolPointerParameters& parameters) {
  return parameters.rival_moves ? word.rival * kUnitsPerCell + kUnitsPerCell / 2 : group.centre(word.rival);
}

int signed_limit(int value, int bits) {
  return bits == 0 ? 0 : std::clamp(value, -(1 << (bits - 1)), (1 << (bits - 1)) - 1);
}

/// Pair sums over adjacent coarse bins, from which candidates are taken one after the other.
struct PairSums {
  std::array<int, kPairs> pooled;  // three times the own histogram and both neighbours
  std::array<int, kPairs> own;
};

void take(PairSums& sums, std::array<bool, kPairs>& taken, std::size_t peak, int least_own) {
  const int own_excess = std::max(sums.own[peak] - least_own, 0) >> 2;
  const int pooled_excess = std::max(sums.pooled[peak] - 5 * least_own, 0) >> 2;
  for (std::size_t i = 0; i < kPairs; ++i) {
    const std::size_t distance = i > peak ? i - peak : peak - i;
    taken[i] = taken[i] || distance <= 1;
    if (distance == 2) {
      sums.own[i] = std::max(sums.own[i] - own_excess, 0);
      sums.pooled[i] = std::max(sums.pooled[i] - pooled_excess, 0);
    }
  }
}

std::size_t highest(const std::array<int, kPairs>& sums, const std::array<bool, kPairs>& taken) {
  std::size_t best = kPairs;
  for (std::size_t i = 0; i < kPairs; ++i) {
    if (!taken[i] && (best == kPairs || sums[i] > sums[best])) {
      best = i;
    }
  }
  return best;
}

std::int32_t centre_cell(const std::array<int, kPairs>& sums, std::size_t peak) {
  const int before = peak > 0 ? sums[peak - 1] : 0;
  const int after = peak + 1 < kPairs ? sums[peak + 1] : 0;
  const int tilt = after - before;
  const int height = sums[peak] - std::min(before, after);
  const bool tilted = height > 0 && 2 * std::abs(tilt) > height;
  const int shift = tilted ? (tilt > 0 ? 1 : -1) : 0;
  return 4 * (static_cast<std::int32_t>(peak) + 1) + shift;
}

}  // namespace

PoolGroup decode_group(const CoarseHistogram& own, const CoarseHistogram& above, const CoarseHistogram& below,
                       int count_width, const PoolPointerParameters& parameters) {
  PoolGroup group{};
  int least_eighth = std::numeric_limits<int>::max();
  for (std::size_t eighth = 0; eighth < kCoarseBins; eighth += 8) {
    int sum = 0;
    for (std::size_t i = eighth; i < eighth + 8; ++i) {
      sum += own[i];
    }
    least_eighth = std::min(least_eighth, sum);
  }
  group.background = (5 * least_eighth) >> count_width;
  const bool bright = group.background >= parameters.bright_from;
  group.labels = bright ? parameters.bright_labels : parameters.dark_labels;
  group.score_limit = (1 << (bright ? parameters.bright_score_bits : parameters.dark_score_bits)) - 1;

  PairSums sums{};
  for (std::size_t i = 0; i < kPairs; ++i) {
    sums.own[i] = own[i] + own[i + 1];
    sums.pooled[i] = 3 * sums.own[i] + above[i] + above[i + 1] + below[i] + below[i + 1];
  }
  const int least_own = std::ranges::min(sums.own);
  std::array<bool, kPairs> taken{};
  for (int label = 0; label < group.labels; ++label) {
    const auto& source = label < kSmoothedLabels ? sums.pooled : sums.own;
    const std::size_t peak = highest(source, taken);
    group.centre_cell[static_cast<std::size_t>(label)] = centre_cell(source, peak);
    take(sums, taken, peak, least_own);
  }
  return group;
}

void follow_tracks(PoolTracks& word, const PoolGroup& group, std::int32_t position,
                   const PoolPointerParameters& parameters) {
  if (parameters.offset_bits > 0) {
    const std::int32_t distance =
        in_cells(position - group.centre(word.leader) - word.offset * kUnitsPerOffset);
    if (within(distance, kReachCells) && distance != 0 && distance != -1) {
      word.offset = signed_limit(word.offset + (distance > 0 ? 1 : -1), parameters.offset_bits);
    }
  }
  const std::int32_t cell = in_cells(position);
  for (int label = 0; label < group.labels; ++label) {
    const auto index = static_cast<std::size_t>(label);
    const std::int32_t distance = cell - group.centre_cell[index];
    if (!within(distance, kHitCells)) {
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
    if (parameters.offset_bits > 0 && label != word.leader &&
        word.score[index] > word.score[static_cast<std::size_t>(word.leader)]) {
      word.leader = label;
      word.offset = 0;
    }
    return;  // the first candidate that fits takes the timestamp
  }
}

PoolPointerWord first_pointer_word(const PoolTracks& tracks, const PoolGroup& group,
                                   std::span<const int> beliefs, const PoolPointerParameters& parameters) {
  const auto best = [&](int except) {
    int winner = -1;
    for (int label = 0; label < static_cast<int>(beliefs.size()); ++label) {
      if (label != except && (winner < 0 || beliefs[static_cast<std::size_t>(label)] >
                                                beliefs[static_cast<std::size_t>(winner)])) {
        winner = label;
      }
    }
    return winner;
  };
  const auto start = [&](int label) {
    return group.centre(label) + (label == tracks.leader ? tracks.offset * kUnitsPerOffset : 0);
  };
  const int leader = best(-1);
  const int rival = best(leader);
  const int margin = beliefs[static_cast<std::size_t>(leader)] - beliefs[static_cast<std::size_t>(rival)];
  return {.leader = leader,
          .advantage = std::min(margin, (1 << (parameters.count_bits - 1)) - 1),
          .pointer = start(leader),
          .rival = parameters.rival_moves ? start(rival) / kUnitsPerCell : rival};
}

void follow_pointers(PoolPointerWord& word, const PoolGroup& group, std::int32_t position,
                     std::uint32_t acquisition, bool late, const PoolPointerParameters& parameters) {
  const PoolPointerWord before = word;
  const std::int32_t distance = in_cells(position - before.pointer);
  const bool hit = within(distance, kHitCells);
  const std::int32_t rival_distance =
      in_cells(position) -
      (parameters.rival_moves ? before.rival : group.centre_cell[static_cast<std::size_t>(before.rival)]);
  const bool rival_hit = !hit && within(rival_distance, kHitCells);

  if (within(distance, kReachCells)) {
    const bool short_count = parameters.count_bits <= kShortCountBits;
    std::int32_t step =
        short_count ? gear_step(kShortGears, before.advantage) : gear_step(kGears, before.advantage);
    step = late ? std::min(step, kLateStep) : step;
    const std::int32_t weight = kWeight[static_cast<std::size_t>(distance >= 0 ? distance : ~distance)];
    // A quarter of the product, whose part below the pointer's unit becomes a probability.
    const std::int32_t unit = std::int32_t{1} << parameters.pointer_shift;
    const auto number = static_cast<std::int32_t>(acquisition & 0xFFU);
    const std::int32_t dither = (number & 3) * unit + ((number >> 2) & (unit - 1));
    const std::int32_t move = ((step * weight + dither) >> 2) & -unit;
    const std::int32_t lowest = parameters.rival_moves ? 0 : group.centre(before.leader) - kLeanReach;
    const std::int32_t end = parameters.rival_moves ? kPositions : group.centre(before.leader) + kLeanReach;
    word.pointer = std::clamp(before.pointer + (distance >= 0 ? move : -move), lowest, end - unit);
  }
  if (rival_hit && parameters.rival_moves) {
    const int move = rival_distance > 0 ? 1 : rival_distance < 0 ? -1 : 0;
    word.rival = before.rival + move;  // towards a timestamp, so within the range
  }
  const int full = 1 << parameters.count_bits;
  const std::uint32_t skip = before.advantage < full / 2 ? 0U : before.advantage < full * 3 / 4 ? 3U : 15U;
  const bool counted = (acquisition & skip) == 0;
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

namespace {

class PoolPointerModel final : public ReadoutModel {
 public:
  explicit PoolPointerModel(const ReadoutParameters& parameters)
      : parameters_(parameters),
        pool_(parameters.pool),
        no_detection_(static_cast<Timestamp>(parameters.no_detection())),
        fraction_bits_(static_cast<unsigned>(parameters.fraction_bits)) {}

  /// Throws InputError for a timestamp or an acquisition outside the frame's range.
  [[nodiscard]] std::vector<PixelResult> run_column(const ColumnStream& column,
                                                    std::uint32_t acquisitions) override {
    const PoolSchedule schedule(acquisitions, pool_);
    const auto rows = static_cast<std::size_t>(column.rows());
    std::vector<std::vector<Timed>> used;
    for (int row = 0; row < column.rows(); ++row) {
      check_detections(column.row(row), row, parameters_, acquisitions);
      used.push_back(one_an_acquisition(column.row(row)));
    }
    std::vector<std::span<const Timed>> rest(used.begin(), used.end());
    const std::vector<PoolGroup> groups = coarse_phase(rest, schedule);
    const auto group_of = [&](std::size_t row) -> const PoolGroup& {
      return groups[row / static_cast<std::size_t>(pool_.group_size)];
    };
    std::vector<PoolTracks> tracks(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      for (const Timed& timed : take_until(rest[row], schedule.track_end)) {
        follow_tracks(tracks[row], group_of(row), timed.position, pool_);
      }
    }
    std::vector<PoolPointerWord> words = choose_labels(tracks, group_of);
    for (std::size_t row = 0; row < rows; ++row) {
      for (const Timed& timed : rest[row]) {
        follow_pointers(words[row], group_of(row), timed.position, timed.acquisition,
                        timed.acquisition >= schedule.late_begin, pool_);
      }
    }
    return decide(words, group_of);
  }

  /// Throws InputError: the acquisition's number matters, which a sampler does not draw.
  void run_sampled_column(PixelSampler& /*sampler*/, int /*column*/, std::uint32_t /*acquisitions*/,
                          std::span<PixelResult> /*results*/) override {
    throw InputError(fmt::format("{} needs the exact photon model", readout_name(parameters_.readout)));
  }

 private:
  struct Timed {
    std::uint32_t acquisition;
    std::int32_t position;
  };

  /// What a pixel uses: the first timestamp of an acquisition, but in odd ones the second if there is one.
  [[nodiscard]] std::vector<Timed> one_an_acquisition(std::span<const Detection> row) const {
    const auto half_bin = static_cast<std::int32_t>((1U << fraction_bits_) >> 1U);
    std::vector<Timed> used;
    int seen = 0;
    for (const Detection& detection : row) {
      if (detection.timestamp == no_detection_) {
        continue;
      }
      const Timed timed{detection.acquisition,
                        static_cast<std::int32_t>(detection.timestamp) * (1 << fraction_bits_) + half_bin};
      if (used.empty() || used.back().acquisition != timed.acquisition) {
        used.push_back(timed);
        seen = 1;
      } else if (++seen == 2 && timed.acquisition % 2 == 1) {
        used.back() = timed;
      }
    }
    return used;
  }

  /// The timestamps before acquisition `end`, which are dropped from `rest`.
  static std::span<const Timed> take_until(std::span<const Timed>& rest, std::uint32_t end) {
    const auto last =
        std::ranges::partition_point(rest, [end](const Timed& timed) { return timed.acquisition < end; });
    const auto taken = rest.first(static_cast<std::size_t>(last - rest.begin()));
    rest = rest.subspan(taken.size());
    return taken;
  }

  /// What two adjacent pixels count: a timestamp per acquisition, the even row's in even ones, the odd row's
  /// in odd ones, and the other's where that one has none.
  static std::vector<Timed> one_of_two_rows(std::span<const Timed> even, std::span<const Timed> odd) {
    std::vector<Timed> counted;
    std::ranges::merge(even, odd, std::back_inserter(counted), {}, &Timed::acquisition, &Timed::acquisition);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < counted.size(); ++kept) {
      // Of two of the same acquisition the even row's comes first.
      const bool both = i + 1 < counted.size() && counted[i].acquisition == counted[i + 1].acquisition;
      counted[kept] = counted[both && counted[i].acquisition % 2 == 1 ? i + 1 : i];
      i += both ? 2 : 1;
    }
    counted.resize(kept);
    return counted;
  }

  std::vector<PoolGroup> coarse_phase(std::vector<std::span<const Timed>>& rest,
                                      const PoolSchedule& schedule) const {
    const auto size = static_cast<std::size_t>(pool_.group_size);
    std::vector<CoarseHistogram> histograms((rest.size() + size - 1) / size, CoarseHistogram{});
    const auto limit = static_cast<std::uint16_t>((1U << static_cast<unsigned>(parameters_.count_width)) - 1);
    for (std::size_t row = 0; row < rest.size(); row += 2) {
      const std::span<const Timed> even = take_until(rest[row], schedule.coarse_end);
      const std::span<const Timed> odd =
          row + 1 < rest.size() ? take_until(rest[row + 1], schedule.coarse_end) : std::span<const Timed>();
      for (const Timed& timed : one_of_two_rows(even, odd)) {
        std::uint16_t& bin =
            histograms[row / size][static_cast<std::size_t>(timed.position / kUnitsPerCoarseBin)];
        bin = static_cast<std::uint16_t>(bin + (bin < limit ? 1 : 0));
      }
    }
    std::vector<PoolGroup> groups;
    for (std::size_t g = 0; g < histograms.size(); ++g) {
      const CoarseHistogram& above = histograms[g > 0 ? g - 1 : g];
      const CoarseHistogram& below = histograms[g + 1 < histograms.size() ? g + 1 : g];
      groups.push_back(decode_group(histograms[g], above, below, parameters_.count_width, pool_));
    }
    return groups;
  }

  template <typename GroupOf>
  std::vector<PoolPointerWord> choose_labels(const std::vector<PoolTracks>& tracks,
                                             const GroupOf& group_of) const {
    std::vector<ChainNode> chain;
    for (std::size_t row = 0; row < tracks.size(); ++row) {
      const PoolGroup& group = group_of(row);
      ChainNode node{
          .labels = group.labels, .penalty = 2 + (group.background >> 2), .position = {}, .evidence = {}};
      for (int label = 0; label < group.labels; ++label) {
        const auto index = static_cast<std::size_t>(label);
        node.position[index] = group.centre(label);
        node.evidence[index] =
            tracks[row].score[index] - (label >= kFirstPenalisedLabel ? group.background >> 2 : 0);
      }
      chain.push_back(node);
    }
    const auto beliefs = chain_beliefs(chain);
    std::vector<PoolPointerWord> words;
    for (std::size_t row = 0; row < tracks.size(); ++row) {
      words.push_back(first_pointer_word(
          tracks[row], group_of(row),
          std::span(beliefs[row]).first(static_cast<std::size_t>(chain[row].labels)), pool_));
    }
    return words;
  }

  template <typename GroupOf>
  std::vector<PixelResult> decide(const std::vector<PoolPointerWord>& words, const GroupOf& group_of) const {
    std::vector<ChainNode> chain;
    for (std::size_t row = 0; row < words.size(); ++row) {
      const PoolGroup& group = group_of(row);
      chain.push_back({.labels = 2,
                       .penalty = 4 + (group.background >> 3),
                       .position = {words[row].pointer, rival_position(words[row], group, pool_)},
                       .evidence = {words[row].advantage, 0}});
    }
    const auto beliefs = chain_beliefs(chain);
    std::vector<PixelResult> results;
    for (std::size_t row = 0; row < words.size(); ++row) {
      const int margin = beliefs[row][0] - beliefs[row][1];
      // The code's fraction counts from its low end; its middle is what a timestamp stands for.
      const auto half_bin = static_cast<std::int32_t>((1U << fraction_bits_) >> 1U);
      const std::int32_t end = kPositions - (1 << fraction_bits_);  // M - 1 is no code
      const auto position = static_cast<std::uint32_t>(
          std::clamp(chain[row].position[margin >= 0 ? 0 : 1] - half_bin, 0, end - 1));
      results.push_back({static_cast<std::uint16_t>(position >> fraction_bits_),
                         static_cast<std::uint16_t>(position & ((1U << fraction_bits_) - 1)),
                         static_cast<std::uint16_t>(std::abs(margin))});
    }
    return results;
  }

  ReadoutParameters parameters_;
  PoolPointerParameters pool_;
  Timestamp no_detection_;
  unsigned fraction_bits_;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_pool_pointer(const ReadoutParameters& parameters) {
  return std::make_unique<PoolPointerModel>(parameters);
}

}  // namespace dtof
