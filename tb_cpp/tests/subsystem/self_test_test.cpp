// SPDX-License-Identifier: Apache-2.0
// The built-in self-test: its lines and its signature are those of the models, a defect fails it, and frames
// before and after are as without it. The bench checks in every clock that no line of the source reaches the
// array, no word leaves, and no shot is fired.
#include <gtest/gtest.h>

#include <map>

#include "dtof.h"
#include "subsystem/self_test_reference.hpp"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kMostClocks = 400000;
constexpr std::uint32_t kMostReads = 1000000;

std::uint64_t word_of(const ResultFields& fields, bool amplitude) {
  const auto field = [](int value, int lsb) { return static_cast<std::uint64_t>(value) << lsb; };
  const std::uint64_t place =
      amplitude ? field(fields.amplitude, 32) | field(fields.ambient, 44)
                : field(fields.row, DTOF_RESULT_ROW_LSB) | field(fields.column, DTOF_RESULT_COLUMN_LSB);
  return field(fields.position, DTOF_RESULT_POSITION_LSB) |
         field(fields.confidence, DTOF_RESULT_CONFIDENCE_LSB) | place |
         (fields.valid ? DTOF_RESULT_VALID_MASK : 0) | (fields.weak ? DTOF_RESULT_WEAK_MASK : 0) |
         (fields.empty ? DTOF_RESULT_EMPTY_MASK : 0) | (fields.masked ? DTOF_RESULT_MASKED_MASK : 0) |
         (fields.saturated ? DTOF_RESULT_SATURATED_MASK : 0) | (fields.second ? DTOF_RESULT_SECOND_MASK : 0) |
         (fields.raw ? DTOF_RESULT_RAW_MASK : 0);
}

std::vector<Line> self_test_lines(const RtlConfiguration& configuration, std::uint32_t acquisitions,
                                  std::uint32_t seed) {
  SelfTestLines generator(configuration, seed);
  std::vector<Line> lines(static_cast<std::size_t>(acquisitions) *
                          static_cast<std::size_t>(configuration.pixels_per_sram) *
                          static_cast<std::size_t>(configuration.parameters.slots));
  for (Line& line : lines) {
    line = generator.next();
  }
  return lines;
}

class SelfTest : public testing::TestWithParam<CompiledSubsystem> {
 protected:
  void SetUp() override {
    if ((bench_.get(DTOF_READOUT) & DTOF_READOUT_SELF_TEST_MASK) == 0) {
      GTEST_SKIP() << "no self-test";
    }
    ASSERT_EQ(dtof_probe(&device_,
                         {&bench_,
                          [](void* context, std::uint32_t offset, std::uint32_t* value) {
                            const BusResponse response = static_cast<SubsystemBench*>(context)->read(offset);
                            *value = response.data;
                            return !response.error;
                          },
                          [](void* context, std::uint32_t offset, std::uint32_t value) {
                            return !static_cast<SubsystemBench*>(context)->write(offset, value).error;
                          }}),
              DTOF_OK);
  }

  [[nodiscard]] static CounterRandom random(std::uint32_t which) {
    return {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), which, 0};
  }

  [[nodiscard]] const RtlConfiguration& configuration() const { return bench_.configuration(); }
  bool raster() { return device_.has_raster_order; }
  std::uint32_t status() { return bench_.get(DTOF_STATUS); }
  bool busy() { return (status() & DTOF_STATUS_BUSY_MASK) != 0; }

  void wait_until_idle() {
    std::uint64_t clocks = 0;
    while (busy()) {
      bench_.clock();
      ASSERT_LT(++clocks, kMostClocks) << "it does not end";
    }
  }

  // Every timestamp counts, and all that the configuration has is on.
  [[nodiscard]] FrameSettings settings(std::uint32_t acquisitions) const {
    return {
        .acquisitions = acquisitions, .gate = {0, configuration().parameters.no_detection()}, .enabled = {}};
  }

  // The settings of dtof_default_settings.
  void configure(std::uint32_t acquisitions) {
    const dtof_settings chosen = dtof_default_settings(&device_, acquisitions);
    ASSERT_EQ(dtof_configure(&device_, &chosen), DTOF_OK);
  }

  void begin(std::uint32_t seed, std::uint32_t expected) {
    bench_.set(DTOF_SELF_TEST_SEED, seed);
    bench_.set(DTOF_SELF_TEST_EXPECTED, expected);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_SELF_TEST_MASK);
  }

  std::uint32_t expected_crc(const FrameSettings& settings, std::uint32_t seed,
                             std::vector<PoolPrior>* priors = nullptr) {
    std::vector<std::uint64_t> words;
    for (const ResultFields& fields : expected_results(
             bench_, settings, self_test_lines(configuration(), settings.acquisitions, seed), priors)) {
      words.push_back(word_of(fields, settings.amplitude && configuration().parameters.pool.amplitude));
    }
    return dtof_crc(words.data(), words.size());
  }

  void clear() {
    bench_.set(DTOF_ERROR, 0xFFFFFFFF);
    bench_.set(DTOF_WARNING, 0xFFFFFFFF);
    bench_.set(DTOF_IRQ_STATUS, 0xFFFFFFFF);
  }

  SubsystemBench bench_{GetParam(), test_seed()};
  dtof_device device_{};
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

INSTANTIATE_TEST_SUITE_P(All, SelfTest, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(SelfTest, PassesWithTheSignatureOfTheModels) {
  for (const std::uint32_t seed : {1U, 0U, 0xDEADBEEFU}) {
    for (const std::uint32_t acquisitions : {0U, 1U, 40U}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", acquisitions " << acquisitions);
      ASSERT_NO_FATAL_FAILURE(configure(acquisitions));
      const std::uint32_t signature = self_test_signature(configuration(), raster(), acquisitions, seed);
      EXPECT_EQ(signature, expected_crc(settings(acquisitions), seed));
      const std::uint32_t before = bench_.get(DTOF_FRAME_COUNT);
      EXPECT_EQ(dtof_self_test(&device_, seed, signature, kMostReads), DTOF_OK);
      EXPECT_EQ(bench_.get(DTOF_FRAME_CRC), signature);
      EXPECT_EQ(status() & (DTOF_STATUS_SELF_TEST_MASK | DTOF_STATUS_PASSED_MASK), DTOF_STATUS_PASSED_MASK);
      EXPECT_TRUE(bench_.frames().back().self_test);
      EXPECT_EQ(bench_.frames().back().lines, self_test_lines(configuration(), acquisitions, seed));
      EXPECT_TRUE(bench_.frames().back().shots.empty());
      EXPECT_EQ(bench_.get(DTOF_FRAME_COUNT), before) << "FRAME_COUNT counts frames that the sink takes";
      EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS), 0U);
      EXPECT_EQ(bench_.get(DTOF_ERROR), 0U);
      EXPECT_TRUE(bench_.sink().frames().empty());
      const std::uint32_t wrong = signature ^ 1U << (acquisitions % 32U);
      EXPECT_EQ(dtof_self_test(&device_, seed, wrong, kMostReads), DTOF_FAILED);
      EXPECT_EQ(status() & (DTOF_STATUS_SELF_TEST_MASK | DTOF_STATUS_PASSED_MASK), 0U);
      EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_SELF_TEST_MASK);
      EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS), DTOF_IRQ_STATUS_ERROR_MASK);
      clear();
    }
  }
}

TEST_P(SelfTest, UsesTheSettingsThatWereWrittenLast) {
  CounterRandom random = SelfTest::random(70);
  std::vector<PoolPrior> priors;
  for (int round = 0; round < 6; ++round) {
    FrameSettings settings = this->settings(1 + random() % 20);
    const int codes = configuration().parameters.code_count();
    settings.gate = {pick(random, codes / 4), codes - 1 - pick(random, codes / 4)};
    settings.weak_below = static_cast<std::uint32_t>(pick(random, 4));
    for (int column = 0; column < configuration().sram_num; ++column) {
      settings.enabled.push_back(pick(random, 4) != 0);
    }
    settings.second_target = pick(random, 2) == 0;
    settings.smooth = pick(random, 2) == 0;
    settings.raw = pick(random, 3) == 0;
    settings.raw_last = configuration().pixels_per_sram - 1;
    settings.prior = pick(random, 2) == 0;
    settings.amplitude = pick(random, 2) == 0;
    settings.settle = 3;  // no acquisition of a self-test is dropped
    if (configuration().parameters.readout == Readout::kHisPointer && configuration().raw_histogram) {
      settings.weak_below = 0;
    }
    write_settings(bench_, settings);
    const std::uint32_t seed = random();
    const std::uint32_t signature = expected_crc(settings, seed, &priors);
    ASSERT_EQ(dtof_self_test(&device_, seed, signature, kMostReads), DTOF_OK) << "round " << round;
    ASSERT_EQ(bench_.frames().back().lines, self_test_lines(configuration(), settings.acquisitions, seed));
  }
}

TEST_P(SelfTest, GivesEveryColumnItsOwnTimestampsAndUsesEveryBit) {
  const std::vector<Line> lines = self_test_lines(configuration(), 200, 1);
  const int np = configuration().parameters.np;
  const auto none = static_cast<Timestamp>(configuration().parameters.no_detection());
  const auto columns = static_cast<std::size_t>(configuration().sram_num);
  for (std::size_t column = 0; column < columns; ++column) {
    std::size_t dark = 0;
    Timestamp ones = 0;
    Timestamp zeros = 0;
    for (const Line& line : lines) {
      dark += line[column] == none ? 1 : 0;
      ones = static_cast<Timestamp>(ones | (line[column] == none ? 0 : line[column]));
      zeros = static_cast<Timestamp>(zeros | ~line[column]);
    }
    EXPECT_EQ(ones, none) << "column " << column << " of " << np << " bits";
    EXPECT_EQ(zeros & none, none);
    EXPECT_NEAR(static_cast<double>(dark) / static_cast<double>(lines.size()), 0.25, 0.1);
    for (std::size_t other = 0; other < column; ++other) {
      std::size_t equal = 0;
      for (const Line& line : lines) {
        equal += line[column] == line[other] ? 1 : 0;
      }
      EXPECT_LT(equal, lines.size() / 2) << "columns " << column << " and " << other;
    }
  }
  // The targets: half of the timestamps of a pixel are in one of the coarse bins.
  const auto rows = static_cast<std::size_t>(configuration().pixels_per_sram);
  const auto slots = static_cast<std::size_t>(configuration().parameters.slots);
  const int fine_bits = np - std::min(5, np - 1);
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      std::map<int, int> coarse;
      int all = 0;
      for (std::size_t i = row * slots; i < lines.size(); i += rows * slots) {
        for (std::size_t slot = 0; slot < slots; ++slot, ++all) {
          if (lines[i + slot][column] != none) {
            ++coarse[lines[i + slot][column] >> fine_bits];
          }
        }
      }
      const auto peak = std::ranges::max_element(coarse, {}, [](const auto& bin) { return bin.second; });
      EXPECT_GT(peak->second, all / 3) << "row " << row << " column " << column;
    }
  }
}

TEST_P(SelfTest, LeavesFramesBeforeAndAfterAsTheyAre) {
  if (!bench_.source_waits()) {
    GTEST_SKIP() << "its source has a test of its own";
  }
  CounterRandom random = SelfTest::random(71);
  FrameSettings settings = this->settings(4);
  std::vector<PoolPrior> priors;
  std::size_t frame = 0;
  for (int round = 0; round < 4; ++round) {
    SCOPED_TRACE(round);
    settings.acquisitions = 1 + random() % 8;
    settings.settle = static_cast<std::uint32_t>(pick(random, 2));
    settings.second_target = pick(random, 2) == 0;
    settings.prior = pick(random, 2) == 0;
    bench_.source().gap_probability = 0.0;
    bench_.sink().stall_probability = 0.4;
    write_settings(bench_, settings);
    const std::vector<Line> lines = make_lines(configuration(), 2 * settings.taken(), random);
    const auto middle = lines.begin() + static_cast<std::ptrdiff_t>(lines.size() / 2);
    push_lines(bench_, lines);  // those of both frames: the second frame's wait during the self-test
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    const std::vector<Line> first = settled_lines(bench_, settings, {lines.begin(), middle});
    ASSERT_EQ(received_results(bench_, frame++), expected_results(bench_, settings, first, &priors));
    const std::uint32_t seed = random();
    const std::uint32_t signature = expected_crc(settings, seed, &priors);
    bench_.clock();  // STATUS.BUSY falls
    ASSERT_EQ(dtof_self_test(&device_, seed, signature, kMostReads), DTOF_OK);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    const std::vector<Line> second = settled_lines(bench_, settings, {middle, lines.end()});
    ASSERT_EQ(bench_.frames().back().lines, second);
    ASSERT_EQ(received_results(bench_, frame++), expected_results(bench_, settings, second, &priors));
    ASSERT_EQ(bench_.get(DTOF_FRAME_COUNT), frame);
    ASSERT_EQ(bench_.get(DTOF_ERROR) & ~DTOF_ERROR_OVERRUN_MASK, 0U);  // the sink is slow in the frames
    ASSERT_EQ(bench_.get(DTOF_LOST_LINES), 0U);
  }
}

TEST_P(SelfTest, IsDeafToASourceThatCannotWait) {
  if (bench_.source_waits()) {
    GTEST_SKIP() << "the source waits";
  }
  CounterRandom random = SelfTest::random(72);
  ASSERT_NO_FATAL_FAILURE(configure(30));
  const std::uint32_t signature = self_test_signature(configuration(), raster(), 30, 5);
  push_lines(bench_, make_lines(configuration(), 20, random));  // during the self-test
  EXPECT_EQ(dtof_self_test(&device_, 5, signature, kMostReads), DTOF_OK);
  EXPECT_GT(bench_.dropped(), 0U);
  EXPECT_EQ(bench_.get(DTOF_ERROR), 0U) << "the sink refused nothing";
  EXPECT_EQ(bench_.frames().back().lines, self_test_lines(configuration(), 30, 5));
}

TEST_P(SelfTest, IsIgnoredDuringAFrameAndWhileWordsWait) {
  CounterRandom random = SelfTest::random(73);
  ASSERT_NO_FATAL_FAILURE(configure(2));
  bench_.sink().blocked = true;
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_SELF_TEST_MASK);
  bench_.clocks(3);
  EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_START_IGNORED_MASK);
  EXPECT_EQ(status() & DTOF_STATUS_SELF_TEST_MASK, 0U);
  EXPECT_EQ(dtof_self_test(&device_, 1, 0, kMostReads), DTOF_BUSY);
  clear();
  // A source that cannot wait delivers when the array has begun to take lines.
  bench_.clocks(bench_.source_waits() ? 0 : 2000);
  for (int acquisition = 0; acquisition < 2; ++acquisition) {
    push_lines(bench_, make_lines(configuration(), 1, random));
    bench_.clocks(bench_.source_waits() ? 0 : 2000);
  }
  if (raster()) {  // the array's frame ends, and its words wait
    ASSERT_NO_FATAL_FAILURE(wait_until_idle());
    EXPECT_EQ(dtof_self_test(&device_, 1, 0, kMostReads), DTOF_BUSY);
    EXPECT_EQ(bench_.get(DTOF_ERROR) & DTOF_ERROR_START_IGNORED_MASK, DTOF_ERROR_START_IGNORED_MASK);
  }
  bench_.sink().blocked = false;
  bench_.wait_for_frames(1);
  clear();
  const std::uint32_t signature = self_test_signature(configuration(), raster(), 2, 9);
  EXPECT_EQ(dtof_self_test(&device_, 9, signature, kMostReads), DTOF_OK);
  EXPECT_EQ(bench_.get(DTOF_ERROR), 0U);
  // START during a self-test is ignored, also while its words are compared.
  begin(9, signature);
  std::uint32_t ignored = 0;
  while (busy()) {
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    ignored += (bench_.get(DTOF_ERROR) & DTOF_ERROR_START_IGNORED_MASK) != 0 ? 1 : 0;
    ASSERT_LT(ignored, kMostClocks);
    if (!bench_.frames().back().self_test) {
      break;  // the self-test ended between the read and the write
    }
  }
  EXPECT_GT(ignored, 0U);
}

TEST_P(SelfTest, EndsWithAnAbortWithoutAVerdict) {
  CounterRandom random = SelfTest::random(74);
  ASSERT_NO_FATAL_FAILURE(configure(6));
  const std::uint32_t signature = self_test_signature(configuration(), raster(), 6, 3);
  ASSERT_EQ(dtof_self_test(&device_, 3, signature, kMostReads), DTOF_OK);
  const std::uint64_t whole = bench_.frames().back().cycles;
  std::uint32_t ended = 0;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    clear();
    begin(3, round % 2 == 0 ? signature : ~signature);
    bench_.clocks(random() % (whole + 40));
    const bool runs = busy();
    bench_.set(DTOF_CONTROL,
               round % 3 == 0 ? DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK : DTOF_CONTROL_ABORT_MASK);
    const bool judged = (status() & DTOF_STATUS_PASSED_MASK) != 0 ||
                        (bench_.get(DTOF_ERROR) & DTOF_ERROR_SELF_TEST_MASK) != 0;
    EXPECT_TRUE(!judged || !runs || whole > 0);
    ended += judged ? 1 : 0;
    bench_.clocks(20);
    EXPECT_FALSE(busy());
    EXPECT_EQ((status() & DTOF_STATUS_PASSED_MASK) != 0, judged && round % 2 == 0);
    EXPECT_EQ((bench_.get(DTOF_ERROR) & DTOF_ERROR_SELF_TEST_MASK) != 0, judged && round % 2 != 0);
    EXPECT_TRUE(bench_.sink().frames().empty());
    EXPECT_TRUE(bench_.sink().current().empty());
  }
  EXPECT_LT(ended, 50U);
  clear();
  EXPECT_EQ(dtof_self_test(&device_, 3, signature, kMostReads), DTOF_OK);
  if (bench_.source_waits()) {  // a frame behind it is whole
    const FrameSettings settings = this->settings(3);
    write_settings(bench_, settings);
    const std::vector<Line> lines = make_lines(configuration(), 3, random);
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    EXPECT_EQ(received_results(bench_, 0), expected_results(bench_, settings, lines));
  }
}

TEST_P(SelfTest, DoesNotMeetTheWatchdogOrContinuousModeOrALateSink) {
  ASSERT_NO_FATAL_FAILURE(configure(5));
  bench_.set(DTOF_WATCHDOG, 2);
  bench_.set(DTOF_RELEASE, 1);   // the earliest shots, if there were any
  bench_.sink().blocked = true;  // as at power-up: nobody takes words
  const std::uint32_t signature = self_test_signature(configuration(), raster(), 5, 77);
  bench_.set(DTOF_SELF_TEST_SEED, 77);
  bench_.set(DTOF_SELF_TEST_EXPECTED, signature);
  bench_.set(DTOF_IRQ_ENABLE, DTOF_IRQ_ENABLE_FRAME_MASK | DTOF_IRQ_ENABLE_ERROR_MASK);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_SELF_TEST_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
  ASSERT_NO_FATAL_FAILURE(wait_until_idle());
  EXPECT_NE(status() & DTOF_STATUS_PASSED_MASK, 0U);
  EXPECT_EQ(bench_.get(DTOF_ERROR), 0U);
  EXPECT_FALSE(bench_.interrupt());
  EXPECT_EQ(bench_.frames().size(), 1U) << "no frame follows by itself";
  bench_.set(DTOF_SELF_TEST_EXPECTED, ~signature);
  bench_.set(DTOF_CONTROL, DTOF_CONTROL_SELF_TEST_MASK | DTOF_CONTROL_START_MASK);
  ASSERT_NO_FATAL_FAILURE(wait_until_idle());
  EXPECT_TRUE(bench_.frames().back().self_test);
  EXPECT_TRUE(bench_.interrupt());
  EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_SELF_TEST_MASK);
}

TEST_P(SelfTest, DoesNotBeginWithIllegalSettings) {
  ASSERT_NO_FATAL_FAILURE(configure(1));
  const std::uint32_t signature = self_test_signature(configuration(), raster(), 1, 1);
  ASSERT_EQ(dtof_self_test(&device_, 1, signature, kMostReads), DTOF_OK);
  bench_.set(DTOF_RELEASE, 0);
  EXPECT_EQ(dtof_self_test(&device_, 1, signature, kMostReads), DTOF_BUSY) << "no verdict";
  EXPECT_EQ(bench_.get(DTOF_ERROR), DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
  EXPECT_EQ(bench_.frames().size(), 1U);
}

// A cell of a memory that keeps its value, found by the signature or by parity. Missed are cells that this
// frame does not use: upper bits of counters, and places of columns that the array does not have.
TEST_P(SelfTest, FailsWithAStuckBitOfAMemory) {
  std::vector<RtlSram> srams = bench_.srams();
  std::erase_if(srams, [](const RtlSram& sram) {
    return sram.path().find("u_line_buffer") != std::string::npos;  // no part of the self-test
  });
  if (srams.empty()) {
    GTEST_SKIP() << "its memories cannot be written";
  }
  CounterRandom random = SelfTest::random(75);
  FrameSettings settings = this->settings(100);
  settings.second_target = true;
  write_settings(bench_, settings);
  const std::uint32_t signature = expected_crc(settings, 1);
  constexpr int kRounds = 60;
  constexpr int kClocks = 20;
  int found = 0;
  int by_signature = 0;
  std::map<std::string, int> found_in;  // by the instance's name
  for (int round = 0; round < kRounds; ++round) {
    RtlSram& sram = srams[static_cast<std::size_t>(round) % srams.size()];
    const int word = pick(random, sram.words());
    const int bit = pick(random, sram.width());
    const bool value = pick(random, 2) == 0;
    clear();
    begin(1, signature);
    while (busy()) {
      for (int i = 0; i < kClocks; ++i) {
        sram.set_bit(word, bit, value);
        bench_.clock();
      }
    }
    const bool failed = (bench_.get(DTOF_ERROR) & DTOF_ERROR_SELF_TEST_MASK) != 0;
    EXPECT_NE(failed, (status() & DTOF_STATUS_PASSED_MASK) != 0);
    const bool damaged = device_.has_parity && (bench_.get(DTOF_ERROR) & DTOF_ERROR_PARITY_MASK) != 0;
    by_signature += failed ? 1 : 0;
    found += failed || damaged ? 1 : 0;
    std::string memory = sram.path();
    memory.erase(0, memory.find("u_subsystem"));
    found_in[memory.substr(0, memory.find('['))] += failed || damaged ? 1 : 0;
  }
  EXPECT_GT(3 * found, kRounds) << found << " of " << kRounds << ", " << by_signature << " by the signature";
  if (device_.has_parity) {
    EXPECT_GT(found, by_signature) << "parity finds cells that the signature does not show";
  }
  for (const auto& [memory, number] : found_in) {
    EXPECT_GT(number, 0) << memory;
  }
  clear();
  EXPECT_EQ(dtof_self_test(&device_, 1, signature, kMostReads), DTOF_OK) << "without the fault";
}

class NoSelfTest : public Subsystem {};

INSTANTIATE_TEST_SUITE_P(All, NoSelfTest, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(NoSelfTest, IsABusError) {
  if ((bench_.get(DTOF_READOUT) & DTOF_READOUT_SELF_TEST_MASK) != 0) {
    GTEST_SKIP() << "it has a self-test";
  }
  EXPECT_TRUE(bench_.write(DTOF_CONTROL, DTOF_CONTROL_SELF_TEST_MASK).error);
  EXPECT_TRUE(bench_.write(DTOF_CONTROL, DTOF_CONTROL_SELF_TEST_MASK | DTOF_CONTROL_START_MASK).error);
  EXPECT_TRUE(bench_.write(DTOF_SELF_TEST_SEED, 1).error);
  EXPECT_TRUE(bench_.write(DTOF_SELF_TEST_EXPECTED, 1).error);
  EXPECT_EQ(bench_.get(DTOF_SELF_TEST_SEED), 0U);
  EXPECT_EQ(bench_.get(DTOF_SELF_TEST_EXPECTED), 0U);
  EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
  EXPECT_TRUE(bench_.frames().empty());
  dtof_device device{};
  EXPECT_FALSE(device.has_self_test);
  EXPECT_EQ(dtof_self_test(&device, 1, 0, 1), DTOF_ARGUMENT);
}

}  // namespace
}  // namespace dtof
