// SPDX-License-Identifier: Apache-2.0
// Faults of the stream of lines, of the sink and of the software: a frame ends whatever happens, registers
// say what happened, and the next good frame is right without a reset. The bench follows each clock
// (StreamReference).
#include <gtest/gtest.h>

#include <cstdlib>

#include "dtof.h"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kMostClocksOfAFrame = 100000;
constexpr std::uint64_t kClocksOfAnAbort = 16;
constexpr std::uint32_t kAbort = DTOF_CONTROL_ABORT_MASK;
constexpr std::uint32_t kAbortAndFlush = DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK;
constexpr std::uint32_t kNoWatchdog = 0;

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

  // The write that always works.
  void abort(std::uint32_t command) {
    bench_.set(DTOF_CONTROL, command);
    priors_.clear();  // the array is as behind a reset
    bench_.clocks(kClocksOfAnAbort);
    ASSERT_FALSE(busy()) << "an abort does not end the frame";
  }

  // What ERROR and WARNING must say by what was seen at the ports, beside `own`; forgets it.
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

  // Every frame that came whole since the last call is the model's, of the lines that the array took.
  void expect_the_models(const FrameSettings& settings) {
    for (; checked_ < bench_.sink().frames().size(); ++checked_) {
      const ArrayFrame& taken = bench_.frames().at(bench_.sink().numbers()[checked_]);
      ASSERT_EQ(taken.lines.size(), lines_of(settings.acquisitions));
      ASSERT_EQ(received_results(bench_, checked_),
                expected_results(bench_, settings, taken.lines, &priors_));
    }
  }

  // A frame of lines that nothing happens to: the array takes just these, and nothing is told.
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

TEST_P(StreamFaults, ASinkThatStopsIsToldAndAborted) {
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

// Rounds of the random test: the environment variable DTOF_STREAM_FAULT_ROUNDS, else as many as take seconds,
// and more in a long run.
std::uint32_t fault_rounds() {
  if (const char* text = std::getenv("DTOF_STREAM_FAULT_ROUNDS")) {
    return static_cast<std::uint32_t>(std::stoul(text));
  }
  return std::getenv("DTOF_TEST_LONG") == nullptr ? 100 : 300;
}

enum class Fault : std::uint8_t {
  kLostLine,
  kLostLastLine,
  kExtraLine,
  kMissingLast,
  kExtraLast,
  kEarlyLast,
  kLateLast,
  kLostAcquisition,
  kDies,
  kNumber
};

// Does it to the beats; says so.
std::string damage(std::vector<Beat>& beats, Fault fault, std::size_t acquisition_lines,
                   CounterRandom& random) {
  const std::size_t at = random() % beats.size();
  const auto place = beats.begin() + static_cast<std::ptrdiff_t>(at);
  const std::size_t end = std::min(at - at % acquisition_lines + acquisition_lines, beats.size()) - 1;
  switch (fault) {
    case Fault::kLostLine:
      beats.erase(place);
      return fmt::format("line {} is lost", at);
    case Fault::kLostLastLine:
      beats.erase(beats.begin() + static_cast<std::ptrdiff_t>(end));
      return fmt::format("line {} is lost, an acquisition's last", end);
    case Fault::kExtraLine:
      beats.insert(place, Beat{beats[at].line, false});
      return fmt::format("line {} comes twice", at);
    case Fault::kMissingLast:
      beats[end].last = false;
      return fmt::format("tlast is missing at {}", end);
    case Fault::kExtraLast:
      beats[at].last = true;
      return fmt::format("tlast at {}", at);
    case Fault::kEarlyLast:
      beats[end].last = false;
      beats[at].last = true;
      return fmt::format("tlast at {} instead of {}", at, end);
    case Fault::kLateLast:
      beats[end].last = false;
      beats[std::min(end + 1 + random() % 3, beats.size() - 1)].last = true;
      return fmt::format("tlast is late at {}", end);
    case Fault::kLostAcquisition: {
      const std::size_t first = at - at % acquisition_lines;
      beats.erase(beats.begin() + static_cast<std::ptrdiff_t>(first),
                  beats.begin() + static_cast<std::ptrdiff_t>(end + 1));
      return fmt::format("lines {} to {} are lost", first, end);
    }
    case Fault::kDies:
    case Fault::kNumber:
      beats.erase(place, beats.end());
      return fmt::format("the source dies at {}", at);
  }
  return "nothing";
}

TEST_P(StreamFaults, AreOverWithTheNextGoodFrame) {
  const RtlConfiguration& configuration = bench_.configuration();
  std::size_t timeouts = 0;
  std::size_t aborted = 0;
  std::size_t underruns = 0;
  std::size_t by_itself = 0;
  for (std::uint32_t round = 0; round < fault_rounds(); ++round) {
    CounterRandom random = this->random(1000 + round);
    std::string story = fmt::format("round {}", round);
    FrameSettings settings = everything_counts(static_cast<std::uint32_t>(1 + pick(random, 6)));
    settings.second_target = pick(random, 2) == 0;
    settings.raw = pick(random, 4) == 0;
    settings.raw_last = pick(random, configuration.pixels_per_sram);
    settings.prior = pick(random, 2) == 0;
    settings.settle = pick(random, 2) == 0 ? 0 : static_cast<std::uint32_t>(1 + pick(random, 4));
    settings.short_words = pick(random, 2) == 0;
    write_settings(bench_, settings);
    bench_.set(DTOF_RELEASE, pick(random, 2) == 0 ? static_cast<std::uint32_t>(most_release_)
                                                  : 1 + random() % static_cast<std::uint32_t>(most_release_));
    const auto watchdog = static_cast<std::uint32_t>(20 + pick(random, 400));
    bench_.set(DTOF_WATCHDOG, watchdog);
    bench_.source().gap_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    bench_.source().impatient = pick(random, 6) == 0;
    bench_.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    const bool continuous = pick(random, 4) == 0;
    const int frames = continuous ? 1 + pick(random, 3) : 1;
    std::vector<Beat> beats = beats_of(
        bright_lines(bench_.configuration(), static_cast<std::uint32_t>(frames) * settings.taken(), random));
    for (int faults = pick(random, 4); faults > 0 && !beats.empty(); --faults) {
      const auto fault = static_cast<Fault>(pick(random, static_cast<int>(Fault::kNumber)));
      story += ", " + damage(beats, fault, bench_.acquisition_lines(), random);
    }
    story += fmt::format(", SETTLE {}, watchdog {}{}{}", settings.settle, watchdog,
                         continuous ? ", continuous" : "", bench_.source().impatient ? ", impatient" : "");
    SCOPED_TRACE(story);

    push(beats);
    bench_.clocks(random() % 20);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | (continuous ? DTOF_CONTROL_CONTINUOUS_MASK : 0U));
    const int ending = pick(random, 4);
    if (ending == 0) {  // the software has had enough; the sink may have stopped before
      const int longest = 1 << pick(random, 12);
      bench_.clocks(random() % static_cast<std::uint32_t>(longest));
      bench_.sink().blocked = pick(random, 2) == 0;
      bench_.clocks(random() % static_cast<std::uint32_t>(longest));
      ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
      ASSERT_NO_FATAL_FAILURE(abort(kAbort));
      bench_.sink().blocked = false;
      ASSERT_NO_FATAL_FAILURE(wait_until_idle());
      // What had left the array before the abort is a frame with the settings of that time.
      checked_ = bench_.sink().frames().size();
    } else {
      if (continuous) {
        bench_.clocks(random() % 3000);
        bench_.set(DTOF_CONTROL, 0);
      }
      ASSERT_NO_FATAL_FAILURE(wait_until_idle());
      ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
    }
    bench_.source().dead = true;
    bench_.clocks(2 * bench_.acquisition_lines() + 10);
    timeouts += bench_.events().timeout ? 1 : 0;
    aborted += bench_.events().aborted ? 1 : 0;
    underruns += bench_.events().underrun ? 1 : 0;
    ASSERT_NO_FATAL_FAILURE(expect_registers());

    bench_.source().reset();
    bench_.source().dead = false;
    bench_.source().impatient = false;
    bench_.source().gap_probability = 0.0;
    bench_.set(DTOF_WATCHDOG, 1000);
    settings.raw = false;
    settings.acquisitions = static_cast<std::uint32_t>(1 + pick(random, 4));
    if (pick(random, 2) == 0) {
      // One write, with the source stopped.
      ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
      ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(settings, random));
      bench_.events().overrun = false;
      bench_.set(DTOF_ERROR, DTOF_ERROR_OVERRUN_MASK);
      ASSERT_NO_FATAL_FAILURE(expect_registers());
      continue;
    }
    // No write: a source that begins anew. One frame is damaged, the next one is right.
    ++by_itself;
    constexpr std::uint32_t kDamaged = 16;
    const std::uint32_t acquisitions = settings.acquisitions;
    const std::vector<Line> lines =
        bright_lines(bench_.configuration(), kDamaged + acquisitions + 2 * settings.settle + 3, random);
    push(beats_of(lines));
    for (const std::uint32_t number : {kDamaged, acquisitions}) {
      settings.acquisitions = number;
      write_settings(bench_, settings);
      bench_.set(DTOF_RELEASE, static_cast<std::uint32_t>(most_release_));
      bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
      ASSERT_NO_FATAL_FAILURE(wait_until_idle());
      ASSERT_NO_FATAL_FAILURE(expect_the_models(settings));
    }
    const std::vector<Line>& taken = bench_.frames().back().lines;
    bool found = false;
    for (std::size_t first = 0; first + taken.size() <= lines.size(); first += bench_.acquisition_lines()) {
      found =
          found || std::equal(taken.begin(), taken.end(), lines.begin() + static_cast<std::ptrdiff_t>(first));
    }
    ASSERT_TRUE(found) << "the next frame is not of whole acquisitions one behind the other";
    bench_.source().reset();
    bench_.clocks(2 * bench_.acquisition_lines() + 10);
    ASSERT_NO_FATAL_FAILURE(expect_registers());
    ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
  }
  const std::uint32_t rounds = fault_rounds();
  if (rounds >= 100) {
    EXPECT_GT(timeouts, rounds / 15);
    EXPECT_GT(aborted, rounds / 30);
    if (bench_.clock_waits()) {
      EXPECT_EQ(underruns, 0U);
      EXPECT_GT(bench_.rests(), rounds * 10 / 3);
    } else {
      EXPECT_GT(underruns, rounds / 60);
    }
    EXPECT_GT(by_itself, rounds / 3);
  }
}

}  // namespace
}  // namespace dtof
