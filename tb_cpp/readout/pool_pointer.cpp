// SPDX-License-Identifier: Apache-2.0
#include "readout/pool_pointer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "readout/pixelwise_model.hpp"
#include "readout/pool_parts.hpp"

namespace dtof {
namespace {

constexpr int kSmoothedLabels = 3;  // the first candidates use the neighbouring groups too
constexpr PointerWindows kWindows = {.weight = {1, 2, 3, 4, 4, 3, 2, 1}, .rival_reach = kHitCells};
constexpr std::int32_t kLateStep = 64;

std::int32_t rival_position(const PoolPointerWord& word, const PoolGroup& group,
                            const PoolPointerParameters& parameters) {
  return parameters.rival_moves ? word.rival * kUnitsPerCell + kUnitsPerCell / 2 : group.centre(word.rival);
}

}  // namespace

PoolGroup decode_group(const CoarseHistogram& own, const CoarseHistogram& above, const CoarseHistogram& below,
                       int count_width, const PoolPointerParameters& parameters) {
  PoolGroup group{};
  group.background = group_background(own, count_width);
  const bool bright = group.background >= parameters.bright_from;
  group.labels = bright ? parameters.bright_labels : parameters.dark_labels;
  group.score_limit = (1 << (bright ? parameters.bright_score_bits : parameters.dark_score_bits)) - 1;

  PairSums alone{};
  PairSums pooled{};  // three times the own histogram and both neighbours
  for (std::size_t i = 0; i < kCoarsePairs; ++i) {
    alone[i] = own[i] + own[i + 1];
    pooled[i] = 3 * alone[i] + above[i] + above[i + 1] + below[i] + below[i + 1];
  }
  const int least = std::ranges::min(alone);
  TakenPairs taken{};
  for (int label = 0; label < group.labels; ++label) {
    const PairSums& source = label < kSmoothedLabels ? pooled : alone;
    const std::size_t peak = highest_pair(source, taken);
    group.centre_cell[static_cast<std::size_t>(label)] = centre_cell(source, peak);
    take_leakage(alone, peak, std::max(alone[peak] - least, 0) >> 2);
    take_leakage(pooled, peak, std::max(pooled[peak] - 5 * least, 0) >> 2);
    take_pairs(taken, peak);
  }
  return group;
}

void follow_tracks(PoolTracks& word, const PoolGroup& group, std::int32_t position,
                   const PoolPointerParameters& parameters) {
  const bool leads = parameters.offset_bits > 0;
  if (leads) {
    move_offset(word, group, position, 1, parameters.offset_bits);
  }
  score_candidate(word, group, position, kHitCells, leads);
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
                     std::uint32_t acquisition, bool late, const PoolPointerParameters& parameters) {
  constexpr std::int32_t kNoLimit = std::numeric_limits<std::int32_t>::max();
  follow_pointers(word, group, position, acquisition, late ? kLateStep : kNoLimit, kWindows, parameters);
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

  std::vector<PoolGroup> coarse_phase(std::vector<std::span<const Timed>>& rest,
                                      const PoolSchedule& schedule) const {
    const auto size = static_cast<std::size_t>(pool_.group_size);
    std::vector<CoarseHistogram> histograms((rest.size() + size - 1) / size, CoarseHistogram{});
    const auto limit = static_cast<std::uint16_t>((1U << static_cast<unsigned>(parameters_.count_width)) - 1);
    for (std::size_t row = 0; row < rest.size(); row += 2) {
      const std::span<const Timed> even = take_until(rest[row], schedule.coarse_end);
      const std::span<const Timed> odd =
          row + 1 < rest.size() ? take_until(rest[row + 1], schedule.coarse_end) : std::span<const Timed>();
      count_one_of_two_rows(even, odd, [&](const Timed& timed) {
        std::uint16_t& bin =
            histograms[row / size][static_cast<std::size_t>(timed.position / kUnitsPerCoarseBin)];
        bin = static_cast<std::uint16_t>(bin + (bin < limit ? 1 : 0));
      });
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
      PixelResult result = pool_result(chain[row].position[margin >= 0 ? 0 : 1], margin, fraction_bits_);
      if (pool_.second_target) {
        const PixelResult lost =
            pool_result(chain[row].position[margin >= 0 ? 1 : 0], margin, fraction_bits_);
        result.second = static_cast<std::uint16_t>((unsigned{lost.code} << fraction_bits_) | lost.fraction);
      }
      results.push_back(result);
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
