// SPDX-License-Identifier: Apache-2.0
// shot_o before a sensor that answers each shot with an acquisition. The bench follows each clock
// (ShotReference); here are what must come of it: as many shots as acquisitions, the delays of the photon
// model, results of the lines that the shots caused.
#include <gtest/gtest.h>

#include <array>
#include <deque>

#include "dtof.h"
#include "dtof/photon/surroundings.hpp"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kMostClocks = 2000000;
constexpr std::size_t kMostRegisters = 8;  // lines; a longer buffer is an SRAM
constexpr std::uint32_t kAbortAndFlush = DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK;

std::uint32_t shot_register(std::uint32_t bits, std::uint32_t unit) {
  return bits << DTOF_SHOT_BITS_LSB | unit << DTOF_SHOT_UNIT_LSB;
}

class Shots : public Subsystem {
 protected:
  // Shots hold every source.
  void SetUp() override {}

  // A sensor with one acquisition at a time: its lines come `latency` clocks behind the shot.
  struct Sensor {
    std::uint64_t latency = 1;
    double miss_probability = 0.0;  // a shot without lines
    std::deque<Line> lines;         // of the acquisitions to come
    std::optional<std::uint64_t> clocks_until_lines;
    std::size_t taken = 0;  // shots
    std::size_t missed = 0;
  };

  [[nodiscard]] FrameSettings settings(std::uint32_t acquisitions) const {
    return {.acquisitions = acquisitions,
            .gate = {0, bench_.configuration().parameters.no_detection()},
            .weak_below = 1,
            .enabled = std::vector<bool>(static_cast<std::size_t>(bench_.configuration().sram_num), true),
            .second_target = false,
            .raw = false,
            .smooth = true,
            .prior = false};
  }

  void load(const std::vector<Line>& lines) {
    sensor_.lines.insert(sensor_.lines.end(), lines.begin(), lines.end());
  }

  // A clock, and what the sensor does in it.
  void clock(CounterRandom& random) {
    if (sensor_.clocks_until_lines && (*sensor_.clocks_until_lines)-- == 0) {
      sensor_.clocks_until_lines.reset();
      for (std::size_t i = 0; i < bench_.acquisition_lines() && !sensor_.lines.empty(); ++i) {
        bench_.source().push(sensor_.lines.front(), i + 1 == bench_.acquisition_lines());
        sensor_.lines.pop_front();
      }
    }
    bench_.clock();
    if (!bench_.shot()) {
      return;
    }
    EXPECT_FALSE(sensor_.clocks_until_lines) << "a shot while the sensor measures";
    ++sensor_.taken;
    if (random.uniform() < sensor_.miss_probability) {
      ++sensor_.missed;
      return;
    }
    sensor_.clocks_until_lines = sensor_.latency;
  }

  void clock_until_idle(CounterRandom& random) {
    std::uint64_t clocks = 0;
    const std::size_t frames = bench_.frames().size();
    while (bench_.frames().size() == frames || bench_.frames().back().cycles == 0 || !bench_.sink().idle()) {
      clock(random);
      ASSERT_LT(++clocks, kMostClocks) << "the frame does not end";
    }
  }

  void start(bool continuous = false) {
    bench_.begin_write(DTOF_CONTROL,
                       DTOF_CONTROL_START_MASK | (continuous ? DTOF_CONTROL_CONTINUOUS_MASK : 0U));
  }

  void expect_the_model(std::size_t frame, const FrameSettings& settings, const std::vector<Line>& lines) {
    ASSERT_EQ(bench_.frames().at(bench_.sink().numbers().at(frame)).lines, lines);
    ASSERT_EQ(received_results(bench_, frame), expected_results(bench_, settings, lines));
  }

  // Units that the shots of a frame were delayed by beside what is the same for all, if the array takes all
  // acquisitions alike.
  [[nodiscard]] std::vector<std::uint64_t> intervals(std::size_t frame) const {
    const std::vector<std::uint64_t>& shots = bench_.frames().at(frame).shots;
    std::vector<std::uint64_t> found;
    for (std::size_t i = 1; i < shots.size(); ++i) {
      found.push_back(shots[i] - shots[i - 1]);
    }
    return found;
  }

  // One pass, so that nothing but the sensor and the delay is between two shots.
  [[nodiscard]] bool one_pass() const {
    return bench_.configuration().parameters.readout == Readout::kEzPointer;
  }

  // Otherwise an acquisition begins before it is whole, and gaps in it are underruns.
  bool takes_gaps() {
    return bench_.clock_waits() ||
           bench_.get(DTOF_LINES) >> DTOF_LINES_BUFFER_LSB >= bench_.acquisition_lines();
  }

  Sensor sensor_;
};

INSTANTIATE_TEST_SUITE_P(All, Shots, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(Shots, AreAsManyAsAcquisitions) {
  CounterRandom random = this->random(50);
  for (int round = 0; round < 30; ++round) {
    const auto acquisitions = static_cast<std::uint32_t>(pick(random, 9));
    const auto bits = static_cast<std::uint32_t>(pick(random, 8));
    const auto unit = static_cast<std::uint32_t>(pick(random, bits > 5 ? 3 : 6));
    SCOPED_TRACE(testing::Message() << "round " << round << ", " << acquisitions << " acquisitions, " << bits
                                    << " bits of " << unit);
    const FrameSettings settings = this->settings(acquisitions);
    write_settings(bench_, settings);
    bench_.set(DTOF_SHOT, shot_register(bits, unit));
    if (round % 3 == 0) {
      bench_.set(DTOF_SHOT_SEED, round == 0 ? 0 : random() % 0x10000);
    }
    sensor_.latency = random() % 40;
    const bool gaps = pick(random, 2) == 0 && takes_gaps();
    bench_.source().gap_probability = gaps ? 0.7 * random.uniform() : 0.0;
    bench_.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.7 * random.uniform();
    const std::vector<Line> lines = make_lines(bench_.configuration(), acquisitions, random);
    load(lines);
    start();
    ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
    ASSERT_EQ(bench_.frames().back().shots.size(), acquisitions);
    ASSERT_NO_FATAL_FAILURE(expect_the_model(bench_.sink().frames().size() - 1, settings, lines));
    EXPECT_EQ(bench_.get(DTOF_SHOT_STATE), bench_.shot_reference().first_state());
    EXPECT_NE(bench_.get(DTOF_SHOT_STATE), 0U);
  }
  EXPECT_EQ(bench_.get(DTOF_ERROR), 0U) << "a sensor that waits for its shots never waits for the buffer";
}

TEST_P(Shots, GoOnFromFrameToFrame) {
  CounterRandom random = this->random(51);
  constexpr std::uint32_t kAcquisitions = 5;
  constexpr std::size_t kFrames = 4;
  const FrameSettings settings = this->settings(kAcquisitions);
  write_settings(bench_, settings);
  bench_.set(DTOF_SHOT, shot_register(3, 2));
  sensor_.latency = 3;
  const std::vector<Line> lines = make_lines(bench_.configuration(), kAcquisitions * 10, random);
  load(lines);
  start(true);
  while (bench_.sink().frames().size() < kFrames) {
    clock(random);
  }
  for (std::size_t frame = 0; frame < kFrames; ++frame) {
    EXPECT_EQ(bench_.frames()[frame].shots.size(), kAcquisitions);
    const auto first =
        lines.begin() + static_cast<std::ptrdiff_t>(frame * kAcquisitions * bench_.acquisition_lines());
    ASSERT_NO_FATAL_FAILURE(expect_the_model(
        frame, settings,
        {first, first + static_cast<std::ptrdiff_t>(kAcquisitions * bench_.acquisition_lines())}));
  }
}

TEST_P(Shots, HaveAConstantPaceWithoutDelays) {
  CounterRandom random = this->random(52);
  sensor_.latency = 7;
  for (const std::uint32_t setting : {shot_register(0, 9), shot_register(5, 0)}) {
    write_settings(bench_, settings(40));
    bench_.set(DTOF_SHOT, setting);
    const std::uint32_t state = bench_.get(DTOF_SHOT_STATE);
    load(make_lines(bench_.configuration(), 40, random));
    start();
    ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
    ASSERT_EQ(bench_.frames().back().shots.size(), 40U);
    if (one_pass() && takes_gaps()) {
      const std::vector<std::uint64_t> found = intervals(bench_.frames().size() - 1);
      // The first acquisition falls anywhere on the array's raster of SLOTS clocks, the others alike.
      EXPECT_EQ(std::ranges::count(found, found.back()), found.front() == found.back() ? 39 : 38);
      EXPECT_LE(found.back() - found.front(), 1U);
      // From shot to first line, the lines, and three clocks or with an SRAM four, on the raster
      // (subsystem.md, How fast).
      const auto slots = static_cast<std::uint64_t>(bench_.configuration().parameters.slots);
      const std::uint64_t clocks =
          sensor_.latency + 1 + bench_.acquisition_lines() + (bench_.buffer_lines() > kMostRegisters ? 4 : 3);
      EXPECT_EQ(found.back(), (clocks + slots - 1) / slots * slots);
    }
    EXPECT_EQ(bench_.get(DTOF_SHOT_STATE), state) << "without bits no delay is drawn before this frame";
  }
}

TEST_P(Shots, HaveTheDelaysOfThePhotonModel) {
  if (!one_pass()) {
    return;  // between the passes of other arrays are pauses beside the delays
  }
  CounterRandom random = this->random(53);
  const ReadoutParameters& parameters = bench_.configuration().parameters;
  constexpr std::uint32_t kAcquisitions = 3000;
  // On the array's raster, so that each delay has its whole length.
  const std::uint32_t unit = 2 * static_cast<std::uint32_t>(parameters.slots);
  sensor_.latency = 20;
  // What lies between two shots without a delay; the first acquisition falls anywhere on the array's raster.
  write_settings(bench_, settings(3));
  load(dark_lines(bench_.configuration(), 3));
  start();
  ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
  const std::uint64_t first_between = intervals(0).at(0);
  const std::uint64_t between = intervals(0).at(1);
  for (const int bits : {1, 5, 7}) {
    SCOPED_TRACE(testing::Message() << bits << " bits");
    const std::uint32_t seed = dtof_shot_seed(static_cast<std::uint32_t>(bits));
    const FrameSettings settings = this->settings(kAcquisitions);
    write_settings(bench_, settings);
    bench_.set(DTOF_SHOT, shot_register(static_cast<std::uint32_t>(bits), unit));
    bench_.set(DTOF_SHOT_SEED, seed);
    const std::vector<double> delays =
        FiringOffsets{.bits = bits, .step_s = 1.0, .seed = static_cast<std::uint16_t>(seed)}.delays(
            kAcquisitions);

    // What each acquisition sees of a laser that fires as often as this one would without delays, by the
    // model's delays alone. A code is a clock; each pixel has the event in its first slot.
    std::vector<Line> lines = dark_lines(bench_.configuration(), kAcquisitions);
    std::vector<std::uint64_t> model_shots;
    std::uint64_t shot = 0;
    for (std::uint32_t i = 0; i < kAcquisitions; ++i) {
      shot += (i == 0 ? 0 : i == 1 ? first_between : between) + unit * static_cast<std::uint64_t>(delays[i]);
      model_shots.push_back(shot);
      const std::uint64_t arrival = between - 1 - shot % between;  // clocks from this shot to the other one
      ASSERT_LT(arrival, static_cast<std::uint64_t>(parameters.no_detection()));
      for (std::size_t line = 0; line < bench_.acquisition_lines();
           line += static_cast<std::size_t>(parameters.slots)) {
        std::ranges::fill(lines[i * bench_.acquisition_lines() + line], static_cast<Timestamp>(arrival));
      }
    }
    load(lines);
    start();
    ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
    EXPECT_EQ(bench_.get(DTOF_SHOT_STATE), seed);
    const std::vector<std::uint64_t>& shots = bench_.frames().back().shots;
    ASSERT_EQ(shots.size(), kAcquisitions);
    for (std::size_t i = 0; i < shots.size(); ++i) {
      ASSERT_EQ(shots[i] - shots[0], model_shots[i] - model_shots[0]) << "shot " << i;
    }
    ASSERT_NO_FATAL_FAILURE(expect_the_model(bench_.sink().frames().size() - 1, settings, lines));

    // Every delay is as frequent as the others: chi-square, 1e-6 above.
    std::vector<double> counts(std::size_t{1} << static_cast<unsigned>(bits));
    for (std::size_t i = 2; i < shots.size(); ++i) {
      ++counts.at((shots[i] - shots[i - 1] - between) / unit);
    }
    const double expected = static_cast<double>(shots.size() - 2) / static_cast<double>(counts.size());
    double chi_square = 0.0;
    for (const double count : counts) {
      chi_square += (count - expected) * (count - expected) / expected;
    }
    EXPECT_LT(chi_square, bits == 1 ? 24.0 : bits == 5 ? 83.0 : 215.0);
  }
}

// A sensor that delivers while it measures the next acquisition hides delays behind its lines, another one
// pays for them.
TEST_P(Shots, CostNothingWhereTheyHideBehindLines) {
  constexpr std::uint64_t kUnit = 2;  // a multiple of the array's raster
  constexpr std::uint32_t kBits = 2;
  const std::uint64_t lines = bench_.acquisition_lines();
  if (bench_.configuration().parameters.slots != 2 || lines < 14 || !takes_gaps() || !bench_.source_waits()) {
    return;  // too short to hide six clocks behind a request
  }
  CounterRandom random = this->random(57);
  sensor_.latency = 0;
  const auto clocks = [&](std::uint32_t release, std::uint32_t bits) {
    const FrameSettings settings = this->settings(20);
    write_settings(bench_, settings);
    bench_.set(DTOF_RELEASE, release);
    bench_.set(DTOF_SHOT, shot_register(bits, kUnit));
    bench_.set(DTOF_SHOT_SEED, 1234);
    const std::vector<Line> taken = make_lines(bench_.configuration(), settings.acquisitions, random);
    load(taken);
    start();
    clock_until_idle(random);
    EXPECT_EQ(bench_.frames().back().shots.size(), settings.acquisitions);
    EXPECT_EQ(bench_.frames().back().lines, taken);
    return bench_.frames().back().cycles;
  };
  const std::uint64_t hidden = clocks(1, 0);
  EXPECT_EQ(clocks(1, kBits), hidden);
  const auto all = static_cast<std::uint32_t>(lines);
  const std::uint64_t whole = clocks(all, 0);
  EXPECT_GT(whole, hidden);
  double delays = 0.0;
  for (const double delay : FiringOffsets{.bits = kBits, .step_s = kUnit, .seed = 1234}.delays(20)) {
    delays += delay;
  }
  // The array's pauses, between phases and behind an acquisition, hide some of them even then.
  const std::uint64_t delayed = clocks(all, kBits);
  EXPECT_GT(delayed, whole);
  EXPECT_LE(delayed, whole + static_cast<std::uint64_t>(delays));
  EXPECT_EQ(bench_.get(DTOF_ERROR), 0U) << "no line was late";
}

TEST_P(Shots, EndWithTheirFrame) {
  CounterRandom random = this->random(54);
  std::size_t timeouts = 0;
  std::size_t aborted = 0;
  for (int round = 0; round < 90; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    const auto acquisitions = static_cast<std::uint32_t>(2 + pick(random, 8));
    write_settings(bench_, settings(acquisitions));
    bench_.set(DTOF_SHOT, shot_register(static_cast<std::uint32_t>(pick(random, 6)), 1 + random() % 3));
    bench_.set(DTOF_WATCHDOG, 300);
    sensor_.latency = random() % 30;
    sensor_.miss_probability = pick(random, 2) == 0 ? 0.0 : 0.3;
    load(make_lines(bench_.configuration(), acquisitions, random));
    const std::size_t missed = sensor_.missed;
    start();
    const std::size_t begun = bench_.frames().size();
    if (pick(random, 2) == 0) {
      while (bench_.frames().size() == begun) {
        clock(random);
      }
      for (std::uint32_t clocks = random() % 600; clocks > 0; --clocks) {
        clock(random);
      }
      // The software stops sensor and frame, and either begins anew.
      bench_.source().reset();
      bench_.set(DTOF_CONTROL, kAbortAndFlush);
      bench_.clock();  // the command's; a shot that was decided on before it may still come
      for (int i = 0; i < 400; ++i) {
        bench_.clock();
        ASSERT_FALSE(bench_.shot()) << "no shot without a frame";
      }
    } else {
      ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
      const bool gave_up = sensor_.missed > missed;
      EXPECT_EQ(bench_.events().timeout, gave_up);
      if (!gave_up) {
        ASSERT_EQ(bench_.frames().back().shots.size(), acquisitions);
      } else {
        ASSERT_LE(bench_.frames().back().shots.size(), acquisitions);
        bench_.set(DTOF_CONTROL, DTOF_CONTROL_FLUSH_MASK);
      }
    }
    timeouts += bench_.events().timeout ? 1 : 0;
    aborted += bench_.events().aborted ? 1 : 0;
    bench_.events() = {};
    sensor_.clocks_until_lines.reset();
    sensor_.lines.clear();
    sensor_.miss_probability = 0.0;
    bench_.source().reset();
    while (!bench_.sink().idle()) {
      bench_.clock();
    }
    // The next frame has its shots and is right.
    const FrameSettings next = settings(static_cast<std::uint32_t>(1 + pick(random, 4)));
    write_settings(bench_, next);
    const std::vector<Line> lines = make_lines(bench_.configuration(), next.acquisitions, random);
    load(lines);
    start();
    ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
    ASSERT_EQ(bench_.frames().back().shots.size(), next.acquisitions);
    ASSERT_NO_FATAL_FAILURE(expect_the_model(bench_.sink().frames().size() - 1, next, lines));
  }
  EXPECT_GT(timeouts, 5U);
  EXPECT_GT(aborted, 5U);
}

TEST_P(Shots, WaitForTheRestOfAnAcquisitionThatWasAborted) {
  CounterRandom random = this->random(55);
  write_settings(bench_, settings(4));
  load(make_lines(bench_.configuration(), 8, random));
  bench_.source().gap_probability = 0.99;  // so that the abort comes before the acquisition's last line
  start();
  while (bench_.reference().source_index() == 0) {
    clock(random);
  }
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK);
  bench_.clocks(16);
  start();
  // The sensor goes on with what it has; the bench's reference knows when the first shot may come.
  ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
  EXPECT_EQ(bench_.frames().back().shots.size(), 4U);
  EXPECT_EQ(bench_.get(DTOF_ERROR) & DTOF_ERROR_TIMEOUT_MASK, 0U);
}

TEST_P(Shots, AreTheDriversToSet) {
  dtof_device device{};
  ASSERT_EQ(dtof_probe(&device, {&bench_,
                                 [](void* context, std::uint32_t offset, std::uint32_t* value) {
                                   *value = static_cast<SubsystemBench*>(context)->get(offset);
                                   return true;
                                 },
                                 [](void* context, std::uint32_t offset, std::uint32_t value) {
                                   return !static_cast<SubsystemBench*>(context)->write(offset, value).error;
                                 }}),
            DTOF_OK);
  dtof_settings chosen = dtof_default_settings(&device, 3);
  EXPECT_EQ(chosen.shot_bits, 0);
  EXPECT_EQ(chosen.shot_unit, 1);
  EXPECT_EQ(chosen.settle, 0);
  chosen.shot_bits = 8;
  EXPECT_EQ(dtof_configure(&device, &chosen), DTOF_ARGUMENT);
  chosen.shot_bits = 5;
  chosen.shot_unit = 3;
  chosen.settle = 2;
  EXPECT_EQ(dtof_configure(&device, &chosen), DTOF_OK);
  EXPECT_EQ(bench_.get(DTOF_SHOT), shot_register(5, 3));
  EXPECT_EQ(bench_.get(DTOF_SETTLE), 2U);
  EXPECT_EQ(dtof_seed_shots(&device, 0), DTOF_ARGUMENT);
  EXPECT_EQ(dtof_seed_shots(&device, 0x10000), DTOF_ARGUMENT);
  EXPECT_EQ(dtof_seed_shots(&device, 0xBEEF), DTOF_OK);
  CounterRandom random = this->random(56);
  load(make_lines(bench_.configuration(), 5, random));
  ASSERT_EQ(dtof_commit(&device), DTOF_OK);
  start();
  ASSERT_NO_FATAL_FAILURE(clock_until_idle(random));
  EXPECT_EQ(bench_.frames().back().shots.size(), 5U) << "those that are dropped have shots, too";
  EXPECT_EQ(bench_.frames().back().lines.size(), 3 * bench_.acquisition_lines());
  std::uint32_t state = 0;
  EXPECT_EQ(dtof_read_shot_state(&device, &state), DTOF_OK);
  EXPECT_EQ(state, 0xBEEFU);
}

TEST(ShotSeeds, OfNeighboursAreFarApart) {
  std::size_t same = 0;
  for (std::uint32_t serial = 0; serial < 1000; ++serial) {
    EXPECT_GE(dtof_shot_seed(serial), 1U);
    EXPECT_LE(dtof_shot_seed(serial), 0xFFFFU);
    same += dtof_shot_seed(serial) == dtof_shot_seed(serial + 1) ? 1 : 0;
  }
  EXPECT_LE(same, 1U);
}

}  // namespace
}  // namespace dtof
