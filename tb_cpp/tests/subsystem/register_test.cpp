// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

INSTANTIATE_TEST_SUITE_P(Registers, Subsystem, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

std::uint32_t field(std::uint32_t value, std::uint32_t mask, int lsb) { return (value & mask) >> lsb; }

TEST_P(Subsystem, SaysWhatItIs) {
  const RtlConfiguration& configuration = bench_.configuration();
  const ReadoutParameters& parameters = configuration.parameters;
  const bool pool = is_pool_readout(parameters.readout);
  EXPECT_EQ(bench_.get(DTOF_ID), DTOF_ID_EXPECTED);
  EXPECT_EQ(bench_.get(DTOF_VERSION) >> DTOF_VERSION_MAJOR_LSB, DTOF_VERSION_MAJOR_EXPECTED);
  const std::uint32_t readout = bench_.get(DTOF_READOUT);
  EXPECT_EQ(field(readout, DTOF_READOUT_SCHEDULE_MASK, DTOF_READOUT_SCHEDULE_LSB), pool ? 1U : 0U);
  EXPECT_EQ(field(readout, DTOF_READOUT_TIME_GATE_MASK, DTOF_READOUT_TIME_GATE_LSB),
            parameters.time_gate ? 1U : 0U);
  EXPECT_EQ(field(readout, DTOF_READOUT_SECOND_TARGET_MASK, DTOF_READOUT_SECOND_TARGET_LSB),
            parameters.pool.second_target ? 1U : 0U);
  EXPECT_EQ(field(readout, DTOF_READOUT_AMPLITUDE_MASK, DTOF_READOUT_AMPLITUDE_LSB),
            parameters.pool.amplitude ? 1U : 0U);
  EXPECT_EQ(field(readout, DTOF_READOUT_PRIOR_MASK, DTOF_READOUT_PRIOR_LSB), parameters.pool.prior ? 1U : 0U);
  EXPECT_EQ(field(readout, DTOF_READOUT_RAW_HISTOGRAM_MASK, DTOF_READOUT_RAW_HISTOGRAM_LSB),
            configuration.raw_histogram ? 1U : 0U);
  EXPECT_EQ(field(readout, DTOF_READOUT_PARITY_MASK, DTOF_READOUT_PARITY_LSB),
            configuration.parity ? 1U : 0U);
  EXPECT_EQ(bench_.get(DTOF_SELF_TEST_SEED), (readout & DTOF_READOUT_SELF_TEST_MASK) != 0 ? 1U : 0U);
  EXPECT_EQ(bench_.get(DTOF_RAW_BINS),
            configuration.raw_histogram ? static_cast<std::uint32_t>(parameters.raw_bins()) : 0U);
  const std::uint32_t size = bench_.get(DTOF_SIZE);
  EXPECT_EQ(field(size, DTOF_SIZE_COLUMNS_MASK, DTOF_SIZE_COLUMNS_LSB),
            static_cast<std::uint32_t>(configuration.sram_num));
  EXPECT_EQ(field(size, DTOF_SIZE_ROWS_MASK, DTOF_SIZE_ROWS_LSB),
            static_cast<std::uint32_t>(configuration.pixels_per_sram));
  const std::uint32_t widths = bench_.get(DTOF_WIDTHS);
  EXPECT_EQ(field(widths, DTOF_WIDTHS_TIMESTAMP_MASK, DTOF_WIDTHS_TIMESTAMP_LSB),
            static_cast<std::uint32_t>(parameters.np));
  EXPECT_EQ(field(widths, DTOF_WIDTHS_FRACTION_MASK, DTOF_WIDTHS_FRACTION_LSB),
            static_cast<std::uint32_t>(parameters.fraction_bits));
  EXPECT_EQ(field(widths, DTOF_WIDTHS_ACQUISITIONS_MASK, DTOF_WIDTHS_ACQUISITIONS_LSB), 16U);
  EXPECT_EQ(bench_.get(DTOF_LINES) & DTOF_LINES_ACQUISITION_MASK, bench_.acquisition_lines());
  EXPECT_EQ(bench_.get(DTOF_SLOTS), static_cast<std::uint32_t>(parameters.slots));
  const auto number = [](int value) { return static_cast<std::uint32_t>(value); };
  EXPECT_EQ(bench_.get(DTOF_HISTOGRAM),
            number(parameters.count_width) << DTOF_HISTOGRAM_COUNT_WIDTH_LSB |
                number(parameters.nb) << DTOF_HISTOGRAM_NB_LSB |
                (parameters.window_centred ? DTOF_HISTOGRAM_WINDOW_CENTRED_MASK : 0U));
  EXPECT_EQ(bench_.get(DTOF_POINTER),
            number(parameters.pointer_step) << DTOF_POINTER_STEP_LSB |
                (parameters.readout == Readout::kHisPointer ? number(parameters.guard) : 0U)
                    << DTOF_POINTER_GUARD_LSB);
  const PoolPointerParameters& of_pool = parameters.pool;
  EXPECT_EQ(bench_.get(DTOF_POOL), !pool ? 0U
                                         : number(of_pool.group_size) << DTOF_POOL_GROUP_SIZE_LSB |
                                               number(of_pool.labels) << DTOF_POOL_LABELS_LSB |
                                               number(of_pool.score_bits) << DTOF_POOL_SCORE_BITS_LSB |
                                               number(of_pool.offset_bits) << DTOF_POOL_OFFSET_BITS_LSB |
                                               number(of_pool.count_bits) << DTOF_POOL_ADVANTAGE_WIDTH_LSB |
                                               number(of_pool.pointer_shift) << DTOF_POOL_POINTER_SHIFT_LSB |
                                               number(of_pool.cell_shift) << DTOF_POOL_CELL_SHIFT_LSB);
  EXPECT_EQ(bench_.get(DTOF_ENGINES), !pool ? 0U
                                            : number(of_pool.engine_columns) << DTOF_ENGINES_COLUMNS_LSB |
                                                  (of_pool.rival_moves ? DTOF_ENGINES_RIVAL_MOVES_MASK : 0U));
  const PoolPointerParameters recommended = PoolPointerParameters::defaults(parameters.readout);
  EXPECT_EQ(bench_.get(DTOF_SHARES), !pool ? 0U
                                           : number(recommended.coarse_share) << DTOF_SHARES_COARSE_LSB |
                                                 number(recommended.track_share) << DTOF_SHARES_TRACK_LSB);
  EXPECT_EQ(bench_.get(DTOF_WARNING), 0U);
  EXPECT_EQ(bench_.get(DTOF_STATUS), 0U);
  EXPECT_EQ(bench_.get(DTOF_OUTPUT), pool ? DTOF_OUTPUT_SMOOTH_MASK : 0U);
  EXPECT_EQ(bench_.get(DTOF_SHOT), 1U << DTOF_SHOT_UNIT_LSB) << "without a delay";
  EXPECT_EQ(bench_.get(DTOF_GATE),
            parameters.time_gate ? number(parameters.no_detection()) << DTOF_GATE_END_LSB : 0U)
      << "all codes";
  EXPECT_EQ(bench_.get(DTOF_SHOT_SEED), 1U);
  EXPECT_EQ(bench_.get(DTOF_SHOT_STATE), 1U);
  const auto lines = static_cast<std::uint32_t>(bench_.acquisition_lines());
  EXPECT_EQ(bench_.get(DTOF_RELEASE),
            bench_.clock_waits() ? lines : std::min(lines, bench_.get(DTOF_LINES) >> DTOF_LINES_BUFFER_LSB));
}

// Bits of a setting that the configuration has.
std::uint32_t existing(const RtlConfiguration& configuration, std::uint32_t offset, bool self_test) {
  const ReadoutParameters& parameters = configuration.parameters;
  const bool pool = is_pool_readout(parameters.readout);
  const auto codes = static_cast<std::uint32_t>(parameters.no_detection());
  if (offset == DTOF_CONTROL) {
    return DTOF_CONTROL_CONTINUOUS_MASK;
  }
  if (offset == DTOF_IRQ_ENABLE) {
    return DTOF_IRQ_ENABLE_FRAME_MASK | DTOF_IRQ_ENABLE_ERROR_MASK;
  }
  if (offset == DTOF_WATCHDOG) {
    return DTOF_WATCHDOG_CLOCKS_MASK;
  }
  if (offset == DTOF_ACQUISITIONS || offset == DTOF_RELEASE || offset == DTOF_SETTLE) {
    return 0xFFFF;
  }
  if (offset == DTOF_SHOT) {
    return DTOF_SHOT_BITS_MASK | DTOF_SHOT_UNIT_MASK;
  }
  if (offset == DTOF_SHOT_SEED) {
    return DTOF_SHOT_SEED_VALUE_MASK;
  }
  if (offset == DTOF_SELF_TEST_SEED || offset == DTOF_SELF_TEST_EXPECTED) {
    return self_test ? 0xFFFFFFFFU : 0;
  }
  if (offset == DTOF_OUTPUT) {
    return existing_outputs(configuration);
  }
  if (offset == DTOF_RAW_ROWS) {
    return configuration.raw_histogram ? DTOF_RAW_ROWS_FIRST_MASK | DTOF_RAW_ROWS_LAST_MASK : 0;
  }
  if (offset == DTOF_COARSE_END || offset == DTOF_TRACK_END) {
    return pool ? 0xFFFF : 0;
  }
  if (offset >= DTOF_TEMPLATE && offset < DTOF_TEMPLATE + 4 * DTOF_TEMPLATE_NUMBER) {
    return pool ? 0xFFFFFFFFU : 0;
  }
  if (offset == DTOF_GATE) {
    return parameters.time_gate ? codes << DTOF_GATE_BEGIN_LSB | codes << DTOF_GATE_END_LSB : 0;
  }
  const std::uint32_t first = (offset - DTOF_COLUMN_ENABLE) * 8;
  const auto columns = static_cast<std::uint32_t>(configuration.sram_num);
  if (offset < DTOF_COLUMN_ENABLE || columns <= first) {
    return 0;
  }
  return columns - first >= 32 ? 0xFFFFFFFFU : (1U << (columns - first)) - 1;
}

TEST_P(Subsystem, SettingsKeepWhatIsWrittenByteByByte) {
  CounterRandom random = this->random(1);
  std::vector<std::uint32_t> offsets = {
      DTOF_IRQ_ENABLE, DTOF_ACQUISITIONS, DTOF_COARSE_END,     DTOF_TRACK_END,         DTOF_GATE,
      DTOF_RELEASE,    DTOF_OUTPUT,       DTOF_RAW_ROWS,       DTOF_WATCHDOG,          DTOF_SHOT,
      DTOF_SHOT_SEED,  DTOF_SETTLE,       DTOF_SELF_TEST_SEED, DTOF_SELF_TEST_EXPECTED};
  const bool self_test = (bench_.get(DTOF_READOUT) & DTOF_READOUT_SELF_TEST_MASK) != 0;
  for (std::uint32_t i = 0; i < DTOF_COLUMN_ENABLE_NUMBER; ++i) {
    offsets.push_back(DTOF_COLUMN_ENABLE + 4 * i);
  }
  for (std::uint32_t i = 0; i < DTOF_TEMPLATE_NUMBER; ++i) {
    offsets.push_back(DTOF_TEMPLATE + 4 * i);
  }
  std::vector<std::uint32_t> values;
  values.reserve(offsets.size());
  for (const std::uint32_t offset : offsets) {
    values.push_back(bench_.get(offset));
  }
  const std::vector<std::uint32_t> behind_reset = values;
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    const std::size_t i = random() % offsets.size();
    const std::uint32_t there = existing(bench_.configuration(), offsets[i], self_test);
    const std::uint32_t data = round % 4 == 0 ? random() : random() & there;
    const auto strobe = static_cast<std::uint8_t>(random() % 16);
    std::uint32_t mask = 0;
    for (unsigned byte = 0; byte < 4; ++byte) {
      mask |= ((strobe >> byte) & 1U) != 0 ? 0xFFU << (8 * byte) : 0U;
    }
    const bool wrong = there == 0 || (data & mask & ~there) != 0;
    refused += wrong ? 1 : 0;
    mask &= there;
    values[i] = wrong ? values[i] : (values[i] & ~mask) | (data & mask);
    EXPECT_EQ(bench_.write(offsets[i], data, strobe).error, wrong) << "a bit that is not there";
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      ASSERT_EQ(bench_.get(offsets[k]), values[k])
          << "register " << offsets[k] << " after writing " << offsets[i];
    }
  }
  EXPECT_GT(refused, 20);
  bench_.reset();
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    EXPECT_EQ(bench_.get(offsets[k]), behind_reset[k]) << "register " << offsets[k] << " behind a reset";
  }
}

// What dtof_registers.h and the maps of driver/maps say of a value behind a reset.
TEST_P(Subsystem, ReadsBehindAResetWhatTheMapsSay) {
  for (int round = 0; round < 2; ++round) {
    std::size_t compared = 0;
    const auto compare = [&](std::uint32_t offset, std::uint32_t number, std::uint32_t value,
                             std::uint32_t mask) {
      for (std::uint32_t i = 0; i < number; ++i) {
        EXPECT_EQ(bench_.get(offset + 4 * i) & mask, value) << "register " << offset + 4 * i;
      }
      compared += mask != 0 ? 1 : 0;
    };
#define COMPARE(OFFSET, NUMBER, VALUE, MASK) compare(OFFSET, NUMBER, VALUE, MASK);
    DTOF_FOR_EACH_REGISTER(COMPARE)
#undef COMPARE
    EXPECT_GT(compared, 25U);
    bench_.set(DTOF_ACQUISITIONS, 3);
    bench_.set(DTOF_WATCHDOG, 5);
    bench_.set(DTOF_SHOT, 0x203);
    bench_.set(DTOF_SHOT_SEED, 77);
    bench_.set(DTOF_SETTLE, 9);
    bench_.reset();
  }
}

// A reset of a single clock, the shortest, in any clock of an access. The bench refuses a response without a
// request.
TEST_P(Subsystem, ForgetsAnAccessInWhichAResetComes) {
  CounterRandom random = this->random(6);
  const std::uint32_t behind_reset = bench_.get(DTOF_ACQUISITIONS);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(testing::Message() << "round " << round);
    if (round % 2 == 0) {
      bench_.begin_read(DTOF_ID);
    } else {
      bench_.begin_write(DTOF_ACQUISITIONS, behind_reset + 2);
    }
    bench_.clocks(random() % 8);
    bench_.reset(true, 1);
    bench_.clocks(5);
    if (round % 4 < 2) {
      ASSERT_EQ(bench_.get(DTOF_ACQUISITIONS), behind_reset);
    }
    bench_.set(DTOF_ACQUISITIONS, behind_reset + 1);
    ASSERT_EQ(bench_.get(DTOF_ACQUISITIONS), behind_reset + 1);
  }
}

TEST_P(Subsystem, RefusesWhatIsNotThere) {
  for (const std::uint32_t offset : {0x034U, 0x03CU, 0x150U, 0x800U, 0xFFCU}) {
    EXPECT_TRUE(bench_.read(offset).error) << offset;
    EXPECT_TRUE(bench_.write(offset, 0).error) << offset;
  }
  for (const std::uint32_t offset :
       {DTOF_ID, DTOF_VERSION, DTOF_SIZE, DTOF_HISTOGRAM, DTOF_POINTER, DTOF_POOL, DTOF_ENGINES, DTOF_SHARES,
        DTOF_STATUS, DTOF_FRAME_COUNT, DTOF_FRAME_CYCLES, DTOF_LOST_LINES, DTOF_LOST_ACQUISITIONS,
        DTOF_SHOT_STATE, DTOF_FRAME_CRC, DTOF_PARITY_ERRORS}) {
    const std::uint32_t value = bench_.get(offset);
    EXPECT_TRUE(bench_.write(offset, ~value).error) << offset;
    EXPECT_EQ(bench_.get(offset), value) << offset;
  }
}

}  // namespace
}  // namespace dtof
