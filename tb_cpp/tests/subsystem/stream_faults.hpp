// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "dtof.h"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {

inline constexpr std::uint64_t kMostClocksOfAFrame = 100000;
inline constexpr std::uint32_t kAbort = DTOF_CONTROL_ABORT_MASK;
inline constexpr std::uint32_t kAbortAndFlush = DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK;
inline constexpr std::uint32_t kNoWatchdog = 0;

/// A line, and whether the source says that its acquisition ends.
struct Beat {
  Line line;
  bool last;
};

class StreamFaults : public Subsystem {
 protected:
  [[nodiscard]] std::size_t lines_of(std::size_t acquisitions) const {
    return acquisitions * bench_.acquisition_lines();
  }

  [[nodiscard]] FrameSettings everything_counts(std::uint32_t acquisitions) const {
    return {.acquisitions = acquisitions,
            .gate = {0, bench_.configuration().parameters.no_detection()},
            .weak_below = 1,
            .enabled = std::vector<bool>(static_cast<std::size_t>(bench_.configuration().sram_num), true),
            .second_target = false,
            .raw = false,
            .smooth = true,
            .prior = false};
  }

  [[nodiscard]] std::vector<Beat> beats_of(const std::vector<Line>& lines) const {
    std::vector<Beat> beats;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      beats.push_back({lines[i], (i + 1) % bench_.acquisition_lines() == 0});
    }
    return beats;
  }

  void push(const std::vector<Beat>& beats) {
    for (const Beat& beat : beats) {
      bench_.source().push(beat.line, beat.last);
    }
  }

  bool busy() { return (bench_.get(DTOF_STATUS) & DTOF_STATUS_BUSY_MASK) != 0; }

  void wait_until_idle() {
    std::uint64_t clocks = 0;
    while (busy() || !bench_.sink().idle()) {
      bench_.clock();
      ASSERT_LT(++clocks, kMostClocksOfAFrame) << "the frame does not end";
    }
  }

  /// Writes `command` to CONTROL, which must end the frame.
  void abort(std::uint32_t command) {
    bench_.set(DTOF_CONTROL, command);
    priors_.clear();  // an abort deletes the prior, as a reset does
    bench_.clocks(kClocksOfAnAbort);
    ASSERT_FALSE(busy()) << "an abort does not end the frame";
  }

  /// Compares ERROR and WARNING with the events at the ports and with `own`. Clears both afterwards.
  void expect_registers(std::uint32_t own = 0) {
    const SubsystemEvents& events = bench_.events();
    const bool misframed = events.short_acquisition || events.long_acquisition;
    EXPECT_EQ(bench_.get(DTOF_ERROR), own | (events.underrun ? DTOF_ERROR_UNDERRUN_MASK : 0U) |
                                          (events.overrun ? DTOF_ERROR_OVERRUN_MASK : 0U) |
                                          (misframed ? DTOF_ERROR_MISFRAMED_MASK : 0U) |
                                          (events.timeout ? DTOF_ERROR_TIMEOUT_MASK : 0U) |
                                          (events.stalled ? DTOF_ERROR_STALLED_MASK : 0U));
    EXPECT_EQ(bench_.get(DTOF_WARNING), (events.short_acquisition ? DTOF_WARNING_SHORT_MASK : 0U) |
                                            (events.long_acquisition ? DTOF_WARNING_LONG_MASK : 0U) |
                                            (events.aborted ? DTOF_WARNING_ABORTED_MASK : 0U));
    const std::uint64_t lost_lines = bench_.get(DTOF_LOST_LINES);
    EXPECT_LE(lost_lines, bench_.reference().lost_lines());
    EXPECT_GE(lost_lines + bench_.reference().doubtful_lines(), bench_.reference().lost_lines());
    EXPECT_EQ(bench_.get(DTOF_LOST_ACQUISITIONS), bench_.reference().lost_acquisitions());
    // The checksum is the last whole frame's, whatever was cut off behind it.
    const std::vector<std::vector<std::uint64_t>>& frames = bench_.sink().frames();
    if (bench_.get(DTOF_FRAME_COUNT) > 0) {
      EXPECT_EQ(bench_.get(DTOF_FRAME_CRC), dtof_crc(frames.back().data(), frames.back().size()));
    } else {
      EXPECT_EQ(bench_.get(DTOF_FRAME_CRC), 0U);
    }
    bench_.set(DTOF_ERROR, 0xFFFFFFFF);
    bench_.set(DTOF_WARNING, 0xFFFFFFFF);
    bench_.events() = {};
  }

  /// Compares each whole frame since the last call with the model of the lines that the array took.
  void expect_the_models(const FrameSettings& settings) {
    for (; checked_ < bench_.sink().frames().size(); ++checked_) {
      const ArrayFrame& taken = bench_.frames().at(bench_.sink().numbers()[checked_]);
      ASSERT_EQ(taken.lines.size(), lines_of(settings.acquisitions));
      ASSERT_EQ(received_results(bench_, checked_),
                expected_results(bench_, settings, taken.lines, &priors_));
    }
  }

  /// Reads a frame of undamaged lines. The array must take exactly these lines, without an error.
  void expect_a_good_frame(const FrameSettings& settings, CounterRandom& random) {
    write_settings(bench_, settings);
    bench_.set(DTOF_RELEASE, static_cast<std::uint32_t>(most_release_));
    const std::vector<Line> lines = bright_lines(bench_.configuration(), settings.taken(), random);
    push(beats_of(lines));
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    ASSERT_NO_FATAL_FAILURE(wait_until_idle());
    ASSERT_EQ(bench_.frames().back().lines, settled_lines(bench_, settings, lines));
    const std::size_t before = checked_;
    ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
    ASSERT_EQ(checked_, before + 1);
  }

  std::size_t most_release_ = bench_.get(DTOF_RELEASE);
  std::size_t checked_ = bench_.sink().frames().size();  // frames of the sink that were compared
  std::vector<PoolPrior> priors_;
};

}  // namespace dtof
