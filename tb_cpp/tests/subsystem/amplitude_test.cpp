// SPDX-License-Identifier: Apache-2.0
// Frames whose words have amplitude and ambient (OUTPUT.AMPLITUDE): the same frame as without. Half of the
// frames of the other tests have such words, too.
#include <gtest/gtest.h>

#include "dtof.h"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kPlaceMask = DTOF_RESULT_ROW_MASK | DTOF_RESULT_COLUMN_MASK;

class AmplitudeWords : public Subsystem {
 protected:
  [[nodiscard]] FrameSettings everything_counts(std::uint32_t acquisitions) const {
    return {.acquisitions = acquisitions,
            .gate = {0, bench_.configuration().parameters.no_detection()},
            .weak_below = 2,
            .enabled = std::vector<bool>(static_cast<std::size_t>(bench_.configuration().sram_num), true),
            .amplitude = true};
  }

  void start(const FrameSettings& settings, const std::vector<Line>& lines) {
    write_settings(bench_, settings);
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  }

  /// Lines of pixels that see background alone.
  std::vector<Line> ambient_lines(std::uint32_t acquisitions, CounterRandom& random) {
    const RtlConfiguration& configuration = bench_.configuration();
    std::vector<Line> lines = dark_lines(configuration, acquisitions);
    for (std::size_t column = 0; column < static_cast<std::size_t>(configuration.sram_num); ++column) {
      for (std::size_t row = 0; row < static_cast<std::size_t>(configuration.pixels_per_sram); ++row) {
        put_pixel(lines, configuration, column, row,
                  make_stream(StreamKind::kUniform, configuration.parameters, acquisitions, random));
      }
    }
    return lines;
  }

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

std::vector<CompiledSubsystem> subsystems_with_amplitude() {
  std::vector<CompiledSubsystem> subsystems = compiled_subsystems();
  std::erase_if(subsystems, [](const CompiledSubsystem& subsystem) {
    return !subsystem.configuration.parameters.pool.amplitude;
  });
  return subsystems;
}

INSTANTIATE_TEST_SUITE_P(All, AmplitudeWords, testing::ValuesIn(subsystems_with_amplitude()),
                         subsystem_test_name);

TEST_P(AmplitudeWords, DifferInRowAndColumnAlone) {
  CounterRandom random = this->random(80);
  int amplitudes = 0;
  int ambients = 0;
  for (const bool second : {false, true}) {
    FrameSettings settings = everything_counts(300);
    settings.second_target = second;
    settings.enabled[random() % settings.enabled.size()] = false;
    const std::vector<Line> lines = ambient_lines(settings.acquisitions, random);
    settings.amplitude = false;
    const std::vector<std::uint64_t> words = run(settings, lines);
    const std::uint32_t cycles = bench_.get(DTOF_FRAME_CYCLES);
    settings.amplitude = true;
    const std::vector<std::uint64_t> others = run(settings, lines);
    EXPECT_EQ(bench_.get(DTOF_FRAME_CYCLES), cycles) << "amplitudes cost no clock";
    ASSERT_EQ(others.size(), words.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
      EXPECT_EQ(others[i] & ~kPlaceMask, words[i] & ~kPlaceMask) << "word " << i;
      amplitudes += fields_of_amplitude(others[i]).amplitude > 0 ? 1 : 0;
      ambients += fields_of_amplitude(others[i]).ambient > 0 ? 1 : 0;
    }
    settings.short_words = true;
    const std::vector<std::uint64_t> beats = run(settings, lines);
    settings.amplitude = false;
    EXPECT_EQ(run(settings, lines), beats) << "short words have none";
  }
  EXPECT_GT(amplitudes, 10);
  EXPECT_GT(ambients, 10);
}

TEST_P(AmplitudeWords, KeepTheKindOfTheirFrameInContinuousMode) {
  CounterRandom random = this->random(81);
  FrameSettings settings = everything_counts(1);
  write_settings(bench_, settings);
  constexpr std::size_t kFrames = 40;
  run_with_changing_output(bench_, DTOF_OUTPUT_AMPLITUDE_MASK,
                           make_lines(bench_.configuration(), 2 * kFrames, random), kFrames, random);
  std::size_t changes = 0;
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    settings.amplitude = bench_.sink().amplitude()[frame];
    changes += frame > 0 && settings.amplitude != bench_.sink().amplitude()[frame - 1] ? 1 : 0;
    ASSERT_EQ(received_results(bench_, frame),
              expected_results(bench_, settings, bench_.frames().at(frame).lines));
  }
  EXPECT_GT(changes, 5U);
}

TEST_P(AmplitudeWords, OfAnAbortedFrameAreItsBeginning) {
  CounterRandom random = this->random(82);
  FrameSettings settings = everything_counts(6);
  const std::vector<Line> lines = make_lines(bench_.configuration(), settings.acquisitions, random);
  start(settings, lines);
  std::uint64_t first = 0;
  for (; bench_.sink().current().empty(); ++first) {
    bench_.clock();
  }
  std::uint64_t end = first;
  for (; bench_.sink().frames().empty(); ++end) {
    bench_.clock();
  }
  std::size_t aborted = 0;
  for (std::uint64_t clock = first; clock < end; clock += 1 + (end - first) / 40) {
    SCOPED_TRACE(testing::Message() << "clock " << clock << " of " << first << " to " << end);
    settings.second_target = clock % 2 == 0;
    start(settings, lines);
    bench_.clocks(clock);
    const std::size_t before = bench_.sink().aborted();
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK);
    bench_.source().reset();
    bench_.clocks(kClocksOfAnAbort);
    while (!bench_.sink().idle()) {
      bench_.clock();
    }
    bench_.clocks(10);
    if (bench_.sink().aborted() > before) {
      ++aborted;
      const std::vector<std::uint64_t>& words = bench_.sink().aborted_words();
      EXPECT_EQ(words.back(), DTOF_RESULT_ABORTED_MASK);
      std::vector<ResultFields> received = amplitude_results(bench_, words);
      received.pop_back();
      std::vector<ResultFields> expected = expected_results(bench_, settings, lines);
      ASSERT_LE(received.size(), expected.size());
      expected.resize(received.size());
      ASSERT_EQ(received, expected);
    }
  }
  EXPECT_GT(aborted, 5U);
  settings.second_target = false;
  run(settings, lines);
}

}  // namespace
}  // namespace dtof
