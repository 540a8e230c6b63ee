// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_pointer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>

#include "dtof/core/error.hpp"
#include "dtof/readout/pixelwise_model.hpp"
#include "dtof/readout/pool_evidence.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPairColumns = 2;  // columns that share a group
constexpr int kSmoothShift = 2;          // S1 moves by a quarter
constexpr int kSettledMargin = 64;       // from this margin on, the T of dark groups suffices
constexpr std::int32_t kNoOpinion = 0;   // no candidate has this cell

/// The groups of an engine: of each pair of columns, from row 0 down.
class Groups {
 public:
  /// `prior`: of the last frame, empty if there is none.
  Groups(std::span<const PoolColumn> columns, std::uint32_t acquisitions, std::uint32_t coarse_end,
         const PoolNumbers& parameters, const PoolPrior& prior)
      : parameters_(parameters),
        rows_(static_cast<std::size_t>(parameters.group_rows)),
        acquisitions_(acquisitions) {
    const std::size_t pairs = (columns.size() + kPairColumns - 1) / kPairColumns;
    height_ = (columns.front().size() + rows_ - 1) / rows_;
    histograms_.resize(pairs * height_);
    if (!prior.empty() && prior.size() != histograms_.size()) {
      throw InputError(
          fmt::format("a prior of {} groups for an engine of {}", prior.size(), histograms_.size()));
    }
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      for (std::size_t g = 0; g < height_; ++g) {
        histograms_[index(pair, g)] = count(columns, pair, g, coarse_end);
      }
    }
    groups_.reserve(histograms_.size());
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      for (std::size_t g = 0; g < height_; ++g) {
        groups_.push_back(decode(pair, g, pairs, prior.empty() ? UsedCells() : prior[index(pair, g)]));
      }
    }
  }

  [[nodiscard]] const PoolGroup& at(std::size_t column, std::size_t row) const {
    return groups_[group_of(column, row)];
  }
  [[nodiscard]] std::size_t size() const { return groups_.size(); }
  /// Number of the group that has this pixel.
  [[nodiscard]] std::size_t group_of(std::size_t column, std::size_t row) const {
    return index(column / kPairColumns, row / rows_);
  }

 private:
  [[nodiscard]] std::size_t index(std::size_t pair, std::size_t g) const { return pair * height_ + g; }

  [[nodiscard]] CoarseHistogram count(std::span<const PoolColumn> columns, std::size_t pair, std::size_t g,
                                      std::uint32_t coarse_end) const {
    const std::size_t first = kPairColumns * pair;
    return group_histogram(columns.subspan(first, std::min(kPairColumns, columns.size() - first)), g * rows_,
                           rows_, coarse_end, coarse_end, parameters_.count_width);
  }

  [[nodiscard]] PoolGroup decode(std::size_t pair, std::size_t g, std::size_t pairs,
                                 const UsedCells& used) const {
    const auto at = [&](bool exists, std::size_t p, std::size_t row) {
      return &histograms_[exists ? index(p, row) : index(pair, g)];
    };
    const bool above = g > 0;
    const bool below = g + 1 < height_;
    const bool left = pair > 0;
    const bool right = pair + 1 < pairs;
    const int missing = (above ? 0 : 1) + (below ? 0 : 1) + (left ? 0 : 1) + (right ? 0 : 1);
    return decode_group({.own = &histograms_[index(pair, g)],
                         .neighbours = {at(above, pair, g - 1), at(below, pair, g + 1), at(left, pair - 1, g),
                                        at(right, pair + 1, g)},
                         .missing = missing},
                        used, acquisitions_, parameters_);
  }

  const PoolNumbers& parameters_;
  std::size_t rows_;  // of a group
  std::uint32_t acquisitions_;
  std::size_t height_;  // groups of a pair
  std::vector<CoarseHistogram> histograms_;
  std::vector<PoolGroup> groups_;
};

/// The preferred timestamp, but the other one if only that is inside.
template <typename Inside>
std::int32_t better_of_two(const PoolEvent& event, const Inside& inside) {
  return !inside(event.preferred) && inside(event.other) ? event.other : event.preferred;
}

bool near_a_candidate(std::int32_t position, const PoolGroup& group, const PoolNumbers& parameters) {
  return std::any_of(
      group.centre_cell.begin(), group.centre_cell.begin() + group.labels,
      [&](std::int32_t cell) { return within(in_cells(position) - cell, parameters.track_reach); });
}

void point(PoolPointerWord& word, const PoolGroup& group, const PoolEvent& event,
           const PoolNumbers& parameters) {
  std::int32_t position = event.preferred;
  PointerWindows windows = parameters.windows;
  if (parameters.rival_moves != 0) {
    position = better_of_two(
        event, [&](std::int32_t x) { return within(in_cells(x) - in_cells(word.pointer), kReachCells); });
  } else {
    windows.rival_reach = parameters.track_reach;  // the rival is a candidate
    if (event.acquisition % 2 == 0 && !near_a_candidate(event.preferred, group, parameters)) {
      position = event.other;
    }
  }
  follow_pointers(word, group, position, event.acquisition, windows, parameters.common());
}

using Evidence = std::array<int, kMostLabels>;

/// A pixel's own evidence in choose, before what the columns beside say.
Evidence own_evidence(const PoolTracks& tracks, const PoolGroup& group, const PoolNumbers& parameters) {
  Evidence evidence{};
  for (int label = 0; label < group.labels; ++label) {
    const auto k = static_cast<std::size_t>(label);
    evidence[k] =
        tracks.score[k] - (label >= kFirstPenalisedLabel ? parameters.label_cost.at(group.background) : 0);
  }
  return evidence;
}

bool agree(std::int32_t cell, std::int32_t other, const PoolNumbers& parameters) {
  return std::abs(cell - other) <= parameters.lateral_reach;
}

/// What a pixel's candidates pay for being unlike the best two of the pixel to the right.
Evidence cost_from_right(const PoolGroup& group, const PoolTracks& right_tracks, const PoolGroup& right,
                         const PoolNumbers& parameters) {
  const Evidence evidence = own_evidence(right_tracks, right, parameters);
  const BestLabels labels = best_labels(std::span(evidence).first(static_cast<std::size_t>(right.labels)));
  const auto best = static_cast<std::size_t>(labels.best);
  const auto second = static_cast<std::size_t>(labels.second);
  const int most = parameters.right_limit.at(group.background);
  Evidence cost{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(group.labels); ++k) {
    const std::int32_t cell = group.centre_cell[k];
    cost[k] = agree(cell, right.centre_cell[best], parameters) ? 0
              : agree(cell, right.centre_cell[second], parameters)
                  ? std::min(evidence[best] - evidence[second], most)
                  : most;
  }
  return cost;
}

/// Lets the leaders' pointers of a column start closer together. Returns where they would have started alone.
PoolWinners start_together(std::vector<PoolPointerWord>& words, std::size_t column, const Groups& groups,
                           const PoolWinners& left, const PoolNumbers& parameters) {
  PoolWinners alone;
  alone.reserve(words.size());
  for (std::size_t row = 0; row < words.size(); ++row) {
    alone.push_back({.position = words[row].pointer,
                     .lost = 0,
                     .advantage = words[row].advantage,
                     .margin = words[row].advantage,
                     .background = groups.at(column, row).background});
  }
  const std::vector<std::int32_t> together = smoothed_positions(alone, left, parameters);
  for (std::size_t row = 0; row < words.size(); ++row) {
    words[row].pointer = together[row];
  }
  return alone;
}

/// Chooses in all columns from left to right; index: column, row.
std::vector<std::vector<PoolPointerWord>> choose(const std::vector<std::vector<PoolTracks>>& tracks,
                                                 const Groups& groups, const PoolNumbers& parameters) {
  std::vector<std::vector<PoolPointerWord>> words(tracks.size());
  const PoolPointerParameters common = parameters.common();
  std::vector<std::int32_t> left;  // cells chosen in the column before
  PoolWinners left_starts;         // where its leaders' pointers would start alone
  for (std::size_t column = 0; column < tracks.size(); ++column) {
    std::vector<ChainNode> chain;
    for (std::size_t row = 0; row < tracks[column].size(); ++row) {
      const PoolGroup& group = groups.at(column, row);
      Evidence evidence = own_evidence(tracks[column][row], group, parameters);
      if (column > 0) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(group.labels); ++k) {
          evidence[k] -= left[row] == kNoOpinion || agree(group.centre_cell[k], left[row], parameters)
                             ? 0
                             : parameters.left_cost.at(group.background);
        }
      }
      if (column + 1 < tracks.size()) {
        const Evidence cost =
            cost_from_right(group, tracks[column + 1][row], groups.at(column + 1, row), parameters);
        for (std::size_t k = 0; k < static_cast<std::size_t>(group.labels); ++k) {
          evidence[k] -= cost[k];
        }
      }
      ChainNode node{.labels = group.labels,
                     .penalty = parameters.choose_penalty.at(group.background),
                     .position = {},
                     .evidence = evidence};
      for (int label = 0; label < group.labels; ++label) {
        node.position[static_cast<std::size_t>(label)] = group.centre(label);
      }
      chain.push_back(node);
    }
    const auto beliefs = chain_beliefs(chain);
    left.resize(chain.size());
    for (std::size_t row = 0; row < chain.size(); ++row) {
      const PoolGroup& group = groups.at(column, row);
      words[column].push_back(
          first_pointer_word(tracks[column][row], group,
                             std::span(beliefs[row]).first(static_cast<std::size_t>(group.labels)), common));
      const PoolPointerWord& word = words[column].back();
      left[row] = parameters.left_needs_margin != 0 && word.advantage == 0
                      ? kNoOpinion
                      : group.centre_cell[static_cast<std::size_t>(word.leader)];
    }
    if (parameters.rival_moves != 0) {
      left_starts = start_together(words[column], column, groups, left_starts, parameters);
    }
  }
  return words;
}

/// What the next frame may begin from.
PoolPrior used_cells(const std::vector<std::vector<PoolPointerWord>>& words, const Groups& groups) {
  PoolPrior prior(groups.size());
  for (std::size_t column = 0; column < words.size(); ++column) {
    for (std::size_t row = 0; row < words[column].size(); ++row) {
      const auto leader = static_cast<std::size_t>(words[column][row].leader);
      UsedCells& used = prior[groups.group_of(column, row)];
      const std::int32_t cell = groups.at(column, row).centre_cell[leader];
      if (std::ranges::find(used, cell) == used.end()) {
        used.push_back(cell);
      }
    }
  }
  return prior;
}

/// The largest significance of the candidates within a coarse bin of a position; 0 if there is none.
int significance_near(const PoolGroup& group, std::int32_t position, const PoolNumbers& parameters) {
  int most = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(group.labels); ++k) {
    if (agree(group.centre_cell[k], in_cells(position), parameters)) {
      most = std::max(most, group.significance[k]);
    }
  }
  return most;
}

PoolWinners decide(const std::vector<PoolPointerWord>& words, std::size_t column, const Groups& groups,
                   const PoolNumbers& parameters) {
  std::vector<ChainNode> chain;
  for (std::size_t row = 0; row < words.size(); ++row) {
    const PoolGroup& group = groups.at(column, row);
    // Beyond the range a pointer that is kept beside a candidate stands for the range's end.
    const std::int32_t leader = std::clamp(words[row].pointer, 0, kPoolPositions - 1);
    const std::int32_t rival = parameters.rival_moves != 0
                                   ? words[row].rival * kUnitsPerCell + kUnitsPerCell / 2
                                   : group.centre(words[row].rival);
    chain.push_back({.labels = 2,
                     .penalty = parameters.decide_penalty.at(group.background),
                     .position = {leader, rival},
                     .evidence = {words[row].advantage, 0}});
  }
  const auto beliefs = chain_beliefs(chain);
  PoolWinners winners;
  for (std::size_t row = 0; row < words.size(); ++row) {
    const int margin = beliefs[row][0] - beliefs[row][1];
    const std::size_t winner = margin >= 0 ? 0 : 1;
    const PoolGroup& group = groups.at(column, row);
    winners.push_back({.position = chain[row].position[winner],
                       .lost = chain[row].position[1 - winner],
                       .advantage = winner == 0 ? words[row].advantage : 0,
                       .margin = margin,
                       .background = group.background,
                       .significance = significance_near(group, chain[row].position[winner], parameters),
                       .tilted = group.tilted});
  }
  return winners;
}

/// Calls `visit` with the winners above, below and to the left whose positions are within T of a row's.
template <typename Visit>
void for_each_near_neighbour(std::span<const PoolWinner> winners, std::span<const PoolWinner> left,
                             std::size_t row, const PoolNumbers& parameters, const Visit& visit) {
  const bool bright = winners[row].background >= parameters.smooth_bright_from &&
                      std::abs(winners[row].margin) < kSettledMargin;
  const int reach = parameters.smooth_reach[bright ? 1 : 0];
  const auto visit_near = [&](const PoolWinner& neighbour) {
    if (std::abs(neighbour.position - winners[row].position) <= reach) {
      visit(neighbour);
    }
  };
  if (row > 0) {
    visit_near(winners[row - 1]);
  }
  if (row + 1 < winners.size()) {
    visit_near(winners[row + 1]);
  }
  if (!left.empty()) {
    visit_near(left[row]);
  }
}

}  // namespace

void track_event(PoolTracks& word, const PoolGroup& group, const PoolEvent& event,
                 const PoolNumbers& parameters) {
  if (group.background >= kThinnedFrom && thinned(event.preferred, event.acquisition)) {
    return;
  }
  const std::int32_t position =
      better_of_two(event, [&](std::int32_t x) { return near_a_candidate(x, group, parameters); });
  const bool leads = parameters.offset_bits > 0;
  if (leads) {
    const int score = word.score[static_cast<std::size_t>(word.leader)];
    const int step = score < parameters.offset_gear[0] ? 4 : score < parameters.offset_gear[1] ? 2 : 1;
    move_offset(word, group, event.preferred, step, parameters.offset_bits);
  }
  score_candidate(word, group, position, parameters.track_reach, leads);
}

std::vector<PoolWinners> read_engine(std::span<const PoolColumn> columns, std::uint32_t acquisitions,
                                     const PoolNumbers& parameters, PoolPrior* prior) {
  if (columns.empty()) {
    return {};
  }
  const auto share = [&](int share_64ths) {
    return static_cast<std::uint32_t>(
        (std::uint64_t{acquisitions} * static_cast<std::uint64_t>(share_64ths)) >> 6U);
  };
  const std::uint32_t coarse_end = share(parameters.coarse_share);
  const std::uint32_t track_end = share(parameters.coarse_share + parameters.track_share);
  const Groups groups(columns, acquisitions, coarse_end, parameters, prior != nullptr ? *prior : PoolPrior());
  std::vector<std::vector<PoolTracks>> tracks(columns.size());
  for (std::size_t column = 0; column < columns.size(); ++column) {
    tracks[column].resize(columns[column].size());
    for (std::size_t row = 0; row < columns[column].size(); ++row) {
      for (const PoolEvent& event : columns[column][row]) {
        if (event.acquisition >= coarse_end && event.acquisition < track_end) {
          track_event(tracks[column][row], groups.at(column, row), event, parameters);
        }
      }
    }
  }
  std::vector<std::vector<PoolPointerWord>> words = choose(tracks, groups, parameters);
  if (prior != nullptr) {
    *prior = used_cells(words, groups);
  }
  std::vector<PoolWinners> winners;
  for (std::size_t column = 0; column < columns.size(); ++column) {
    for (std::size_t row = 0; row < columns[column].size(); ++row) {
      for (const PoolEvent& event : columns[column][row]) {
        if (event.acquisition >= track_end) {
          point(words[column][row], groups.at(column, row), event, parameters);
        }
      }
    }
    winners.push_back(decide(words[column], column, groups, parameters));
  }
  return winners;
}

std::vector<std::int32_t> smoothed_positions(std::span<const PoolWinner> winners,
                                             std::span<const PoolWinner> left,
                                             const PoolNumbers& parameters) {
  std::vector<std::int32_t> positions;
  for (std::size_t row = 0; row < winners.size(); ++row) {
    const std::int32_t own = winners[row].position;
    std::int32_t sum = 0;
    for_each_near_neighbour(winners, left, row, parameters,
                            [&](const PoolWinner& neighbour) { sum += neighbour.position - own; });
    positions.push_back(own + sum / (1 << kSmoothShift));
  }
  return positions;
}

std::vector<int> pool_confidences(std::span<const PoolWinner> winners, std::span<const PoolWinner> left,
                                  const PoolNumbers& parameters) {
  const int bits = parameters.common().significance_bits();
  std::vector<int> confidences;
  for (std::size_t row = 0; row < winners.size(); ++row) {
    const PoolWinner& winner = winners[row];
    PooledMargin margin{.own = std::abs(winner.margin), .others = 0};
    for_each_near_neighbour(winners, left, row, parameters, [&](const PoolWinner& neighbour) {
      margin.others += std::abs(neighbour.margin);
    });
    confidences.push_back(
        bits == 0 ? margin.own
                  : pool_confidence(winner.significance, bits, margin, winner.background, winner.tilted));
  }
  return confidences;
}

std::vector<std::vector<PixelResult>> run_pool_pointer(int count, const ColumnReader& column, int np,
                                                       std::uint32_t acquisitions, const PoolNumbers& given,
                                                       std::vector<PoolPrior>* priors) {
  given.validate();
  PoolNumbers parameters = given;
  parameters.keeps_prior = given.keeps_prior || priors != nullptr;
  const int engines = (count + parameters.engine_columns - 1) / parameters.engine_columns;
  if (priors != nullptr && !priors->empty() && priors->size() != static_cast<std::size_t>(engines)) {
    throw InputError(fmt::format("priors of {} engines for an array of {}", priors->size(), engines));
  }
  if (priors != nullptr) {
    priors->resize(static_cast<std::size_t>(engines));
  }
  std::vector<std::vector<PixelResult>> results;
  std::vector<PoolColumn> engine;
  int rows = 0;
  for (int number = 0; number < count; ++number) {
    const ColumnStream& stream = column(number);
    rows = number == 0 ? stream.rows() : rows;
    if (stream.rows() != rows) {
      throw InputError(fmt::format("column {} has {} rows, column 0 has {}", number, stream.rows(), rows));
    }
    engine.push_back(pool_column_events(stream, np, acquisitions));
    if (engine.size() < static_cast<std::size_t>(parameters.engine_columns) && number + 1 < count) {
      continue;
    }
    PoolPrior* prior = priors != nullptr
                           ? &(*priors)[static_cast<std::size_t>(number / parameters.engine_columns)]
                           : nullptr;
    const std::vector<PoolWinners> columns = read_engine(engine, acquisitions, parameters, prior);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const PoolWinners& winners = columns[i];
      const auto left = i > 0 ? std::span<const PoolWinner>(columns[i - 1]) : std::span<const PoolWinner>();
      const std::vector<std::int32_t> smoothed = smoothed_positions(winners, left, parameters);
      const std::vector<int> confidences = pool_confidences(winners, left, parameters);
      std::vector<PixelResult>& pixels = results.emplace_back();
      const auto fraction_bits = static_cast<unsigned>(16 - np);
      for (std::size_t row = 0; row < winners.size(); ++row) {
        const PoolWinner& winner = winners[row];
        PixelResult result =
            pool_result(parameters.smooth ? smoothed[row] : winner.position, confidences[row], fraction_bits);
        if (parameters.second_target) {
          result.second = pool_word(winner.lost, fraction_bits);
        }
        if (parameters.amplitude) {
          result.amplitude =
              static_cast<std::uint16_t>(pool_amplitude(winner.advantage, parameters.count_bits));
          result.ambient = static_cast<std::uint16_t>(winner.background);
        }
        pixels.push_back(result);
      }
    }
    engine.clear();
  }
  return results;
}

namespace {

class PoolPointerModel final : public ReadoutModel {
 public:
  explicit PoolPointerModel(const ReadoutParameters& parameters)
      : np_(parameters.np), parameters_(pool_pointer_parameters(parameters)) {}

  /// An engine of one column.
  [[nodiscard]] std::vector<PixelResult> run_column(const ColumnStream& column,
                                                    std::uint32_t acquisitions) override {
    return run_columns(1, reader_of(std::span(&column, 1)), acquisitions).front();
  }

  [[nodiscard]] std::vector<std::vector<PixelResult>> run_columns(int count, const ColumnReader& column,
                                                                  std::uint32_t acquisitions) override {
    return run_pool_pointer(count, column, np_, acquisitions, parameters_);
  }

  void run_sampled_column(PixelSampler& /*sampler*/, int /*column*/, std::uint32_t /*acquisitions*/,
                          std::span<PixelResult> /*results*/) override {
    throw InputError("poolPointer needs the exact photon model");
  }

 private:
  int np_;
  PoolNumbers parameters_;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_pool_pointer(const ReadoutParameters& parameters) {
  return std::make_unique<PoolPointerModel>(parameters);
}

}  // namespace dtof
