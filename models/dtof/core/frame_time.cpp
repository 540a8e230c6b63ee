// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/frame_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <vector>

namespace dtof {
namespace {

constexpr std::uint64_t kIdle = 2;      // start_i to the first state
constexpr std::uint64_t kClearEnd = 2;  // behind the last address that is cleared
constexpr std::uint64_t kScanEnd = 4;   // behind the last address that a coarse scan reads

/// Clocks of decide in dtof_pool_pointer_array until the last result is sent, clock by clock: all engines
/// decide in lockstep (dtof_pool_sequencer), and dtof_pool_result_output sends a set of results, one of each
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
  int given_ = 0;  // results of the set that the engine announces to dtof_pool_result_output
  int sets_ = 0;   // announced and not sent
  int left_ = 0;   // results of the set that is being sent
  std::deque<int> way_;
  std::deque<int> waiting_;
};

std::uint64_t u(std::int64_t value) { return static_cast<std::uint64_t>(value); }

/// Bins of a pixel in the one memory that a read-out's measurements share.
std::uint64_t memory_bins(const ReadoutParameters& parameters) {
  constexpr std::uint64_t kThreeSteps = 16;
  switch (parameters.readout) {
    case Readout::kEzPointer:
      return 1;  // its word
    case Readout::kThreeSteps:
      return kThreeSteps;
    case Readout::kHistogram:
      return u(parameters.code_count());
    case Readout::kFifh:
      return std::max(u(1) << static_cast<unsigned>(parameters.nb),
                      u(1) << static_cast<unsigned>(parameters.np - parameters.nb));
    default:
      return u(1) << static_cast<unsigned>(parameters.nb);
  }
}

/// Acquisitions of the passes of a frame, the last one final.
std::vector<std::uint64_t> passes(const ReadoutParameters& parameters, std::uint64_t acquisitions) {
  std::vector<std::uint64_t> ends;
  const std::uint64_t half = acquisitions / 2;
  switch (parameters.readout) {
    case Readout::kEzPointer:
    case Readout::kHistogram:
    case Readout::kCoarseHistogram:
      break;
    case Readout::kThreeSteps:
      ends = {half / 3, 2 * half / 3, half};
      break;
    case Readout::kPifh: {
      const std::uint64_t runs = u(1) << static_cast<unsigned>(parameters.np - parameters.nb);
      for (std::uint64_t run = 1; run < runs; ++run) {
        ends.push_back(acquisitions * run / runs);
      }
      break;
    }
    default:
      ends = {half};
  }
  ends.push_back(acquisitions);
  for (std::size_t pass = ends.size() - 1; pass > 0; --pass) {
    ends[pass] -= ends[pass - 1];
  }
  return ends;
}

std::uint64_t array_clocks(const ReadoutParameters& parameters, std::uint64_t rows, int columns,
                           std::uint32_t acquisitions, bool signalled_clear) {
  const std::uint64_t bins = memory_bins(parameters);
  const bool pointer_only = parameters.readout == Readout::kEzPointer;
  std::uint64_t clocks = kIdle + (signalled_clear && !pointer_only ? 1 : rows * bins + kClearEnd);
  const std::vector<std::uint64_t> parts = passes(parameters, acquisitions);
  for (const std::uint64_t part : parts) {
    constexpr std::uint64_t kPassEnd = 5;
    const std::uint64_t slots = u(parameters.slots);
    clocks += part * rows * slots + kPassEnd + (part > 0 ? slots : 0);
  }
  clocks += (parts.size() - 1) * (rows * bins + kScanEnd + 1);
  // M4 and M5: the scan of a pixel goes on while the results of the one before are sent.
  constexpr std::int64_t kPointerScan = 6;
  constexpr std::int64_t kScanLatency = 5;
  constexpr std::int64_t kInterpolation = 4;  // and a clock for each bit of the quotient
  constexpr std::int64_t kFirstResult = 6;
  constexpr std::int64_t kAfterResults = 5;
  // FiFH's last histogram is as fine as the rest of the code; what is cleared and scanned before has the bins
  // of the larger.
  const std::uint64_t last_bins = parameters.readout == Readout::kFifh
                                      ? u(1) << static_cast<unsigned>(parameters.np - parameters.nb)
                                      : bins;
  const bool interpolates = parameters.readout == Readout::kCoarseHistogram;
  const std::int64_t scan =
      is_pointer_readout(parameters.readout)
          ? kPointerScan
          : static_cast<std::int64_t>(last_bins) + kScanLatency +
                (interpolates ? kInterpolation + parameters.np - parameters.nb + parameters.fraction_bits
                              : 0);
  const std::int64_t sending = kFirstResult + sending_clocks(columns);
  return clocks + u(scan) + (rows - 1) * u(std::max(scan - sending, kAfterResults)) + rows * u(sending);
}

std::uint64_t pool_clocks(const ReadoutParameters& parameters, int rows, int columns,
                          std::uint32_t acquisitions) {
  const PoolPointerParameters& pool = parameters.pool;
  const std::uint64_t steps = u(std::min(columns, pool.engine_columns));
  const std::uint64_t pairs = (steps + 1) / 2;
  const std::uint64_t groups = u((rows + pool.group_size - 1) / pool.group_size);
  const std::uint64_t labels = u(pool.labels);
  // A coarse bin's word takes two accesses.
  const bool wide = pool.bin_halves(parameters.count_width) == 2;
  const std::uint64_t together = wide ? 8 : 4;
  const std::uint64_t counted = (u(rows) + together - 1) / together * together;
  constexpr std::uint64_t kOperationEnd = 2;
  std::uint64_t clocks = kIdle + groups * u(pool.group_size) + kClearEnd;
  const PoolSchedule schedule(acquisitions, pool);
  for (const std::uint64_t part :
       {schedule.coarse_end, schedule.track_end - schedule.coarse_end, acquisitions - schedule.track_end}) {
    const std::uint64_t slots = u(parameters.slots);
    clocks += part * counted * slots + (part > 0 ? 7 + slots / 2 * 2 : 3) + (wide ? 7 : 0);
  }
  const std::uint64_t significance =
      pool.significance_bits() > 0 ? 3 : 0;  // the last one is known so much later
  clocks += pairs * groups * (32 * labels + 45 + significance) + kOperationEnd;
  const std::uint64_t choose =
      2 * u(rows) + (pool.rival_moves ? 9 : 8) + (pool.prior ? (rows % 2 != 0 ? 2 : 1) : 0);
  clocks += steps * choose * std::max<std::uint64_t>(labels + 5, 9) + kOperationEnd;
  return clocks + u(pool_decide_clocks(rows, columns, pool.engine_columns)) + kOperationEnd;
}

}  // namespace

std::int64_t sending_clocks(int columns) {
  constexpr std::int64_t kPlaces = 5;
  constexpr std::int64_t kPlaceClocks = 7;
  const std::int64_t last = columns - 1;
  return last / kPlaces * kPlaceClocks + last % kPlaces;
}

std::int64_t pool_decide_clocks(int rows, int columns, int engine_columns) {
  return Decide(rows, columns, engine_columns).clocks();
}

std::uint64_t predicted_frame_clocks(const ReadoutParameters& parameters, int rows, int columns,
                                     std::uint32_t acquisitions, bool signalled_clear) {
  return is_pool_readout(parameters.readout)
             ? pool_clocks(parameters, rows, columns, acquisitions)
             : array_clocks(parameters, u(rows), columns, acquisitions, signalled_clear);
}

FrameFit frame_fit(const ReadoutParameters& parameters, int rows, int columns, std::uint32_t acquisitions,
                   const FrameBudget& budget) {
  const auto most = static_cast<std::uint64_t>(budget.clock_hz / budget.frames_per_s);
  const auto clocks = [&](int of_rows, std::uint32_t of_acquisitions, int slots) {
    ReadoutParameters other = parameters;
    other.slots = slots;
    return predicted_frame_clocks(other, of_rows, columns, of_acquisitions);
  };
  FrameFit fit{.fits = false, .clocks = clocks(rows, acquisitions, parameters.slots), .sentence = {}};
  fit.fits = fit.clocks <= most;
  const double mhz = budget.clock_hz * 1e-6;
  fit.sentence = fmt::format(
      "{}: a frame of {} acquisitions takes {} clocks, {:.2f} ms at {:g} MHz; {:g} frames/s leave {}",
      readout_title(parameters.readout), acquisitions, fit.clocks,
      static_cast<double>(fit.clocks) / budget.clock_hz * 1e3, mhz, budget.frames_per_s, most);
  if (fit.fits) {
    fit.sentence += ", so that the frame fits.";
    return fit;
  }
  std::vector<std::string> ways;
  if (clocks(rows, 0, parameters.slots) <= most) {
    std::uint32_t fitting = 0;
    for (std::uint32_t high = acquisitions; high - fitting > 1;) {
      const std::uint32_t middle = fitting + (high - fitting) / 2;
      (clocks(rows, middle, parameters.slots) <= most ? fitting : high) = middle;
    }
    ways.push_back(fmt::format("{} acquisitions", fitting));
  }
  ways.push_back(fmt::format("{:.1f} MHz",
                             std::ceil(static_cast<double>(fit.clocks) * budget.frames_per_s * 1e-5) / 10));
  ways.push_back(fmt::format("{:.2f} frames/s",
                             std::floor(budget.clock_hz / static_cast<double>(fit.clocks) * 100) / 100));
  const int fewest_slots = is_pool_readout(parameters.readout) ? 2 : 1;
  for (int slots = parameters.slots - 1; slots >= fewest_slots; --slots) {
    if (clocks(rows, acquisitions, slots) <= most) {
      ways.push_back(fmt::format("SLOTS = {}", slots));
      break;
    }
  }
  if (is_pool_readout(parameters.readout)) {
    ReadoutParameters other = parameters;
    for (int width = (std::min(parameters.pool.engine_columns, columns + 1) - 1) / 2 * 2; width >= 2;
         width -= 2) {
      other.pool.engine_columns = width;
      if (predicted_frame_clocks(other, rows, columns, acquisitions) <= most) {
        ways.push_back(fmt::format("ENGINE_COLUMNS = {}", width));
        break;
      }
    }
  }
  for (int parts = 2; parts <= rows; ++parts) {
    const int fewer = (rows + parts - 1) / parts;
    if (clocks(fewer, acquisitions, parameters.slots) <= most) {
      ways.push_back(fmt::format("{} arrays of {} rows", parts, fewer));
      break;
    }
  }
  fit.sentence += ", so that the frame does not fit. What would, one of: ";
  for (std::size_t i = 0; i < ways.size(); ++i) {
    fit.sentence += (i > 0 ? ", " : "") + ways[i];
  }
  fit.sentence += ".";
  return fit;
}

}  // namespace dtof
