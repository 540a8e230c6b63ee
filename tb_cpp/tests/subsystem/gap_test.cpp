// SPDX-License-Identifier: Apache-2.0
// Lines that are late inside acquisitions, and sources that cannot wait. A gap changes no result, whatever
// its length and place; an acquisition for which there is no room is dropped whole and counted, and the frame
// goes on. The bench follows each clock (StreamReference).
#include <gtest/gtest.h>

#include <cstdlib>

#include "dtof.h"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kMostClocksWithGaps = 200000;
constexpr std::uint32_t kAbort = DTOF_CONTROL_ABORT_MASK;

// Rounds of the random tests: the environment variable DTOF_GAP_ROUNDS, else as many as take seconds.
std::uint32_t gap_rounds() {
  const char* text = std::getenv("DTOF_GAP_ROUNDS");
  return text == nullptr ? 300 : static_cast<std::uint32_t>(std::stoul(text));
}

class Gaps : public Subsystem {
 protected:
  void SetUp() override {}  // those whose source cannot wait, too: it is slower than the array here

  FrameSettings any_settings(std::uint32_t acquisitions, CounterRandom& random) {
    const RtlConfiguration& configuration = bench_.configuration();
    FrameSettings settings{
        .acquisitions = acquisitions,
        .gate = {0, configuration.parameters.no_detection()},
        .weak_below = 1,
        .enabled = std::vector<bool>(static_cast<std::size_t>(configuration.sram_num), true)};
    settings.second_target = pick(random, 2) == 0;
    settings.raw = pick(random, 4) == 0;
    settings.raw_last = pick(random, configuration.pixels_per_sram);
    settings.prior = pick(random, 2) == 0;
    settings.amplitude = pick(random, 2) == 0;
    return settings;
  }

  void expect_counters() {
    EXPECT_EQ(bench_.get(DTOF_LOST_LINES), bench_.reference().lost_lines());
    EXPECT_EQ(bench_.get(DTOF_LOST_ACQUISITIONS), bench_.reference().lost_acquisitions());
  }

  std::vector<PoolPrior> priors_;
};

INSTANTIATE_TEST_SUITE_P(All, Gaps, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

// Every line of a frame is late by its own random number of clocks, in every round with another spread.
TEST_P(Gaps, ChangeNoResult) {
  if (!bench_.clock_waits()) {
    GTEST_SKIP() << "its acquisitions are buffered";
  }
  std::uint64_t rests = 0;
  for (std::uint32_t round = 0; round < gap_rounds(); ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    CounterRandom random = this->random(2000 + round);
    const FrameSettings settings = any_settings(static_cast<std::uint32_t>(pick(random, 7)), random);
    write_settings(bench_, settings);
    bench_.set(DTOF_RELEASE, 1 + random() % static_cast<std::uint32_t>(bench_.acquisition_lines()));
    bench_.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    const std::uint32_t longest = 1U << static_cast<std::uint32_t>(pick(random, 7));
    const std::vector<Line> lines = bright_lines(bench_.configuration(), settings.acquisitions, random);
    const std::size_t before = bench_.sink().frames().size();
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    std::size_t pushed = 0;
    std::uint32_t late = random() % longest;
    for (std::uint64_t clocks = 0; bench_.sink().frames().size() == before; ++clocks) {
      ASSERT_LT(clocks, kMostClocksWithGaps) << "the frame does not end";
      // A source that cannot wait begins when the array waits for an acquisition.
      const bool held = !bench_.source_waits() && pushed % bench_.acquisition_lines() == 0 &&
                        (bench_.reference().inside() || !bench_.reference().starved());
      if (pushed < lines.size() && bench_.source().waiting() == 0 && !held && late-- == 0) {
        bench_.source().push(lines[pushed], (pushed + 1) % bench_.acquisition_lines() == 0);
        ++pushed;
        late = random() % longest;
      }
      bench_.clock();
    }
    ASSERT_EQ(bench_.frames().back().lines, lines);
    ASSERT_EQ(received_results(bench_, before), expected_results(bench_, settings, lines, &priors_));
    rests = bench_.rests();
  }
  EXPECT_EQ(bench_.get(DTOF_ERROR) & ~DTOF_ERROR_OVERRUN_MASK, 0U);
  EXPECT_EQ(bench_.dropped(), 0U);
  expect_counters();
  EXPECT_GT(rests, gap_rounds()) << "the array's clock has hardly ever rested";
}

// The same lines with and without gaps: the frame is longer by the clocks in which the array's clock rested,
// at most by those and the raster between acquisitions.
TEST_P(Gaps, CostTheirOwnClocksAlone) {
  if (!bench_.clock_waits() || !bench_.source_waits()) {
    GTEST_SKIP();
  }
  CounterRandom random = this->random(60);
  FrameSettings settings = any_settings(6, random);
  settings.raw = false;
  settings.prior = false;
  write_settings(bench_, settings);
  const std::vector<Line> lines = bright_lines(bench_.configuration(), settings.acquisitions, random);
  std::uint64_t quick = 0;
  std::vector<ResultFields> results;
  for (const bool gaps : {false, true}) {
    // The gap is behind an acquisition's first line, up to the next multiple of the raster.
    const auto slots = static_cast<std::uint64_t>(bench_.configuration().parameters.slots);
    const std::uint64_t gap = 40 * slots;
    const std::uint64_t rests = bench_.rests();
    const std::size_t before = bench_.sink().frames().size();
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    std::size_t pushed = 0;
    std::uint64_t wait = 0;
    for (std::uint64_t clocks = 0; bench_.sink().frames().size() == before; ++clocks) {
      ASSERT_LT(clocks, kMostClocksWithGaps) << "the frame does not end";
      for (; wait == 0 && pushed < lines.size() && bench_.source().waiting() < 2; ++pushed) {
        bench_.source().push(lines[pushed], (pushed + 1) % bench_.acquisition_lines() == 0);
        if (gaps && pushed % bench_.acquisition_lines() == 0) {
          wait = gap;
          ++pushed;
          break;
        }
      }
      wait -= wait > 0 && bench_.reference().inside() ? 1 : 0;
      bench_.clock();
    }
    const std::uint64_t cycles = bench_.frames().back().cycles;
    if (!gaps) {
      quick = cycles;
      results = received_results(bench_, before);
      EXPECT_EQ(bench_.rests(), rests) << "no line was late";
    } else {
      const std::uint64_t rested = bench_.rests() - rests;
      EXPECT_GE(rested, settings.acquisitions * (gap - 8));
      EXPECT_LE(cycles, quick + rested + settings.acquisitions * slots);
      EXPECT_EQ(received_results(bench_, before), results);
    }
  }
}

// An abort and a watchdog end a frame while the array's clock rests, in any line of an acquisition.
TEST_P(Gaps, EndWithAnAbortOrATimeout) {
  if (!bench_.clock_waits()) {
    GTEST_SKIP() << "its acquisitions are buffered";
  }
  CounterRandom random = this->random(61);
  for (std::size_t line = 1; line < bench_.acquisition_lines(); ++line) {
    for (const bool aborts : {false, true}) {
      SCOPED_TRACE(testing::Message() << "behind line " << line << (aborts ? ", abort" : ", timeout"));
      FrameSettings settings = any_settings(2, random);
      settings.raw = false;
      settings.prior = false;
      write_settings(bench_, settings);
      bench_.set(DTOF_WATCHDOG, aborts ? 0 : 150);
      bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
      while (!bench_.reference().starved()) {
        bench_.clock();
      }
      const std::vector<Line> lines = bright_lines(bench_.configuration(), 1, random);
      for (std::size_t i = 0; i < line; ++i) {
        bench_.source().push(lines[i], false);
      }
      const std::uint64_t rests = bench_.rests();
      bench_.clocks(40 + line);
      EXPECT_GT(bench_.rests(), rests + 20) << "the array's clock does not rest";
      const std::size_t frames = bench_.sink().frames().size();
      if (aborts) {
        bench_.set(DTOF_CONTROL, kAbort | DTOF_CONTROL_FLUSH_MASK);
        bench_.clocks(16);
        EXPECT_EQ(bench_.get(DTOF_STATUS) & DTOF_STATUS_BUSY_MASK, 0U);
        EXPECT_EQ(bench_.get(DTOF_WARNING), DTOF_WARNING_ABORTED_MASK);
      } else {
        bench_.wait_for_frames(1);
        EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_TIMEOUT_MASK);
        std::vector<Line> taken(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(line));
        taken.resize(2 * bench_.acquisition_lines(), dark_lines(bench_.configuration(), 1)[0]);
        EXPECT_EQ(bench_.frames().back().lines, taken);
        EXPECT_EQ(received_results(bench_, frames), expected_results(bench_, settings, taken));
        bench_.set(DTOF_CONTROL, DTOF_CONTROL_FLUSH_MASK);
      }
      bench_.set(DTOF_ERROR, 0xFFFFFFFF);
      bench_.set(DTOF_WARNING, 0xFFFFFFFF);
      bench_.events() = {};
      expect_counters();
    }
  }
}

class DroppedAcquisitions : public Gaps {
 protected:
  void SetUp() override {
    if (bench_.source_waits()) {
      GTEST_SKIP() << "its source waits";
    }
  }

  // What the array took are whole acquisitions of the source, in its order.
  void expect_whole_acquisitions(const std::vector<Line>& taken, const std::vector<Line>& source,
                                 std::size_t* next) {
    const std::size_t lines = bench_.acquisition_lines();
    for (std::size_t i = 0; i < taken.size(); i += lines) {
      const auto first = taken.begin() + static_cast<std::ptrdiff_t>(i);
      while (*next + lines <= source.size() &&
             !std::equal(first, first + static_cast<std::ptrdiff_t>(lines),
                         source.begin() + static_cast<std::ptrdiff_t>(*next))) {
        *next += lines;
      }
      ASSERT_LE(*next + lines, source.size()) << "acquisition " << i / lines << " is none of the source's";
      *next += lines;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(All, DroppedAcquisitions, testing::ValuesIn(compiled_subsystems()),
                         subsystem_test_name);

// A source that runs freely, at any pace up to a line a clock, through passes, waiting sinks, pauses between
// frames, aborts and timeouts: frames end, of whole acquisitions, and every line is accounted for.
TEST_P(DroppedAcquisitions, AreWholeAndCounted) {
  std::uint64_t frames = 0;
  std::uint64_t aborted = 0;
  for (std::uint32_t round = 0; round < gap_rounds(); ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    CounterRandom random = this->random(3000 + round);
    FrameSettings settings = any_settings(static_cast<std::uint32_t>(1 + pick(random, 6)), random);
    write_settings(bench_, settings);
    bench_.source().gap_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    bench_.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    constexpr std::uint32_t kAcquisitions = 400;
    const std::vector<Line> lines = bright_lines(bench_.configuration(), kAcquisitions, random);
    push_lines(bench_, lines);
    bench_.clocks(random() % 40);
    const bool continuous = pick(random, 3) == 0;
    const bool aborts = pick(random, 4) == 0;
    const std::size_t before = bench_.sink().frames().size();
    const std::size_t first = bench_.frames().size();
    bench_.set(DTOF_WATCHDOG, 400);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | (continuous ? DTOF_CONTROL_CONTINUOUS_MASK : 0U));
    if (aborts) {
      bench_.clocks(random() % 1500);
      bench_.set(DTOF_CONTROL, kAbort);
      bench_.clocks(16);
      priors_.clear();
      ++aborted;
    } else {
      if (continuous) {
        bench_.clocks(random() % 2000);
        bench_.set(DTOF_CONTROL, 0);
      }
      std::uint64_t clocks = 0;
      while ((bench_.get(DTOF_STATUS) & DTOF_STATUS_BUSY_MASK) != 0 || !bench_.sink().idle()) {
        bench_.clock();
        ASSERT_LT(++clocks, kMostClocksWithGaps) << "the frame does not end";
      }
    }
    std::size_t next = 0;
    for (std::size_t i = before; i < bench_.sink().frames().size() && !aborts; ++i) {
      const std::size_t number = bench_.sink().numbers()[i];
      ASSERT_GE(number, first);
      const ArrayFrame& taken = bench_.frames().at(number);
      ASSERT_EQ(taken.lines.size(), settings.acquisitions * bench_.acquisition_lines());
      if (!bench_.events().timeout && taken.lost == 0) {
        ASSERT_NO_FATAL_FAILURE(expect_whole_acquisitions(taken.lines, lines, &next));
      }
      ASSERT_EQ(received_results(bench_, i), expected_results(bench_, settings, taken.lines, &priors_));
      ++frames;
    }
    // The source stops, and begins anew.
    bench_.source().reset();
    bench_.sink().stall_probability = 0.0;
    for (std::uint64_t clocks = 0; !bench_.sink().idle(); ++clocks) {
      bench_.clock();
      ASSERT_LT(clocks, kMostClocksWithGaps) << "the sink waits for words";
    }
    bench_.clocks(2 * bench_.acquisition_lines() + 20);
    expect_counters();
    EXPECT_EQ((bench_.get(DTOF_ERROR) & DTOF_ERROR_OVERRUN_MASK) != 0, bench_.events().overrun);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK);
    bench_.clocks(16);
    priors_.clear();
    bench_.set(DTOF_ERROR, 0xFFFFFFFF);
    bench_.set(DTOF_WARNING, 0xFFFFFFFF);
    bench_.events() = {};
  }
  EXPECT_GT(bench_.dropped(), gap_rounds());
  if (gap_rounds() >= 300) {
    EXPECT_GT(frames, 200U);
    EXPECT_GT(aborted, 30U);
  }
}

}  // namespace
}  // namespace dtof
