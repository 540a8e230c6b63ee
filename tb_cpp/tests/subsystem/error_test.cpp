// SPDX-License-Identifier: Apache-2.0
// What goes wrong at dtof_subsystem: the subsystem reports it, and the next frame is right.
#include <gtest/gtest.h>

#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

class SubsystemErrors : public Subsystem {
 protected:
  // One frame of lines without gaps, compared with the model.
  void expect_a_right_frame(std::uint32_t which) {
    CounterRandom random = this->random(which);
    const std::size_t before = bench_.sink().frames().size();
    bench_.source().gap_probability = 0.0;
    const FrameSettings settings{
        .acquisitions = 7,
        .gate = {0, bench_.configuration().parameters.no_detection()},
        .weak_below = 1,
        .enabled = std::vector<bool>(static_cast<std::size_t>(bench_.configuration().sram_num), true)};
    write_settings(bench_, settings);
    const std::vector<Line> lines = make_lines(bench_.configuration(), settings.acquisitions, random);
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    ASSERT_EQ(received_results(bench_, before), expected_results(bench_, settings, lines));
  }

  // Reads what went wrong since the last time, and forgets it.
  std::uint32_t take_errors() {
    const std::uint32_t errors = bench_.get(DTOF_ERROR);
    bench_.set(DTOF_ERROR, errors);
    EXPECT_EQ(bench_.get(DTOF_ERROR), 0U);
    return errors;
  }
};

INSTANTIATE_TEST_SUITE_P(All, SubsystemErrors, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(SubsystemErrors, AnUnderrunLosesTheRestOfItsAcquisitionAlone) {
  if (bench_.clock_waits()) {
    GTEST_SKIP() << "the array waits";
  }
  CounterRandom random = this->random(5);
  std::uint32_t lost = 0;
  std::uint32_t kept = 0;
  for (std::size_t frame = 0; frame < 20; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    FrameSettings settings{.acquisitions = 12, .gate = {0, 1000}, .weak_below = 1, .enabled = {}};
    settings.gate.end = bench_.configuration().parameters.no_detection();
    write_settings(bench_, settings);
    bench_.set(DTOF_RELEASE, 1 + random() % 3);
    std::vector<Line> lines = make_lines(bench_.configuration(), settings.acquisitions, random);
    for (Line& line : lines) {  // a dark line would look like a missing line
      line.back() = static_cast<Timestamp>(pick(random, bench_.configuration().parameters.code_count() - 1));
    }
    push_lines(bench_, lines);
    bench_.source().gap_probability = 0.8 * random.uniform();
    bench_.events() = {};
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    while (bench_.source().waiting() > 0) {
      bench_.clock();  // of an acquisition that was lost last
    }
    bench_.clocks(10);
    const ArrayFrame& taken = bench_.frames().back();
    ASSERT_EQ(taken.lines.size(), lines.size());
    ASSERT_EQ(received_results(bench_, frame), expected_results(bench_, settings, taken.lines));
    EXPECT_EQ(bench_.get(DTOF_STATUS), 0U) << "nothing of a lost acquisition stays in the buffer";
    EXPECT_EQ(take_errors(), taken.lost > 0 ? DTOF_ERROR_UNDERRUN_MASK : 0U);
    lost += taken.lost;
    kept += settings.acquisitions - taken.lost;
  }
  EXPECT_GT(lost, 10U);
  EXPECT_GT(kept, 10U);
}

TEST_P(SubsystemErrors, AWholeAcquisitionNeverRunsEmpty) {
  CounterRandom random = this->random(6);
  const auto whole = static_cast<std::uint32_t>(bench_.acquisition_lines());
  if (bench_.clock_waits() || bench_.get(DTOF_RELEASE) < whole) {
    GTEST_SKIP() << "the array waits, or the buffer does not hold an acquisition";
  }
  FrameSettings settings{.acquisitions = 10, .gate = {0, 1}, .weak_below = 0, .enabled = {}};
  write_settings(bench_, settings);
  push_lines(bench_, make_lines(bench_.configuration(), settings.acquisitions, random));
  bench_.source().gap_probability = 0.8;
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  bench_.wait_for_frames(1);
  EXPECT_EQ(bench_.frames().back().lost, 0U);
  EXPECT_EQ(take_errors(), 0U);
}

TEST_P(SubsystemErrors, AStartWhileBusyIsIgnoredAndReported) {
  bench_.set(DTOF_IRQ_ENABLE, DTOF_IRQ_ENABLE_ERROR_MASK);
  CounterRandom random = this->random(7);
  FrameSettings settings{.acquisitions = 3, .gate = {0, 0}, .weak_below = 0, .enabled = {}};
  write_settings(bench_, settings);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  EXPECT_FALSE(bench_.interrupt());
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  bench_.clocks(2);
  EXPECT_TRUE(bench_.interrupt());
  EXPECT_EQ(bench_.get(DTOF_STATUS) & DTOF_STATUS_BUSY_MASK, DTOF_STATUS_BUSY_MASK);
  EXPECT_EQ(take_errors(), DTOF_ERROR_START_IGNORED_MASK);
  EXPECT_TRUE(bench_.interrupt());
  bench_.set(DTOF_IRQ_STATUS, DTOF_IRQ_STATUS_ERROR_MASK);
  bench_.clocks(2);
  EXPECT_FALSE(bench_.interrupt());
  push_lines(bench_, make_lines(bench_.configuration(), settings.acquisitions, random));
  bench_.wait_for_frames(1);
  bench_.clocks(1000);
  EXPECT_EQ(bench_.frames().size(), 1U);
  expect_a_right_frame(8);
}

// The frames behind it have the settings of the last commit: a frame of five acquisitions would not end with
// these lines.
TEST_P(SubsystemErrors, AnIgnoredStartCommitsNothing) {
  if (!bench_.source_waits()) {
    GTEST_SKIP() << "acquisitions may be dropped";
  }
  CounterRandom random = this->random(17);
  bench_.source().gap_probability = 0.0;
  FrameSettings settings{.acquisitions = 3, .gate = {0, 0}, .weak_below = 0, .enabled = {}};
  write_settings(bench_, settings);
  const std::uint32_t again = DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK;
  bench_.set(DTOF_CONTROL, again);
  bench_.set(DTOF_ACQUISITIONS, 5);
  bench_.set(DTOF_CONTROL, again);
  EXPECT_EQ(take_errors(), DTOF_ERROR_START_IGNORED_MASK);
  push_lines(bench_, make_lines(bench_.configuration(), 2 * settings.acquisitions, random));
  bench_.wait_for_frames(2);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK | DTOF_CONTROL_START_MASK);
  bench_.clocks(1000);
  EXPECT_EQ(bench_.get(DTOF_STATUS) & DTOF_STATUS_BUSY_MASK, 0U);
  EXPECT_EQ(take_errors(), DTOF_ERROR_START_IGNORED_MASK);
  EXPECT_EQ(bench_.frames().size(), 3U);
  expect_a_right_frame(18);
}

TEST_P(SubsystemErrors, AnIllegalScheduleBeginsNoFrame) {
  const std::uint32_t most = bench_.get(DTOF_RELEASE);
  for (const std::uint32_t release : {0U, most + 1, 0xFFFFU}) {
    SCOPED_TRACE(testing::Message() << "RELEASE " << release);
    bench_.set(DTOF_RELEASE, release);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
    bench_.clocks(20);
    EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
    EXPECT_EQ(bench_.get(DTOF_CONTROL), 0U) << "continuous mode ended";
    EXPECT_EQ(take_errors(), DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
  }
  bench_.set(DTOF_RELEASE, most);
  const bool pool = is_pool_readout(bench_.configuration().parameters.readout);
  for (const auto& [coarse, track, all] : {std::array{5U, 4U, 10U}, std::array{2U, 11U, 10U}}) {
    if (pool) {
      bench_.set(DTOF_COARSE_END, coarse);
      bench_.set(DTOF_TRACK_END, track);
      bench_.set(DTOF_ACQUISITIONS, all);
      bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
      bench_.clocks(20);
      EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
      EXPECT_EQ(take_errors(), DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
    }
  }
  const auto rows = static_cast<std::uint32_t>(bench_.configuration().pixels_per_sram);
  for (const auto& [first, last] : {std::array{1U, 0U}, std::array{0U, rows}, std::array{rows, rows}}) {
    if (bench_.configuration().raw_histogram) {
      bench_.set(DTOF_OUTPUT, DTOF_OUTPUT_RAW_MASK);
      bench_.set(DTOF_RAW_ROWS, first << DTOF_RAW_ROWS_FIRST_LSB | last << DTOF_RAW_ROWS_LAST_LSB);
      bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
      bench_.clocks(20);
      EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
      EXPECT_EQ(take_errors(), DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
    }
  }
  EXPECT_EQ(bench_.frames().size(), 0U);
  expect_a_right_frame(9);
}

TEST_P(SubsystemErrors, ContinuousModeEndsWithAnIllegalSchedule) {
  const std::uint32_t most = bench_.get(DTOF_RELEASE);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);  // no acquisitions
  bench_.set(DTOF_RELEASE, 0);
  bench_.clocks(5000);
  EXPECT_EQ(bench_.get(DTOF_ERROR), 0U) << "what is not committed is without effect";
  bench_.set(DTOF_COMMIT, DTOF_COMMIT_SETTINGS_MASK);
  bench_.clocks(5000);
  EXPECT_GE(bench_.frames().size(), 1U);
  EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
  EXPECT_EQ(bench_.get(DTOF_CONTROL), 0U);
  EXPECT_EQ(take_errors(), DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
  bench_.set(DTOF_RELEASE, most);
  expect_a_right_frame(10);
}

TEST_P(SubsystemErrors, BitsAreClearedOneByOne) {
  const std::uint32_t most = bench_.get(DTOF_RELEASE);
  CounterRandom random = this->random(16);
  bench_.source().push(make_lines(bench_.configuration(), 1, random)[0], true);
  bench_.set(DTOF_RELEASE, 0);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  bench_.clocks(20);
  constexpr std::uint32_t kBoth = DTOF_ERROR_MISFRAMED_MASK | DTOF_ERROR_ILLEGAL_SCHEDULE_MASK;
  EXPECT_EQ(bench_.get(DTOF_ERROR), kBoth);
  EXPECT_FALSE(bench_.write(DTOF_ERROR, kBoth, 0).error);
  bench_.set(DTOF_ERROR, ~kBoth);
  EXPECT_EQ(bench_.get(DTOF_ERROR), kBoth) << "neither was written as 1";
  bench_.set(DTOF_ERROR, DTOF_ERROR_MISFRAMED_MASK);
  EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
  bench_.set(DTOF_ERROR, DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
  EXPECT_EQ(bench_.get(DTOF_ERROR), 0U);

  bench_.set(DTOF_RELEASE, most);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_FLUSH_MASK);
  expect_a_right_frame(17);
}

TEST_P(SubsystemErrors, InterruptsAreClearedOneByOne) {
  constexpr std::uint32_t kBoth = DTOF_IRQ_STATUS_FRAME_MASK | DTOF_IRQ_STATUS_ERROR_MASK;
  for (const std::uint32_t first : {DTOF_IRQ_STATUS_FRAME_MASK, DTOF_IRQ_STATUS_ERROR_MASK}) {
    SCOPED_TRACE(testing::Message() << "first " << first);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);  // a frame of no acquisitions
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    bench_.clocks(2);
    EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS), kBoth);
    EXPECT_FALSE(bench_.write(DTOF_IRQ_STATUS, kBoth, 0).error);
    EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS), kBoth) << "no byte was written";
    bench_.set(DTOF_IRQ_STATUS, first);
    EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS), kBoth & ~first);
    bench_.set(DTOF_IRQ_STATUS, kBoth & ~first);
    EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS), 0U);
  }
}

TEST_P(SubsystemErrors, AnOverrunIsReported) {
  CounterRandom random = this->random(11);
  FrameSettings settings{.acquisitions = 2, .gate = {0, 0}, .weak_below = 0, .enabled = {}};
  settings.gate.end = bench_.configuration().parameters.no_detection();
  write_settings(bench_, settings);
  const std::vector<Line> lines = make_lines(bench_.configuration(), 14, random);
  push_lines(bench_, lines);
  bench_.sink().blocked = true;
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
  bench_.clocks(20000);
  EXPECT_TRUE(bench_.events().overrun);
  EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_OVERRUN_MASK);
  bench_.sink().blocked = false;
  bench_.wait_for_frames(7);
  for (std::size_t frame = 0; frame < 7; ++frame) {
    const auto first = lines.begin() + static_cast<std::ptrdiff_t>(frame * lines.size() / 7);
    const std::vector<Line> own(first, first + static_cast<std::ptrdiff_t>(lines.size() / 7));
    ASSERT_EQ(received_results(bench_, frame), expected_results(bench_, settings, own))
        << "nothing is lost where the source can wait";
  }
}

TEST_P(SubsystemErrors, AMisframedSourceIsReportedAndFlushed) {
  CounterRandom random = this->random(12);
  const std::vector<Line> lines = make_lines(bench_.configuration(), 1, random);
  bench_.source().push(lines[0], true);
  bench_.source().push(lines[1], false);
  bench_.clocks(20);
  EXPECT_TRUE(bench_.events().short_acquisition);
  EXPECT_EQ(take_errors(), DTOF_ERROR_MISFRAMED_MASK);
  EXPECT_EQ(bench_.get(DTOF_STATUS), 2U << DTOF_STATUS_LEVEL_LSB);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_FLUSH_MASK);
  EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
  expect_a_right_frame(13);
  EXPECT_EQ(take_errors() & ~DTOF_ERROR_OVERRUN_MASK, 0U);
}

TEST_P(SubsystemErrors, AMissingLastLineIsReported) {
  CounterRandom random = this->random(15);
  FrameSettings settings{.acquisitions = 1, .gate = {0, 0}, .weak_below = 0, .enabled = {}};
  settings.gate.end = bench_.configuration().parameters.no_detection();
  write_settings(bench_, settings);
  const std::vector<Line> lines = make_lines(bench_.configuration(), 1, random);
  for (const Line& line : lines) {
    bench_.source().push(line, false);
  }
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  bench_.wait_for_frames(1);
  EXPECT_EQ(received_results(bench_, 0), expected_results(bench_, settings, lines));
  EXPECT_EQ(take_errors(), DTOF_ERROR_MISFRAMED_MASK);
}

TEST_P(SubsystemErrors, AFlushDuringAFrameIsIgnoredAndReported) {
  CounterRandom random = this->random(14);
  FrameSettings settings{.acquisitions = 3, .gate = {0, 0}, .weak_below = 0, .enabled = {}};
  write_settings(bench_, settings);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  const std::vector<Line> lines = make_lines(bench_.configuration(), settings.acquisitions, random);
  push_lines(bench_, lines);
  bench_.clocks(3);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_FLUSH_MASK);
  bench_.wait_for_frames(1);
  EXPECT_EQ(bench_.frames().back().lines, lines);
  EXPECT_EQ(take_errors(), DTOF_ERROR_FLUSH_IGNORED_MASK);
}

}  // namespace
}  // namespace dtof
