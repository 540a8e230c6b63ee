// SPDX-License-Identifier: Apache-2.0
#include "rtl/frame_clocks.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace dtof {
namespace {

/// From the first result of a pixel to that of the last column. dtof_result_output keeps kPlaces results, and
/// a place is free for another one kPlaceClocks after it was promised.
std::int64_t sending_clocks(int columns) {
  constexpr std::int64_t kPlaces = 5;
  constexpr std::int64_t kPlaceClocks = 7;
  const std::int64_t last = columns - 1;
  return last / kPlaces * kPlaceClocks + last % kPlaces;
}

/// dtof_array. M5 sends a pixel's results. The scan of a pixel begins with M5 of the pixel before, and ends
/// at the earliest kAfterResults clocks behind it, for its last bin waits until the results are out.
std::uint64_t array_clocks(int rows, int simulated, const RtlStatistics& statistics, int columns) {
  constexpr std::int64_t kAfterResults = 5;
  const auto clocks_in = [&](RtlState state) {
    return static_cast<std::int64_t>(statistics.state_cycles[static_cast<std::size_t>(state)]);
  };
  const std::int64_t others = rows - 1;
  const std::int64_t scanning = clocks_in(RtlState::kM4);
  const std::int64_t sending = clocks_in(RtlState::kM5) / rows;
  // One pixel's scan, of scanning = scan + others * max(scan - sending, kAfterResults).
  const std::int64_t scan = std::min((scanning + others * sending) / rows, scanning - others * kAfterResults);
  const std::int64_t wanted_sending = sending + sending_clocks(columns) - sending_clocks(simulated);
  const std::int64_t wanted_scanning = scan + others * std::max(scan - wanted_sending, kAfterResults);
  return statistics.cycles +
         static_cast<std::uint64_t>(wanted_scanning - scanning + rows * (wanted_sending - sending));
}

/// Clocks of decide in dtof_pool_pointer2_array until the last result is sent, clock by clock: all engines
/// decide in lockstep (dtof_pool2_sequencer), and dtof_pool_result_output sends a set of results, one of each
/// engine that has the column, while two more sets wait. A step that gives results begins when there is a
/// place for them.
class Decide {
 public:
  Decide(int rows, int columns, int together)
      : rows_(rows), columns_(columns), together_(together), steps_(std::min(together, columns)) {}

  [[nodiscard]] std::int64_t clocks() {
    std::int64_t clocks = 0;
    for (int column = 0; column < steps_; ++column) {
      for (int step = 0; step < 2 * rows_ + kStepsWithoutResult; ++step) {
        const bool gives = step >= rows_ + kStepsWithoutResult;
        for (; !has_place(); ++clocks) {
          clock(0);
        }
        for (int t = 0; t + 1 < kStepClocks; ++t, ++clocks) {
          clock(0);
        }
        clock(gives ? set_of(column) : 0);
        ++clocks;
      }
    }
    for (; sets_ > 0 || given_ > 0; ++clocks) {
      clock(0);
    }
    return clocks;
  }

 private:
  static constexpr int kStepClocks = 6;
  static constexpr int kStepsWithoutResult = 9;  // of both passes of a column
  static constexpr int kPlaces = 3;
  static constexpr std::size_t kLatency = 2;  // BROADCAST_STAGES

  /// Results in a set: engines that have the column.
  [[nodiscard]] int set_of(int column) const { return (columns_ - column + together_ - 1) / together_; }

  [[nodiscard]] bool has_place() const { return sets_ + (given_ > 0 ? 1 : 0) < kPlaces; }

  /// `gives`: results of the set that is given in this clock, 0 for none.
  void clock(int gives) {
    way_.push_back(given_);
    const int arrives = way_.size() > kLatency ? way_.front() : 0;
    if (way_.size() > kLatency) {
      way_.pop_front();
    }
    sets_ += given_ > 0 ? 1 : 0;
    if (arrives > 0) {
      waiting_.push_back(arrives);
    }
    if (left_ > 0) {
      sets_ -= --left_ == 0 ? 1 : 0;
    } else if (!waiting_.empty()) {
      left_ = waiting_.front();
      waiting_.pop_front();
    }
    given_ = gives;
  }

  int rows_;
  int columns_;
  int together_;
  int steps_;
  int given_ = 0;  // results of the set that dtof_pool_result_output is told of
  int sets_ = 0;   // told of and not sent
  int left_ = 0;   // results of the set that is being sent
  std::deque<int> way_;
  std::deque<int> waiting_;
};

/// The last engine may have fewer columns than `together`.
std::optional<std::uint64_t> pool_clocks(int rows, int together, int simulated,
                                         const RtlStatistics& statistics, int columns) {
  if (simulated != std::min(together, columns)) {
    return std::nullopt;
  }
  return statistics.cycles + static_cast<std::uint64_t>(Decide(rows, columns, together).clocks() -
                                                        Decide(rows, simulated, together).clocks());
}

}  // namespace

std::optional<std::uint64_t> frame_clocks(const RtlConfiguration& configuration,
                                          const RtlStatistics& statistics, int columns) {
  const int together = configuration.parameters.columns_together();
  return together > 1
             ? pool_clocks(configuration.pixels_per_sram, together, configuration.sram_num, statistics,
                           columns)
             : array_clocks(configuration.pixels_per_sram, configuration.sram_num, statistics, columns);
}

}  // namespace dtof
