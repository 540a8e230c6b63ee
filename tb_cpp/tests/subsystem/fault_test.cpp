// SPDX-License-Identifier: Apache-2.0
// Faults of the stream of lines, of the sink and of the software: a frame ends whatever happens, registers
// say what happened, and the next good frame is right without a reset. The bench follows each clock
// (StreamReference).
#include <gtest/gtest.h>

#include "dtof.h"
#include "tests/subsystem/stream_faults.hpp"

namespace dtof {
namespace {

INSTANTIATE_TEST_SUITE_P(All, StreamFaults, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(StreamFaults, ALostLineDamagesItsAcquisitionAlone) {
  CounterRandom random = this->random(30);
  const std::vector<Line> lines = bright_lines(bench_.configuration(), 5, random);
  std::vector<Beat> beats = beats_of(lines);
  beats.erase(beats.begin() + static_cast<std::ptrdiff_t>(lines_of(1)));  // the second acquisition's first
  const FrameSettings settings = everything_counts(5);
  write_settings(bench_, settings);
  push(beats);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  ASSERT_NO_FATAL_FAILURE(wait_until_idle());
  const std::vector<Line>& taken = bench_.frames().back().lines;
  ASSERT_EQ(taken.size(), lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t acquisition = i / bench_.acquisition_lines();
    if (acquisition != 1) {
      ASSERT_EQ(taken[i], lines[i]);
    } else if (i + 1 < lines_of(2)) {
      ASSERT_EQ(taken[i], lines[i + 1]);
    } else {
      ASSERT_EQ(taken[i], dark_lines(bench_.configuration(), 1)[0]);
    }
  }
  EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_MISFRAMED_MASK);
  EXPECT_EQ(bench_.get(DTOF_WARNING), DTOF_WARNING_SHORT_MASK);
  EXPECT_EQ(bench_.get(DTOF_LOST_LINES), 0U);
  EXPECT_EQ(bench_.get(DTOF_LOST_ACQUISITIONS), 1U);
  ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
  expect_registers();
  ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(4), random));
  expect_registers();
}

TEST_P(StreamFaults, LinesThatAreTooManyAreThrownAway) {
  CounterRandom random = this->random(31);
  const std::vector<Line> lines = bright_lines(bench_.configuration(), 4, random);
  std::vector<Beat> beats = beats_of(lines);
  beats[lines_of(1) - 1].last = false;
  beats.insert(beats.begin() + static_cast<std::ptrdiff_t>(lines_of(1)),
               {Beat{lines[2], false}, Beat{lines[0], true}});
  const FrameSettings settings = everything_counts(4);
  write_settings(bench_, settings);
  push(beats);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  ASSERT_NO_FATAL_FAILURE(wait_until_idle());
  EXPECT_EQ(bench_.frames().back().lines, lines);
  EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_MISFRAMED_MASK);
  EXPECT_EQ(bench_.get(DTOF_WARNING), DTOF_WARNING_LONG_MASK);
  EXPECT_EQ(bench_.get(DTOF_LOST_LINES), 2U);
  EXPECT_EQ(bench_.get(DTOF_LOST_ACQUISITIONS), 0U);
  ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
}

TEST_P(StreamFaults, TheWatchdogEndsTheFrameOfADeadSource) {
  constexpr std::uint32_t kClocks = 200;
  CounterRandom random = this->random(32);
  for (const std::size_t more : {std::size_t{0}, std::size_t{1}, bench_.acquisition_lines() - 1}) {
    SCOPED_TRACE(testing::Message() << more << " lines of the third acquisition");
    const std::uint32_t lines_before = bench_.get(DTOF_LOST_LINES);
    const std::uint32_t acquisitions_before = bench_.get(DTOF_LOST_ACQUISITIONS);
    const FrameSettings settings = everything_counts(6);
    write_settings(bench_, settings);
    bench_.set(DTOF_RELEASE, static_cast<std::uint32_t>(most_release_));
    std::vector<Line> lines = bright_lines(bench_.configuration(), 3, random);
    lines.resize(lines_of(2) + more);
    push(beats_of(lines));
    bench_.set(DTOF_WATCHDOG, kNoWatchdog);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.clocks(5000);
    EXPECT_TRUE(busy()) << "without a watchdog a frame waits";
    EXPECT_FALSE(bench_.events().timeout);
    bench_.set(DTOF_WATCHDOG, kClocks);
    bench_.clocks(kClocks - 10);
    EXPECT_FALSE(bench_.events().timeout);
    ASSERT_NO_FATAL_FAILURE(wait_until_idle());
    EXPECT_EQ(bench_.get(DTOF_ERROR) & DTOF_ERROR_TIMEOUT_MASK, DTOF_ERROR_TIMEOUT_MASK);
    ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
    if (most_release_ == bench_.acquisition_lines()) {
      // The array has taken what came of the third acquisition, or has not begun it.
      const std::size_t taken = bench_.clock_waits() ? more : 0;
      lines.resize(lines_of(2) + taken);
      const Line dark = dark_lines(bench_.configuration(), 1)[0];
      lines.insert(lines.end(), lines_of(4) - taken, dark);
      EXPECT_EQ(bench_.frames().back().lines, lines) << "what did not come, or never began, is dark";
      EXPECT_EQ(bench_.get(DTOF_LOST_LINES), lines_before + more - taken);
      EXPECT_EQ(bench_.get(DTOF_LOST_ACQUISITIONS), acquisitions_before + 4);
    }
    expect_registers();
    // The source goes on where it was; what is left of its acquisition belongs to none.
    std::vector<Line> rest = bright_lines(bench_.configuration(), 1, random);
    rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(more));
    if (more > 0) {
      for (std::size_t i = 0; i < rest.size(); ++i) {
        bench_.source().push(rest[i], i + 1 == rest.size());
      }
    }
    ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(3), random));
    expect_registers();
  }
}

TEST_P(StreamFaults, ASourceWithoutTlastIsTimedOut) {
  CounterRandom random = this->random(33);
  const FrameSettings settings = everything_counts(3);
  write_settings(bench_, settings);
  bench_.set(DTOF_WATCHDOG, 300);
  std::vector<Beat> beats = beats_of(bright_lines(bench_.configuration(), 400, random));
  for (Beat& beat : beats) {
    beat.last = false;
  }
  push(beats);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  ASSERT_NO_FATAL_FAILURE(wait_until_idle());
  EXPECT_TRUE(bench_.events().timeout);
  ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
  bench_.source().reset();
  expect_registers();
  ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
  ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(3), random));
  expect_registers();
}

TEST_P(StreamFaults, ASinkThatStopsIsReportedAndAborted) {
  CounterRandom random = this->random(34);
  for (const bool at_once : {false, true}) {
    SCOPED_TRACE(testing::Message() << "sink stops " << (at_once ? "at once" : "in mid frame"));
    const FrameSettings settings = everything_counts(3);
    write_settings(bench_, settings);
    bench_.set(DTOF_WATCHDOG, 100);
    push(beats_of(bright_lines(bench_.configuration(), 3, random)));
    bench_.sink().blocked = at_once;
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    while (bench_.sink().current().size() < 3 && !at_once) {
      bench_.clock();
    }
    bench_.sink().blocked = true;
    bench_.clocks(8000);
    EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_STALLED_MASK) << "a sink that waits is no dead source";
    const std::uint32_t frames = bench_.get(DTOF_FRAME_COUNT);
    const std::size_t aborted = bench_.sink().aborted();
    ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
    EXPECT_TRUE(at_once || !bench_.sink().idle()) << "a word that was offered stays";
    bench_.sink().blocked = false;
    ASSERT_NO_FATAL_FAILURE(wait_until_idle());
    EXPECT_EQ(bench_.sink().aborted(), aborted + 1) << "the packet ends";
    EXPECT_EQ(bench_.get(DTOF_FRAME_COUNT), frames) << "a frame that was aborted is none";
    expect_registers();
    ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(2), random));
    expect_registers();
  }
}

TEST_P(StreamFaults, AnAbortEndsAFrameInAnyClock) {
  CounterRandom random = this->random(35);
  std::size_t cut = 0;
  std::size_t ended = 0;
  // From the start of a frame to its last word.
  std::uint64_t frame_clocks = 0;
  write_settings(bench_, everything_counts(2));
  push(beats_of(bright_lines(bench_.configuration(), 2, random)));
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  for (; bench_.sink().frames().empty(); ++frame_clocks) {
    bench_.clock();
  }
  for (std::uint64_t round = 0; round < 100; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    FrameSettings settings = everything_counts(2);
    settings.second_target = pick(random, 2) == 0;
    settings.prior = pick(random, 2) == 0;
    settings.short_words = pick(random, 2) == 0;
    settings.amplitude = pick(random, 2) == 0;
    write_settings(bench_, settings);
    push(beats_of(bright_lines(bench_.configuration(), 4, random)));
    bench_.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.5;
    const bool continuous = pick(random, 2) == 0;
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | (continuous ? DTOF_CONTROL_CONTINUOUS_MASK : 0U));
    if (round % 4 == 0) {  // while results leave
      while (bench_.sink().current().empty()) {
        bench_.clock();
      }
      bench_.clocks(random() % 3);
    } else {
      bench_.clocks(random() % (frame_clocks + 10));
    }
    bench_.sink().blocked = pick(random, 3) == 0;
    bench_.clocks(random() % 4);
    const std::size_t aborted = bench_.sink().aborted();
    bench_.source().dead = true;
    ASSERT_NO_FATAL_FAILURE(abort(kAbort));
    bench_.source().reset();
    bench_.source().dead = false;
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_FLUSH_MASK);
    bench_.sink().blocked = false;
    bench_.clocks(1 + random() % 3);
    // A frame's words that wait go on, and so does the next frame.
    checked_ = bench_.sink().frames().size();
    ASSERT_NO_FATAL_FAILURE(wait_until_idle());
    cut += bench_.sink().aborted() - aborted;
    checked_ = bench_.sink().frames().size();
    ended += bench_.events().aborted ? 1 : 0;
    expect_registers();
    settings.acquisitions = 3;
    ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(settings, random));
    expect_registers();
  }
  EXPECT_GT(cut, 2U);
  EXPECT_GT(ended, 20U);
}

TEST_P(StreamFaults, AFrameBehindAnAbortHasItsWholeWatchdog) {
  CounterRandom random = this->random(40);
  const FrameSettings settings = everything_counts(2);
  write_settings(bench_, settings);
  bench_.set(DTOF_WATCHDOG, kNoWatchdog);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  bench_.clocks(2000);  // the array waits
  ASSERT_NO_FATAL_FAILURE(abort(kAbort));
  bench_.set(DTOF_WATCHDOG, 60);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);  // the reference follows each clock
  ASSERT_NO_FATAL_FAILURE(wait_until_idle());
  EXPECT_TRUE(bench_.events().timeout);
  ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
  expect_registers();
  ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(2), random));
}

TEST_P(StreamFaults, AnAbortAfterTheArraysFrameIsToldIfWordsAreLost) {
  CounterRandom random = this->random(41);
  const RtlConfiguration& configuration = bench_.configuration();
  const auto words = static_cast<std::size_t>(configuration.pixels_per_sram * configuration.sram_num);
  for (const std::size_t left : {2U, 1U}) {
    SCOPED_TRACE(testing::Message() << left << " words are left");
    write_settings(bench_, everything_counts(2));
    push(beats_of(bright_lines(configuration, 2, random)));
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    while (bench_.sink().current().size() + left < words) {
      bench_.clock();
    }
    bench_.sink().blocked = true;
    bench_.clocks(5000);
    ASSERT_EQ(bench_.get(DTOF_STATUS) & DTOF_STATUS_BUSY_MASK, 0U);
    ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
    EXPECT_EQ(bench_.get(DTOF_WARNING) & DTOF_WARNING_ABORTED_MASK,
              left == 1 ? 0U : DTOF_WARNING_ABORTED_MASK);
    bench_.sink().blocked = false;
    ASSERT_NO_FATAL_FAILURE(wait_until_idle());
    EXPECT_EQ(bench_.sink().aborted(), 1U);
    checked_ = bench_.sink().frames().size();
    priors_.clear();
    expect_registers();
  }
}

TEST_P(StreamFaults, AnAbortDropsTheNextFrameBehindALastWordThatWaits) {
  CounterRandom random = this->random(39);
  const RtlConfiguration& configuration = bench_.configuration();
  const auto words = static_cast<std::size_t>(configuration.pixels_per_sram * configuration.sram_num);
  const FrameSettings settings = everything_counts(2);
  write_settings(bench_, settings);
  push(beats_of(bright_lines(bench_.configuration(), 8, random)));
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
  while (bench_.sink().current().size() + 1 < words) {
    bench_.clock();
  }
  bench_.sink().blocked = true;
  bench_.clocks(5000);
  ASSERT_EQ(bench_.frames().size(), 2U) << "the next frame waits for the last word of this one";
  bench_.source().reset();
  ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
  bench_.sink().blocked = false;
  bench_.clocks(200);  // the sink refuses what is not expected
  EXPECT_TRUE(bench_.sink().idle());
  EXPECT_EQ(bench_.sink().aborted(), 0U);
  ASSERT_EQ(bench_.sink().frames().size(), 1U);
  ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
  priors_.clear();
  ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(2), random));
  expect_registers();
}

TEST_P(StreamFaults, AStartWithAnAbortIsIgnored) {
  CounterRandom random = this->random(36);
  write_settings(bench_, everything_counts(2));
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  ASSERT_NO_FATAL_FAILURE(abort(kAbort | DTOF_CONTROL_START_MASK));
  expect_registers(DTOF_ERROR_START_IGNORED_MASK);
  ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(2), random));
}

TEST_P(StreamFaults, ASourceInAnotherResetDomainIsFoundAtItsNextAcquisition) {
  CounterRandom random = this->random(37);
  const std::vector<Line> lines = bright_lines(bench_.configuration(), 8, random);
  push(beats_of(lines));
  // Two acquisitions fit before the buffer refuses, or a part of one.
  bench_.clocks(bench_.acquisition_lines() / 2 + 1);
  const std::size_t gone = lines.size() - bench_.source().waiting();
  ASSERT_GT(gone, 0U);
  bench_.reset(false);
  ASSERT_EQ(bench_.source().waiting(), lines.size() - gone) << "no line is taken in reset";
  const FrameSettings settings = everything_counts(4);
  write_settings(bench_, settings);
  bench_.set(DTOF_WATCHDOG, 1000);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  ASSERT_NO_FATAL_FAILURE(wait_until_idle());
  ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
  // The acquisition that was cut by the reset is the frame's first; the next three are whole.
  const std::vector<Line>& taken = bench_.frames().back().lines;
  const bool cut = gone % bench_.acquisition_lines() != 0;
  const std::size_t next = lines_of(gone / bench_.acquisition_lines() + (cut ? 1 : 0));
  for (std::size_t i = 0; i < lines_of(3); ++i) {
    ASSERT_EQ(taken[lines_of(cut ? 1 : 0) + i], lines[next + i]);
  }
  bench_.clocks(100);
  bench_.source().reset();
  expect_registers();
  ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
  ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(everything_counts(2), random));
}

TEST_P(StreamFaults, SettingsBecomeValidTogether) {
  CounterRandom random = this->random(38);
  // Each of these is legal, and mixtures of them are not, where there is a schedule or a raw frame.
  FrameSettings few = everything_counts(5);
  FrameSettings many = everything_counts(12);
  few.settle = 1;
  many.settle = 3;
  few.raw_first = bench_.configuration().pixels_per_sram - 1;
  few.raw_last = few.raw_first;
  few.raw = many.raw = bench_.configuration().raw_histogram;
  write_settings(bench_, few);
  bench_.source().gap_probability = 0.0;
  const std::vector<Line> lines = bright_lines(bench_.configuration(), 2000, random);
  push(beats_of(lines));
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
  const FrameSettings* valid = &few;
  std::size_t changes = 0;
  std::size_t unchanged = 0;
  std::size_t first = 0;  // frame that began behind the last commit
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const FrameSettings& next = valid == &few ? many : few;
    const FrameSettings before = *valid;
    write_settings(bench_, next);  // the other way round in every second round
    bench_.wait_for_frames(2 + random() % 2);
    // No frame has seen any of that up to here.
    for (std::size_t i = 0; i < bench_.sink().frames().size(); ++i) {
      const std::size_t number = bench_.sink().numbers()[i];
      if (number >= first) {
        ASSERT_EQ(bench_.frames().at(number).lines.size(), lines_of(before.acquisitions))
            << "frame " << number;
        ++unchanged;
      }
    }
    bench_.set(DTOF_COMMIT, DTOF_COMMIT_SETTINGS_MASK);
    const std::size_t begun = bench_.frames().size();
    first = begun;
    bench_.wait_for_frames(1);
    while (bench_.frames().size() < begun + 2) {
      bench_.clock();
    }
    // A frame that began behind the commit.
    while (bench_.sink().numbers().empty() || bench_.sink().numbers().back() < begun) {
      bench_.clock();
    }
    const ArrayFrame& taken = bench_.frames().at(bench_.sink().numbers().back());
    ASSERT_EQ(taken.lines.size(), lines_of(next.acquisitions));
    ASSERT_EQ(received_results(bench_, bench_.sink().frames().size() - 1),
              expected_results(bench_, next, taken.lines));
    checked_ = bench_.sink().frames().size();
    valid = &next;
    ++changes;
  }
  EXPECT_EQ(bench_.get(DTOF_ERROR) & ~DTOF_ERROR_OVERRUN_MASK, 0U) << "no frame was illegal";
  EXPECT_EQ(changes, 12U);
  EXPECT_GT(unchanged, 12U);
  EXPECT_EQ(bench_.get(DTOF_CONTROL), DTOF_CONTROL_CONTINUOUS_MASK);
}

}  // namespace
}  // namespace dtof
