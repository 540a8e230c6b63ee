// SPDX-License-Identifier: Apache-2.0
// poolPointer up to the pointer phase: its numbers, the events of a column, the coarse histogram of a group,
// its candidates, and the track phase of a pixel.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parameter_limits.hpp"
#include "dtof/readout/pixelwise_model.hpp"
#include "dtof/readout/pool_evidence.hpp"
#include "dtof/readout/pool_pointer.hpp"

namespace dtof {
namespace {

constexpr std::int32_t kCellsPerCoarseBin = kUnitsPerCoarseBin / kUnitsPerCell;

void require_range(const char* name, int value, int lowest, int highest) {
  if (value < lowest || value > highest) {
    throw InputError(fmt::format("{} must be {} to {}, not {}", name, lowest, highest, value));
  }
}

}  // namespace

PoolPointerParameters PoolNumbers::common() const {
  return {.group_size = group_rows,
          .labels = labels,
          .score_bits = score_bits,
          .offset_bits = offset_bits,
          .count_bits = count_bits,
          .pointer_shift = pointer_shift,
          .rival_moves = rival_moves != 0,
          .cell_shift = cell_shift,
          .second_target = second_target,
          .amplitude = amplitude,
          .prior = keeps_prior,
          .engine_columns = engine_columns,
          .coarse_share = coarse_share,
          .track_share = track_share,
          .smooth = smooth};
}

void PoolNumbers::validate() const {
  require_range("RIVAL_MOVES", rival_moves, 0, 1);
  require_range("LEFT_NEEDS_MARGIN", left_needs_margin, 0, 1);
  common().validate(count_width);
}

CoarseHistogram group_histogram(std::span<const PoolColumn> columns, std::size_t first, std::size_t rows,
                                std::uint32_t until, std::uint32_t coarse_end, int count_width) {
  // Each kSweepPeriod acquisitions, which end with a sweep, are counted apart, for the order of the counts
  // between two sweeps changes nothing.
  std::vector<CoarseHistogram> periods((coarse_end + kSweepPeriod - 1) / kSweepPeriod);
  for (const PoolColumn& column : columns) {
    const auto coarse = [&](std::size_t row) {
      const std::span<const PoolEvent> events =
          row < column.size() ? std::span<const PoolEvent>(column[row]) : std::span<const PoolEvent>();
      const auto end = std::ranges::partition_point(
          events, [&](const PoolEvent& event) { return event.acquisition < std::min(until, coarse_end); });
      return events.first(static_cast<std::size_t>(end - events.begin()));
    };
    for (std::size_t row = first; row < std::min(column.size(), first + rows); row += 2) {
      count_one_of_two_rows(coarse(row), coarse(row + 1), [&](const PoolEvent& event) {
        if (event.acquisition % kSweepPeriod != kSweepPeriod - 1) {
          ++periods[event.acquisition / kSweepPeriod][event.preferred / kUnitsPerCoarseBin];
        }
      });
    }
  }
  CoarseHistogram histogram{};
  bool frozen = false;
  for (std::size_t period = 0; period < periods.size() && !frozen; ++period) {
    const bool ends_with_sweep = (period + 1) * kSweepPeriod <= coarse_end;
    frozen = !count_period(histogram, periods[period], ends_with_sweep, count_width);
  }
  return histogram;
}

PoolGroup decode_group(const GroupHistograms& histograms, const UsedCells& used, std::uint32_t acquisitions,
                       const PoolNumbers& parameters) {
  const CoarseHistogram& own = *histograms.own;
  const int significance_bits = parameters.common().significance_bits();
  const int lost_bits = kPoolBackgroundBits - parameters.common().background_bits();
  const int offset = significance_offset(acquisitions);
  const int unit = pool_template_unit(parameters.count_width);
  std::array<int, kCoarseBins> bins{};
  for (std::size_t i = 0; i < kCoarseBins; ++i) {
    bins[i] = parameters.own_weight * own[i];
    for (const CoarseHistogram* neighbour : histograms.neighbours) {
      bins[i] += (*neighbour)[i];
    }
    bins[i] = std::max(bins[i] - unit * parameters.coarse_template[i], 0);
  }
  PairSums sums{};
  TakenPairs raised{};
  for (std::size_t i = 0; i < kCoarsePairs; ++i) {
    sums[i] = bins[i] + bins[i + 1];
    const std::int32_t middle = kCellsPerCoarseBin * (static_cast<std::int32_t>(i) + 1);
    raised[i] = std::ranges::any_of(
        used, [&](std::int32_t cell) { return std::abs(middle - cell) <= parameters.prior_reach; });
    sums[i] += raised[i] ? parameters.prior_weight : 0;
  }
  PoolGroup group{};
  group.labels = parameters.labels;
  group.score_limit = (1 << parameters.score_bits) - 1;
  // The group's word has no room for the lowest bits; the middle of what they can be stands for them.
  group.background =
      ((group_background(own, parameters.count_width) >> lost_bits) << lost_bits) + ((1 << lost_bits) >> 1);
  group.tilted = significance_bits > 0 && group_tilted(own);
  TakenPairs taken = hidden_pairs(parameters.coarse_template);
  int least = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < kCoarsePairs; ++i) {
    least = taken[i] ? least : std::min(least, sums[i]);
  }
  PairSums before = sums;  // the last candidate took its leakage
  for (int label = 0; label < group.labels; ++label) {
    const std::size_t peak = highest_pair(sums, taken);
    const auto k = static_cast<std::size_t>(label);
    group.centre_cell[k] = centre_cell(sums, peak);
    group.significance[k] = kept_significance(
        significance(sums, before, {peak, raised[peak], histograms.missing}, parameters.prior_weight, offset),
        significance_bits);
    before = sums;
    take_leakage(sums, peak, std::max(sums[peak] - least, 0) >> parameters.leak_shift);
    take_pairs(taken, peak);
  }
  return group;
}

PoolColumn pool_column_events(const ColumnStream& column, int np, std::uint32_t acquisitions) {
  ReadoutParameters limits;
  limits.readout = Readout::kPoolPointer;
  limits.np = np;
  require_legal(limits, "NP");
  const auto fraction_bits = static_cast<unsigned>(16 - np);
  PoolColumn events(static_cast<std::size_t>(column.rows()));
  for (int row = 0; row < column.rows(); ++row) {
    check_detections(column.row(row), row, limits, acquisitions);
    std::vector<PoolEvent>& pixel = events[static_cast<std::size_t>(row)];
    int seen = 0;
    for (const Detection& detection : column.row(row)) {
      if (detection.timestamp == limits.no_detection()) {
        continue;
      }
      const auto position = static_cast<std::uint16_t>((std::uint32_t{detection.timestamp} << fraction_bits) +
                                                       ((1U << fraction_bits) >> 1U));
      if (pixel.empty() || pixel.back().acquisition != detection.acquisition) {
        pixel.push_back({detection.acquisition, position, position});
        seen = 1;
      } else if (++seen == 2) {
        (detection.acquisition % 2 == 1 ? pixel.back().preferred : pixel.back().other) = position;
      }
    }
  }
  return events;
}

std::array<int, 2> smooth_reach_of(int cell_shift) {
  return cell_shift > kCellShift ? std::array{2048, 2048} : std::array{1024, 1536};
}

PoolNumbers pool_pointer_parameters(const ReadoutParameters& parameters) {
  const PoolNumbers own{.count_width = parameters.count_width,
                        .group_rows = parameters.pool.group_size,
                        .labels = parameters.pool.labels,
                        .score_bits = parameters.pool.score_bits,
                        .offset_bits = parameters.pool.offset_bits,
                        .count_bits = parameters.pool.count_bits,
                        .pointer_shift = parameters.pool.pointer_shift,
                        .rival_moves = parameters.pool.rival_moves ? 1 : 0,
                        .cell_shift = parameters.pool.cell_shift,
                        .engine_columns = parameters.pool.engine_columns,
                        .coarse_share = parameters.pool.coarse_share,
                        .track_share = parameters.pool.track_share,
                        .smooth = parameters.pool.smooth,
                        .smooth_reach = smooth_reach_of(parameters.pool.cell_shift),
                        .coarse_template = parameters.pool.coarse_template,
                        .keeps_prior = parameters.pool.prior,
                        .second_target = parameters.pool.second_target,
                        .amplitude = parameters.pool.amplitude};
  own.validate();
  return own;
}

}  // namespace dtof
