// SPDX-License-Identifier: Apache-2.0
// Frames of short words (OUTPUT.SHORT_WORDS): the same results as in words of 64 bits, in half the beats. The
// frames of the other tests have either kind, too.
#include <gtest/gtest.h>

#include "dtof.h"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kAcquisitions = 4;

class ShortWords : public Subsystem {
 protected:
  [[nodiscard]] FrameSettings everything_counts(std::uint32_t acquisitions = kAcquisitions) const {
    return {.acquisitions = acquisitions,
            .gate = {0, bench_.configuration().parameters.no_detection()},
            .weak_below = 2,
            .enabled = std::vector<bool>(static_cast<std::size_t>(bench_.configuration().sram_num), true),
            .short_words = true};
  }

  void start(const FrameSettings& settings, const std::vector<Line>& lines) {
    write_settings(bench_, settings);
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  }

  // Runs a frame, and returns its words of 64 bits.
  const std::vector<std::uint64_t>& run(const FrameSettings& settings, const std::vector<Line>& lines) {
    start(settings, lines);
    bench_.wait_for_frames(1);
    EXPECT_EQ(received_results(bench_, bench_.sink().frames().size() - 1),
              expected_results(bench_, settings, lines));
    const std::vector<std::uint64_t>& words = bench_.sink().frames().back();
    EXPECT_EQ(bench_.get(DTOF_FRAME_CRC), dtof_crc(words.data(), words.size()));
    return words;
  }
};

INSTANTIATE_TEST_SUITE_P(All, ShortWords, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

// The short word of a word of 64 bits, from the places of their fields in registers.toml.
std::uint32_t shortened(std::uint64_t word) {
  const auto bit = [&](std::uint64_t mask, std::uint32_t short_mask) {
    return (word & mask) != 0 ? short_mask : 0U;
  };
  const std::uint64_t confidence = (word & DTOF_RESULT_CONFIDENCE_MASK) >> DTOF_RESULT_CONFIDENCE_LSB;
  return static_cast<std::uint32_t>(word & 0xFFFFU) |
         static_cast<std::uint32_t>(std::min<std::uint64_t>(confidence, 511)) << 16U |
         bit(DTOF_RESULT_VALID_MASK, 1U << 25U) | bit(DTOF_RESULT_WEAK_MASK, 1U << 26U) |
         bit(DTOF_RESULT_EMPTY_MASK, 1U << 27U) | bit(DTOF_RESULT_MASKED_MASK, 1U << 28U) |
         bit(DTOF_RESULT_SATURATED_MASK, 1U << 29U) | bit(DTOF_RESULT_SECOND_MASK, 1U << 30U) |
         bit(DTOF_RESULT_ABORTED_MASK, 1U << 31U);
}

TEST_P(ShortWords, AreTheWordsOfTheSameFrameInHalfTheBeats) {
  CounterRandom random = this->random(60);
  for (const bool second : {false, true}) {
    FrameSettings settings = everything_counts();
    settings.second_target = second;
    settings.enabled[random() % settings.enabled.size()] = false;
    const std::vector<Line> lines = make_lines(bench_.configuration(), kAcquisitions, random);
    settings.short_words = false;
    const std::vector<std::uint64_t> words = run(settings, lines);
    const std::uint32_t cycles = bench_.get(DTOF_FRAME_CYCLES);
    settings.short_words = true;
    std::vector<std::uint64_t> beats = run(settings, lines);
    EXPECT_EQ(bench_.get(DTOF_FRAME_CYCLES), cycles) << "short words cost no clock";
    ASSERT_EQ(beats.size(), (words.size() + 1) / 2);
    for (std::size_t i = 0; i < words.size(); ++i) {
      EXPECT_EQ(static_cast<std::uint32_t>(beats[i / 2] >> (32 * (i % 2))), shortened(words[i]))
          << "word " << i;
      EXPECT_NE(shortened(words[i]) >> 25U & 15U, 0U) << "0 is no result";
    }
    if (words.size() % 2 != 0) {
      EXPECT_EQ(beats.back() >> 32U, 0U) << "the padding";
    }
  }
}

TEST_P(ShortWords, ClipTheConfidence) {
  const RtlConfiguration& configuration = bench_.configuration();
  const ReadoutParameters& parameters = configuration.parameters;
  FrameSettings settings = everything_counts();
  settings.weak_below = 0;
  const bool counts = has_histogram(parameters.readout) && !is_pool_readout(parameters.readout) &&
                      !is_pointer_readout(parameters.readout);
  bool clipped = false;
  bool at_the_limit = false;
  for (const std::uint32_t acquisitions : {510U, 511U, 512U, 700U, 1020U, 1100U, 2100U, 3000U, 4200U}) {
    if (acquisitions > 512 && !counts) {
      break;  // no confidence of these read-outs has ten bits
    }
    SCOPED_TRACE(testing::Message() << acquisitions << " acquisitions");
    settings.acquisitions = acquisitions;
    std::vector<Line> lines = dark_lines(configuration, acquisitions);
    for (std::size_t i = 0; i < lines.size(); i += bench_.acquisition_lines()) {
      lines[i].front() = static_cast<Timestamp>(parameters.code_count() / 3);
    }
    settings.short_words = false;
    const ResultFields whole = fields_of(run(settings, lines).front());
    settings.short_words = true;
    const ResultFields clip = fields_of_short(static_cast<std::uint32_t>(run(settings, lines).front()));
    EXPECT_EQ(clip.confidence, std::min(whole.confidence, 511));
    EXPECT_EQ(clip.saturated, whole.saturated) << "about the counter";
    clipped = clipped || (whole.confidence > 511 && !whole.saturated);
    at_the_limit = at_the_limit || whole.confidence == 511 || whole.confidence == 512;
  }
  EXPECT_EQ(clipped, counts);
  EXPECT_TRUE(at_the_limit || parameters.readout != Readout::kHistogram) << "one pass takes all acquisitions";
}

TEST_P(ShortWords, KeepTheKindOfTheirFrameInContinuousMode) {
  CounterRandom random = this->random(61);
  FrameSettings settings = everything_counts(1);
  settings.short_words = false;
  write_settings(bench_, settings);
  constexpr std::size_t kFrames = 60;
  const std::vector<Line> lines = make_lines(bench_.configuration(), 2 * kFrames, random);
  run_with_changing_output(bench_, DTOF_OUTPUT_SHORT_WORDS_MASK, lines, kFrames, random);
  std::size_t changes = 0;
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    settings.short_words = bench_.sink().short_words()[frame];
    changes += frame > 0 && settings.short_words != bench_.sink().short_words()[frame - 1] ? 1 : 0;
    ASSERT_EQ(received_results(bench_, frame),
              expected_results(bench_, settings, bench_.frames().at(frame).lines));
  }
  EXPECT_GT(changes, 5U);
}

// The subsystem is never full of words that are not the frame's own; from the first word on, an abort in any
// clock ends the packet.
TEST_P(ShortWords, EndAsAbortedInAnyClock) {
  CounterRandom random = this->random(62);
  FrameSettings settings = everything_counts(1);
  const std::vector<Line> lines = make_lines(bench_.configuration(), 1, random);
  start(settings, lines);
  std::uint64_t first = 0;
  for (; bench_.sink().current().empty() && bench_.sink().frames().empty(); ++first) {
    bench_.clock();
  }
  std::uint64_t end = first;
  for (; bench_.sink().frames().empty(); ++end) {
    bench_.clock();
  }
  first -= std::min<std::uint64_t>(first, 6);
  std::size_t aborted_low = 0;
  std::size_t aborted_high = 0;
  std::size_t whole = 0;
  for (const double stalls : {0.0, 0.5}) {
    for (std::uint64_t clock = first; clock < end + 4; ++clock) {
      SCOPED_TRACE(testing::Message() << "clock " << clock << " of " << first << " to " << end);
      settings.second_target = clock % 3 == 0;
      settings.short_words = true;
      bench_.sink().stall_probability = stalls;
      start(settings, lines);
      bench_.clocks(clock);
      const std::size_t aborted = bench_.sink().aborted();
      const std::size_t frames = bench_.sink().frames().size();
      bench_.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK);
      bench_.source().reset();
      bench_.sink().blocked = clock % 5 == 0;
      bench_.clocks(kClocksOfAnAbort);
      bench_.sink().blocked = false;
      while (!bench_.sink().idle()) {
        bench_.clock();
      }
      bench_.clocks(10);
      ASSERT_LE(bench_.sink().aborted() - aborted + bench_.sink().frames().size() - frames, 1U);
      if (bench_.sink().aborted() > aborted) {
        const std::vector<std::uint64_t>& beats = bench_.sink().aborted_words();
        const bool high = (beats.back() & DTOF_RESULT_ABORTED_MASK) != 0;
        (high ? aborted_high : aborted_low) += 1;
        // What left before is the beginning of the frame.
        std::vector<ResultFields> received = short_results(bench_, beats);
        received.pop_back();
        std::vector<ResultFields> expected = expected_results(bench_, settings, lines);
        ASSERT_LE(received.size(), expected.size());
        expected.resize(received.size());
        ASSERT_EQ(received, expected);
      }
      whole += bench_.sink().frames().size() - frames;
      if (clock % 7 == 0) {
        settings.short_words = clock % 2 == 0;
        bench_.sink().stall_probability = 0.3;
        run(settings, lines);
      }
    }
  }
  const bool several = bench_.configuration().sram_num * bench_.configuration().pixels_per_sram > 4;
  EXPECT_TRUE(aborted_low > 0 || !several);
  EXPECT_TRUE(aborted_high > 0 || !several);
  EXPECT_GT(whole, 0U) << "the last clocks are behind the frame";
}

// The frame's last words wait for the sink, and the next frame has begun, which is of the other kind.
TEST_P(ShortWords, EndAsAbortedInTheirOwnKind) {
  CounterRandom random = this->random(64);
  FrameSettings settings = everything_counts(1);
  for (const bool short_words : {false, true}) {
    SCOPED_TRACE(testing::Message() << (short_words ? "short words" : "words of 64 bits"));
    settings.short_words = short_words;
    write_settings(bench_, settings);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
    bench_.clocks(5);
    const std::size_t begun = bench_.frames().size();
    settings.short_words = !short_words;
    write_settings(bench_, settings);
    bench_.set(DTOF_COMMIT, DTOF_COMMIT_SETTINGS_MASK);
    push_lines(bench_, make_lines(bench_.configuration(), 1, random));
    const std::size_t words = stream_order(bench_).size();
    const std::size_t beats = short_words ? (words + 1) / 2 : words;
    while (bench_.sink().current().size() + 2 < beats) {
      bench_.clock();
    }
    bench_.sink().blocked = true;
    bench_.clocks(10000);
    EXPECT_TRUE(bench_.frames().size() > begun || (short_words && words % 2 == 0))
        << "the next frame has begun";
    const std::size_t aborted = bench_.sink().aborted();
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK);
    bench_.source().reset();
    bench_.clocks(kClocksOfAnAbort);
    bench_.sink().blocked = false;
    bench_.clocks(kClocksOfAnAbort);
    EXPECT_TRUE(bench_.sink().idle());
    EXPECT_EQ(bench_.sink().aborted(), aborted + 1);
  }
}

TEST_P(ShortWords, DoNotChangeARawFrame) {
  if (!bench_.configuration().raw_histogram) {
    GTEST_SKIP() << "the subsystem sends none";
  }
  CounterRandom random = this->random(63);
  FrameSettings settings = everything_counts();
  const std::vector<Line> lines = make_lines(bench_.configuration(), kAcquisitions, random);
  settings.raw = true;
  settings.raw_last = 1;
  const std::vector<std::uint64_t> with = run(settings, lines);
  settings.short_words = false;
  EXPECT_EQ(run(settings, lines), with);
  settings.short_words = true;
  settings.raw = false;
  run(settings, lines);
}

}  // namespace
}  // namespace dtof
