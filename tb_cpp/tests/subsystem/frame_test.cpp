// SPDX-License-Identifier: Apache-2.0
// Frames of dtof_subsystem against the C++ models, with gaps and back-pressure anywhere.
#include <gtest/gtest.h>

#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

class SubsystemFrames : public Subsystem {};

INSTANTIATE_TEST_SUITE_P(All, SubsystemFrames, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

FrameSettings random_settings(const RtlConfiguration& configuration, CounterRandom& random) {
  const int codes = configuration.parameters.code_count();
  FrameSettings settings{.acquisitions = static_cast<std::uint32_t>(pick(random, 24)),
                         .gate = {pick(random, codes), pick(random, codes)},
                         .weak_below = static_cast<std::uint32_t>(pick(random, 6)),
                         .enabled = {},
                         .second_target = pick(random, 2) == 0,
                         .raw = pick(random, 2) == 0,
                         .smooth = pick(random, 2) == 0,
                         .prior = pick(random, 4) != 0,
                         .short_words = pick(random, 2) == 0,
                         .amplitude = pick(random, 2) == 0};
  settings.raw_first = pick(random, configuration.pixels_per_sram);
  settings.raw_last = settings.raw_first + pick(random, configuration.pixels_per_sram - settings.raw_first);
  if (pick(random, 3) == 0) {
    settings.gate = {0, codes - 1};
  }
  settings.settle = pick(random, 2) == 0 ? 0 : static_cast<std::uint32_t>(pick(random, 6));
  for (int column = 0; column < configuration.sram_num; ++column) {
    settings.enabled.push_back(pick(random, 4) != 0);
  }
  return settings;
}

TEST_P(SubsystemFrames, AreTheModelsUnderGapsAndBackPressure) {
  CounterRandom random = this->random(2);
  const bool whole = bench_.get(DTOF_RELEASE) == bench_.acquisition_lines();
  std::vector<PoolPrior> priors;
  for (std::size_t frame = 0; frame < 30; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    FrameSettings settings = random_settings(bench_.configuration(), random);
    settings.coarse_template = pick(random, 2) == 0 ? random_template(random) : PoolTemplate{};
    write_template(bench_, settings.coarse_template);
    // An acquisition that is not whole in the buffer must come without gaps (error_test.cpp has the others).
    bench_.source().gap_probability = whole ? 0.9 * random.uniform() : 0.0;
    bench_.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    write_settings(bench_, settings);
    const std::vector<Line> all = make_lines(bench_.configuration(), settings.taken(), random);
    const std::vector<Line> lines = settled_lines(bench_, settings, all);
    push_lines(bench_, all);
    bench_.clocks(random() % 20);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    // Settings are the frame's from here on, and what is not sampled cannot be written.
    write_settings(bench_, random_settings(bench_.configuration(), random));
    if (is_pool_readout(bench_.configuration().parameters.readout)) {
      const bool refused =
          bench_.write(DTOF_TEMPLATE + 4 * static_cast<std::uint32_t>(pick(random, 8)), random()).error;
      EXPECT_TRUE(refused || (bench_.get(DTOF_STATUS) & DTOF_STATUS_BUSY_MASK) == 0) << "in the frame";
    }
    bench_.wait_for_frames(1);
    EXPECT_EQ(bench_.frames().back().lines, lines);
    ASSERT_EQ(received_results(bench_, frame), expected_results(bench_, settings, lines, &priors));
    EXPECT_EQ(bench_.get(DTOF_FRAME_COUNT), frame + 1);
    EXPECT_EQ(bench_.get(DTOF_FRAME_CYCLES), bench_.frames().back().cycles);
    EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
    EXPECT_EQ(bench_.get(DTOF_ERROR), bench_.events().overrun ? DTOF_ERROR_OVERRUN_MASK : 0U);
    EXPECT_EQ(bench_.get(DTOF_WARNING), 0U) << "no counter of these read-outs is full so soon";
  }
}

TEST_P(SubsystemFrames, FollowEachOtherInContinuousMode) {
  CounterRandom random = this->random(3);
  constexpr std::size_t kFrames = 6;
  FrameSettings settings = random_settings(bench_.configuration(), random);
  settings.acquisitions = 5;
  settings.settle = 2;
  write_settings(bench_, settings);
  const std::vector<Line> lines =
      make_lines(bench_.configuration(), static_cast<std::uint32_t>(kFrames) * settings.taken(), random);
  push_lines(bench_, lines);
  bench_.sink().stall_probability = 0.3;
  bench_.set(DTOF_IRQ_ENABLE, DTOF_IRQ_ENABLE_FRAME_MASK);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
  const std::size_t frame_lines = lines.size() / kFrames;
  std::vector<PoolPrior> priors;
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    EXPECT_FALSE(bench_.interrupt());
    bench_.wait_for_frames(1);
    EXPECT_TRUE(bench_.interrupt()) << "from the clock behind the last result on";
    bench_.set(DTOF_IRQ_STATUS, DTOF_IRQ_STATUS_FRAME_MASK);
    const auto first = lines.begin() + static_cast<std::ptrdiff_t>(frame * frame_lines);
    const std::vector<Line> own =
        settled_lines(bench_, settings, {first, first + static_cast<std::ptrdiff_t>(frame_lines)});
    EXPECT_EQ(bench_.frames().at(frame).lines, own);
    ASSERT_EQ(received_results(bench_, frame), expected_results(bench_, settings, own, &priors));
    if (frame + 2 == kFrames) {
      bench_.set(DTOF_CONTROL, 0);
    }
  }
  bench_.clocks(1000);
  EXPECT_EQ(bench_.frames().size(), kFrames)
      << "the frame that was under way when the mode ended is the last";
  EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
  EXPECT_EQ(bench_.get(DTOF_FRAME_COUNT), kFrames);
}

// A frame with SETTLE and a frame of the same lines without the first acquisitions have the same words; the
// next frame drops its own, and one without SETTLE none.
TEST_P(SubsystemFrames, WithSettleAreThoseOfAStreamWithoutItsFirstAcquisitions) {
  CounterRandom random = this->random(6);
  FrameSettings settings = random_settings(bench_.configuration(), random);
  settings.acquisitions = 7;
  settings.prior = false;
  std::size_t frame = 0;
  for (const std::uint32_t settle : {3U, 3U, 0U, 1U, 20U}) {
    SCOPED_TRACE(testing::Message() << "SETTLE " << settle << ", frame " << frame);
    settings.settle = settle;
    const std::vector<Line> all = make_lines(bench_.configuration(), settings.taken(), random);
    const std::vector<Line> lines = settled_lines(bench_, settings, all);
    ASSERT_EQ(lines.size() / bench_.acquisition_lines(), 7U);
    write_settings(bench_, settings);
    push_lines(bench_, all);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    ASSERT_EQ(bench_.frames().back().lines, lines);
    ASSERT_EQ(received_results(bench_, frame++), expected_results(bench_, settings, lines));
    settings.settle = 0;
    write_settings(bench_, settings);
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    ASSERT_EQ(received_results(bench_, frame), received_results(bench_, frame - 1));
    ++frame;
  }
  EXPECT_EQ(bench_.source().waiting(), 0U);
  EXPECT_EQ(bench_.get(DTOF_LOST_LINES), 0U) << "what is dropped on purpose is not lost";
  EXPECT_EQ(bench_.get(DTOF_LOST_ACQUISITIONS), 0U);
  // A frame without acquisitions takes none.
  settings.acquisitions = 0;
  settings.settle = 4;
  write_settings(bench_, settings);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  bench_.wait_for_frames(1);
  EXPECT_TRUE(bench_.frames().back().lines.empty());
}

// Software chooses histograms or results while a frame sends the other ones.
TEST_P(SubsystemFrames, AreHistogramsOrResultsAsAWhole) {
  const RtlConfiguration& configuration = bench_.configuration();
  if (!configuration.raw_histogram) {
    GTEST_SKIP() << "the subsystem sends no histograms";
  }
  CounterRandom random = this->random(7);
  FrameSettings settings{
      .acquisitions = 1, .gate = {0, configuration.parameters.no_detection()}, .enabled = {}};
  settings.raw_last = configuration.pixels_per_sram - 1;
  write_settings(bench_, settings);
  constexpr std::size_t kFrames = 40;
  const std::vector<Line> lines = make_lines(configuration, 2 * kFrames, random);
  run_with_changing_output(bench_, DTOF_OUTPUT_RAW_MASK, lines, kFrames, random);
  int changes = 0;
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    const std::vector<ResultFields> received = received_results(bench_, frame);
    ASSERT_FALSE(received.empty());
    changes += received.front().raw != settings.raw ? 1 : 0;
    settings.raw = received.front().raw;
    ASSERT_EQ(received, expected_results(bench_, settings, bench_.frames().at(frame).lines));
  }
  EXPECT_GT(changes, 5);
}

constexpr std::uint32_t kAcquisitionsThatFillACounter = 4200;  // more than a bin counts, in each pass

// One pixel of the first column sees a detection at the same code in each acquisition, the others see none.
std::vector<Line> lines_that_fill_a_counter(const RtlConfiguration& configuration) {
  std::vector<Line> lines = dark_lines(configuration, kAcquisitionsThatFillACounter);
  const auto acquisition_lines =
      static_cast<std::size_t>(configuration.pixels_per_sram * configuration.parameters.slots);
  for (std::size_t i = 0; i < lines.size(); i += acquisition_lines) {
    lines[i].front() = static_cast<Timestamp>(configuration.parameters.code_count() / 3);
  }
  return lines;
}

// It counts detections in histograms of pixels.
bool has_counters(const ReadoutParameters& parameters) {
  return has_histogram(parameters.readout) && !is_pool_readout(parameters.readout);
}

TEST_P(SubsystemFrames, ReportWhichCountersAreFull) {
  const RtlConfiguration& configuration = bench_.configuration();
  const ReadoutParameters& parameters = configuration.parameters;
  constexpr std::uint32_t kAcquisitions = kAcquisitionsThatFillACounter;
  const std::vector<Line> lines = lines_that_fill_a_counter(configuration);
  FrameSettings settings{
      .acquisitions = kAcquisitions, .gate = {0, parameters.no_detection()}, .enabled = {}};
  settings.raw_last = configuration.pixels_per_sram - 1;
  const bool has_counter = !is_pool_readout(parameters.readout);
  std::size_t frame = 0;
  for (const bool raw : {false, true}) {
    settings.raw = raw;
    write_settings(bench_, settings);
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    const std::vector<ResultFields> received = received_results(bench_, frame++);
    ASSERT_EQ(received, expected_results(bench_, settings, lines));
    EXPECT_EQ(std::ranges::count_if(received, &ResultFields::saturated), has_counter ? 1 : 0);
    const std::uint32_t warning = has_counters(parameters) ? DTOF_WARNING_COUNTER_FULL_MASK : 0U;
    EXPECT_EQ(bench_.get(DTOF_WARNING), warning) << "a full confidence of a pointer is no warning";
    bench_.set(DTOF_WARNING, ~DTOF_WARNING_COUNTER_FULL_MASK);
    EXPECT_EQ(bench_.get(DTOF_WARNING), warning) << "it was not written as 1";
    EXPECT_FALSE(bench_.write(DTOF_WARNING, DTOF_WARNING_COUNTER_FULL_MASK, 0).error);
    EXPECT_EQ(bench_.get(DTOF_WARNING), warning) << "no byte was written";
    EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS), DTOF_IRQ_STATUS_FRAME_MASK) << "a warning is no error";
    bench_.set(DTOF_WARNING, DTOF_WARNING_COUNTER_FULL_MASK);
    EXPECT_EQ(bench_.get(DTOF_WARNING), 0U);
  }
}

// Acquisitions of a frame whose first pass can fill a counter: three steps take a sixth of them for their
// first one.
std::uint32_t acquisitions_to_fill_a_counter(const ReadoutParameters& parameters) {
  return 6 * ((1U << static_cast<unsigned>(parameters.count_width)) - 1);
}

// One pixel of the last column sees a detection in each of the first acquisitions, all of which are in the
// first pass.
std::vector<Line> lines_with_detections(const RtlConfiguration& configuration, std::size_t detections) {
  std::vector<Line> lines =
      dark_lines(configuration, acquisitions_to_fill_a_counter(configuration.parameters));
  const auto acquisition_lines =
      static_cast<std::size_t>(configuration.pixels_per_sram * configuration.parameters.slots);
  for (std::size_t i = 0; i < detections; ++i) {
    lines[i * acquisition_lines].back() = 0;
  }
  return lines;
}

// No result shows a counter that is full in the first of several passes.
TEST_P(SubsystemFrames, ReportFullCountersOfAnyPass) {
  const RtlConfiguration& configuration = bench_.configuration();
  const ReadoutParameters& parameters = configuration.parameters;
  const std::uint32_t acquisitions = acquisitions_to_fill_a_counter(parameters);
  const std::size_t most = acquisitions / 6;
  const FrameSettings settings{
      .acquisitions = acquisitions, .gate = {0, parameters.no_detection()}, .enabled = {}};
  std::size_t frame = 0;
  for (const std::size_t detections : {most - 1, most}) {
    SCOPED_TRACE(testing::Message() << detections << " detections");
    const std::vector<Line> lines = lines_with_detections(configuration, detections);
    write_settings(bench_, settings);
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    ASSERT_EQ(received_results(bench_, frame++), expected_results(bench_, settings, lines));
    const bool full = has_counters(parameters) && detections == most;
    EXPECT_EQ(bench_.get(DTOF_WARNING), full ? DTOF_WARNING_COUNTER_FULL_MASK : 0U);
  }
}

TEST_P(SubsystemFrames, AWarningIsNotLostInTheClockInWhichItIsCleared) {
  const RtlConfiguration& configuration = bench_.configuration();
  const ReadoutParameters& parameters = configuration.parameters;
  if (!has_counters(parameters) || bench_.axi_lite()) {
    GTEST_SKIP() << "no such warning, or a bus whose clocks are random";
  }
  const std::uint32_t acquisitions = acquisitions_to_fill_a_counter(parameters);
  const std::size_t most = acquisitions / 6;
  write_settings(bench_,
                 {.acquisitions = acquisitions, .gate = {0, parameters.no_detection()}, .enabled = {}});
  const std::vector<Line> lines = lines_with_detections(configuration, most);
  // The warning, read so many clocks behind the start, and then again if `clear` instead writes it.
  const auto warning_at = [&](std::uint64_t clocks, bool clear) {
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.clocks(clocks);
    if (clear) {
      bench_.set(DTOF_WARNING, DTOF_WARNING_COUNTER_FULL_MASK);
      bench_.clocks(4);
    }
    const std::uint32_t warning = bench_.get(DTOF_WARNING);
    bench_.wait_for_frames(1);
    bench_.set(DTOF_WARNING, DTOF_WARNING_COUNTER_FULL_MASK);
    return warning;
  };
  std::uint64_t before = 0;
  std::uint64_t behind = lines.size() / 3;  // twice the acquisitions that fill the counter
  ASSERT_EQ(warning_at(before, false), 0U);
  ASSERT_EQ(warning_at(behind, false), DTOF_WARNING_COUNTER_FULL_MASK);
  while (behind - before > 1) {
    const std::uint64_t middle = (before + behind) / 2;
    (warning_at(middle, false) == 0 ? before : behind) = middle;
  }
  // A read samples in its setup, and sees the register from the clock behind the event on. A write takes
  // effect in its access, a clock later than its setup; in the clock of the event it is too early.
  EXPECT_EQ(warning_at(behind - 1, true), 0U);
  EXPECT_EQ(warning_at(behind - 2, true), DTOF_WARNING_COUNTER_FULL_MASK);
  EXPECT_EQ(warning_at(behind - 3, true), DTOF_WARNING_COUNTER_FULL_MASK);
}

TEST_P(SubsystemFrames, AreWholeBehindAResetAtAnyTime) {
  CounterRandom random = this->random(4);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    FrameSettings settings = random_settings(bench_.configuration(), random);
    write_settings(bench_, settings);
    push_lines(bench_, make_lines(bench_.configuration(), settings.taken(), random));
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.clocks(random() % 400);
    bench_.reset();
    const std::size_t before = bench_.sink().frames().size();
    settings.enabled.clear();
    write_settings(bench_, settings);
    const std::vector<Line> all = make_lines(bench_.configuration(), settings.taken(), random);
    const std::vector<Line> lines = settled_lines(bench_, settings, all);
    push_lines(bench_, all);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    ASSERT_EQ(received_results(bench_, before), expected_results(bench_, settings, lines));
    EXPECT_EQ(bench_.get(DTOF_FRAME_COUNT), 1U);
  }
}

}  // namespace
}  // namespace dtof
