// SPDX-License-Identifier: Apache-2.0
// Random faults of the stream of lines, of the sink and of the software. Every frame ends, the registers name
// the faults, and the next good frame is right without a reset.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "dtof.h"
#include "tests/subsystem/stream_faults.hpp"

namespace dtof {
namespace {

/// Number of rounds: the environment variable DTOF_STREAM_FAULT_ROUNDS. Without this variable, a run takes
/// seconds, and a long run (DTOF_TEST_LONG) three times as long.
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

/// Puts a fault into the beats, and returns a description of the fault.
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

class RandomStreamFaults : public StreamFaults {
 protected:
  /// What a round begins with.
  struct Round {
    FrameSettings settings;
    std::vector<Beat> beats;
    bool continuous;
    std::string story;  ///< for messages
  };

  /// Draws settings, source, sink and damaged lines. Writes the settings to the registers.
  Round begin(std::uint32_t number, CounterRandom& random) {
    const RtlConfiguration& configuration = bench_.configuration();
    Round round{.settings = everything_counts(static_cast<std::uint32_t>(1 + pick(random, 6))),
                .beats = {},
                .continuous = false,
                .story = fmt::format("round {}", number)};
    FrameSettings& settings = round.settings;
    settings.second_target = pick(random, 2) == 0;
    settings.raw = pick(random, 4) == 0;
    settings.raw_last = pick(random, configuration.pixels_per_sram);
    settings.prior = pick(random, 2) == 0;
    settings.settle = pick(random, 2) == 0 ? 0 : static_cast<std::uint32_t>(1 + pick(random, 4));
    settings.short_words = pick(random, 2) == 0;
    settings.amplitude = pick(random, 2) == 0;
    write_settings(bench_, settings);
    bench_.set(DTOF_RELEASE, pick(random, 2) == 0 ? static_cast<std::uint32_t>(most_release_)
                                                  : 1 + random() % static_cast<std::uint32_t>(most_release_));
    const auto watchdog = static_cast<std::uint32_t>(20 + pick(random, 400));
    bench_.set(DTOF_WATCHDOG, watchdog);
    bench_.source().gap_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    bench_.source().impatient = pick(random, 6) == 0;
    bench_.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.9 * random.uniform();
    round.continuous = pick(random, 4) == 0;
    const int frames = round.continuous ? 1 + pick(random, 3) : 1;
    round.beats =
        beats_of(bright_lines(configuration, static_cast<std::uint32_t>(frames) * settings.taken(), random));
    for (int faults = pick(random, 4); faults > 0 && !round.beats.empty(); --faults) {
      const auto fault = static_cast<Fault>(pick(random, static_cast<int>(Fault::kNumber)));
      round.story += ", " + damage(round.beats, fault, bench_.acquisition_lines(), random);
    }
    round.story +=
        fmt::format(", SETTLE {}, watchdog {}{}{}", settings.settle, watchdog,
                    round.continuous ? ", continuous" : "", bench_.source().impatient ? ", impatient" : "");
    return round;
  }

  /// Runs frames until they end by themselves, or by an abort in one of four rounds. In a round with an abort
  /// the sink may have stopped before.
  void run_to_the_end(const Round& round, CounterRandom& random) {
    push(round.beats);
    bench_.clocks(random() % 20);
    bench_.set(DTOF_CONTROL,
               DTOF_CONTROL_START_MASK | (round.continuous ? DTOF_CONTROL_CONTINUOUS_MASK : 0U));
    if (pick(random, 4) == 0) {
      const int longest = 1 << pick(random, 12);
      bench_.clocks(random() % static_cast<std::uint32_t>(longest));
      bench_.sink().blocked = pick(random, 2) == 0;
      bench_.clocks(random() % static_cast<std::uint32_t>(longest));
      ASSERT_NO_FATAL_FAILURE(expect_the_models(round.settings));
      ASSERT_NO_FATAL_FAILURE(abort(kAbort));
      bench_.sink().blocked = false;
      ASSERT_NO_FATAL_FAILURE(wait_until_idle());
      // Words that had left the array before the abort are a frame with the settings of that time.
      checked_ = bench_.sink().frames().size();
    } else {
      if (round.continuous) {
        bench_.clocks(random() % 3000);
        bench_.set(DTOF_CONTROL, 0);
      }
      ASSERT_NO_FATAL_FAILURE(wait_until_idle());
      ASSERT_NO_FATAL_FAILURE(expect_the_models(round.settings));
    }
    bench_.source().dead = true;
    bench_.clocks(2 * bench_.acquisition_lines() + 10);
    timeouts_ += bench_.events().timeout ? 1 : 0;
    aborted_ += bench_.events().aborted ? 1 : 0;
    underruns_ += bench_.events().underrun ? 1 : 0;
    ASSERT_NO_FATAL_FAILURE(expect_registers());
  }

  void repair_the_source() {
    bench_.source().reset();
    bench_.source().dead = false;
    bench_.source().impatient = false;
    bench_.source().gap_probability = 0.0;
    bench_.set(DTOF_WATCHDOG, 1000);
  }

  /// The software writes once, while the source stands still.
  void recover_by_an_abort(const FrameSettings& settings, CounterRandom& random) {
    ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
    ASSERT_NO_FATAL_FAILURE(expect_a_good_frame(settings, random));
    bench_.events().overrun = false;
    bench_.set(DTOF_ERROR, DTOF_ERROR_OVERRUN_MASK);
    ASSERT_NO_FATAL_FAILURE(expect_registers());
  }

  /// The software writes nothing, and the source begins anew. One frame is damaged, the next frame is right.
  void recover_by_itself(FrameSettings settings, CounterRandom& random) {
    ++by_itself_;
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
    ASSERT_TRUE(found) << "the acquisitions of the next frame are not whole and consecutive";
    bench_.source().reset();
    bench_.clocks(2 * bench_.acquisition_lines() + 10);
    ASSERT_NO_FATAL_FAILURE(expect_registers());
    ASSERT_NO_FATAL_FAILURE(abort(kAbortAndFlush));
  }

  /// Fails if a kind of event was rare in all rounds together.
  void expect_every_kind_of_event(std::uint32_t rounds) {
    EXPECT_GT(timeouts_, rounds / 15);
    EXPECT_GT(aborted_, rounds / 30);
    if (bench_.clock_waits()) {
      EXPECT_EQ(underruns_, 0U);
      EXPECT_GT(bench_.rests(), rounds * 10 / 3);
    } else {
      EXPECT_GT(underruns_, rounds / 60);
    }
    EXPECT_GT(by_itself_, rounds / 3);
  }

 private:
  std::size_t timeouts_ = 0;
  std::size_t aborted_ = 0;
  std::size_t underruns_ = 0;
  std::size_t by_itself_ = 0;
};

INSTANTIATE_TEST_SUITE_P(All, RandomStreamFaults, testing::ValuesIn(compiled_subsystems()),
                         subsystem_test_name);

TEST_P(RandomStreamFaults, AreOverWithTheNextGoodFrame) {
  const std::uint32_t rounds = fault_rounds();
  for (std::uint32_t number = 0; number < rounds; ++number) {
    CounterRandom random = this->random(1000 + number);
    Round round = begin(number, random);
    SCOPED_TRACE(round.story);
    ASSERT_NO_FATAL_FAILURE(run_to_the_end(round, random));
    repair_the_source();
    round.settings.raw = false;
    round.settings.acquisitions = static_cast<std::uint32_t>(1 + pick(random, 4));
    if (pick(random, 2) == 0) {
      ASSERT_NO_FATAL_FAILURE(recover_by_an_abort(round.settings, random));
    } else {
      ASSERT_NO_FATAL_FAILURE(recover_by_itself(round.settings, random));
    }
  }
  if (rounds >= 100) {
    expect_every_kind_of_event(rounds);
  }
}

}  // namespace
}  // namespace dtof
