// SPDX-License-Identifier: Apache-2.0
// The C driver alone, on a bus whose registers are a map: what it refuses and how it fails.
#include <gtest/gtest.h>

#include <array>
#include <boost/crc.hpp>
#include <cstdint>
#include <map>
#include <vector>

#include "dtof.h"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

// Registers without hardware behind them.
struct Memory {
  std::map<std::uint32_t, std::uint32_t> values = {
      {DTOF_ID, DTOF_ID_EXPECTED},
      {DTOF_VERSION, DTOF_VERSION_MAJOR_EXPECTED << 16U | DTOF_VERSION_MINOR_EXPECTED},
      {DTOF_SIZE, 3U << 16U | 2U}};
  int accesses_left = 1000;
};

bool memory_read(void* context, std::uint32_t offset, std::uint32_t* value) {
  auto& memory = *static_cast<Memory*>(context);
  *value = memory.values[offset];
  return memory.accesses_left-- > 0;
}

bool memory_write(void* context, std::uint32_t offset, std::uint32_t value) {
  auto& memory = *static_cast<Memory*>(context);
  memory.values[offset] = value;
  return memory.accesses_left-- > 0;
}

TEST(DriverAlone, ReportsWhatItDoesNotFind) {
  Memory memory;
  dtof_device device{};
  const dtof_bus bus = {&memory, memory_read, memory_write};
  EXPECT_EQ(dtof_probe(&device, bus), DTOF_OK);
  memory.values[DTOF_VERSION] = DTOF_VERSION_MAJOR_EXPECTED << 16U | (DTOF_VERSION_MINOR_EXPECTED + 1);
  EXPECT_EQ(dtof_probe(&device, bus), DTOF_OK) << "more registers do no harm";
  memory.values[DTOF_VERSION] = DTOF_VERSION_MAJOR_EXPECTED << 16U | (DTOF_VERSION_MINOR_EXPECTED - 1);
  EXPECT_EQ(dtof_probe(&device, bus), DTOF_VERSION_UNKNOWN) << "registers that the driver reads are missing";
  memory.values[DTOF_VERSION] = (DTOF_VERSION_MAJOR_EXPECTED + 1) << 16U | DTOF_VERSION_MINOR_EXPECTED;
  EXPECT_EQ(dtof_probe(&device, bus), DTOF_VERSION_UNKNOWN);
  memory.values[DTOF_ID] = 0xFFFFFFFF;
  EXPECT_EQ(dtof_probe(&device, bus), DTOF_NOT_FOUND);
}

// A self-test that passes, during which a word had a wrong parity.
TEST(DriverAlone, FailsASelfTestWithDamagedWords) {
  Memory memory;
  memory.values[DTOF_STATUS] = DTOF_STATUS_PASSED_MASK;
  const dtof_bus bus = {&memory, memory_read, [](void* context, std::uint32_t offset, std::uint32_t value) {
                          auto& values = static_cast<Memory*>(context)->values;
                          if (offset == DTOF_ERROR) {
                            values[offset] &= ~value;
                          } else if (offset == DTOF_CONTROL) {
                            values[DTOF_ERROR] |= DTOF_ERROR_PARITY_MASK;
                          }
                          return true;
                        }};
  for (const std::uint32_t before : {0U, DTOF_ERROR_SELF_TEST_MASK | DTOF_ERROR_PARITY_MASK}) {
    for (const bool has_parity : {false, true}) {
      memory.values[DTOF_READOUT] =
          DTOF_READOUT_SELF_TEST_MASK | (has_parity ? DTOF_READOUT_PARITY_MASK : 0U);
      memory.values[DTOF_ERROR] = before;
      dtof_device device{};
      ASSERT_EQ(dtof_probe(&device, bus), DTOF_OK);
      EXPECT_EQ(dtof_self_test(&device, 1, 2, 10), has_parity ? DTOF_FAILED : DTOF_OK);
    }
  }
}

TEST(DriverAlone, TakesTheScheduleFromTheRegistersAtAnyNumberOfAcquisitions) {
  for (const Readout readout : {Readout::kPoolPointer, Readout::kPoolPointerLean}) {
    const PoolPointerParameters pool = PoolPointerParameters::defaults(readout);
    Memory memory;
    memory.accesses_left = 1000000;
    memory.values[DTOF_READOUT] = DTOF_READOUT_SCHEDULE_MASK;
    memory.values[DTOF_WIDTHS] = 10U << DTOF_WIDTHS_TIMESTAMP_LSB | 24U << DTOF_WIDTHS_ACQUISITIONS_LSB;
    memory.values[DTOF_SHARES] = static_cast<std::uint32_t>(pool.coarse_share) << DTOF_SHARES_COARSE_LSB |
                                 static_cast<std::uint32_t>(pool.track_share) << DTOF_SHARES_TRACK_LSB;
    dtof_device device{};
    ASSERT_EQ(dtof_probe(&device, {&memory, memory_read, memory_write}), DTOF_OK);
    const auto expect_the_schedule = [&](std::uint32_t acquisitions) {
      const dtof_settings settings = dtof_default_settings(&device, acquisitions);
      ASSERT_EQ(dtof_configure(&device, &settings), DTOF_OK);
      const PoolSchedule schedule(acquisitions, pool);
      ASSERT_EQ(memory.values[DTOF_ACQUISITIONS], acquisitions);
      ASSERT_EQ(memory.values[DTOF_COARSE_END], schedule.coarse_end);
      ASSERT_EQ(memory.values[DTOF_TRACK_END], schedule.track_end);
      ASSERT_LE(schedule.coarse_end, schedule.track_end);
      ASSERT_LE(schedule.track_end, acquisitions);
    };
    for (std::uint32_t acquisitions = 0; acquisitions < 65536; ++acquisitions) {
      ASSERT_NO_FATAL_FAILURE(expect_the_schedule(acquisitions));
    }
    expect_the_schedule((1U << 24U) - 1);  // the most that any ACQ_WIDTH takes
  }
}

TEST(DriverAlone, ReportsABusThatFails) {
  Memory memory;
  dtof_device device{};
  const dtof_bus bus = {&memory, memory_read, memory_write};
  memory.accesses_left = 3;
  EXPECT_EQ(dtof_probe(&device, bus), DTOF_BUS);
  memory.accesses_left = 1000;
  ASSERT_EQ(dtof_probe(&device, bus), DTOF_OK);
  memory.accesses_left = 0;
  std::uint32_t value = 0;
  bool busy = false;
  dtof_settings settings = dtof_default_settings(&device, 0);
  EXPECT_EQ(dtof_configure(&device, &settings), DTOF_BUS);
  EXPECT_EQ(dtof_enable_columns(&device, &value), DTOF_BUS);
  EXPECT_EQ(dtof_start(&device, false), DTOF_BUS);
  EXPECT_EQ(dtof_busy(&device, &busy), DTOF_BUS);
  EXPECT_EQ(dtof_frames(&device, &value, &value), DTOF_BUS);
  EXPECT_EQ(dtof_check_frame(&device, nullptr, 0, &value), DTOF_BUS);
  EXPECT_EQ(dtof_seed_shots(&device, 1), DTOF_BUS);
  device.has_self_test = true;
  EXPECT_EQ(dtof_self_test(&device, 1, 0, 1), DTOF_BUS);
  EXPECT_EQ(dtof_read_shot_state(&device, &value), DTOF_BUS);
  EXPECT_EQ(dtof_take_errors(&device, &value), DTOF_BUS);
  EXPECT_EQ(dtof_take_warnings(&device, &value), DTOF_BUS);
}

TEST(DriverAlone, ComputesTheChecksumOfZlib) {
  // "12345678" and its CRC-32, and the first of it twice.
  const std::array<std::uint64_t, 2> words = {0x3837363534333231, 0x3837363534333231};
  EXPECT_EQ(dtof_crc(words.data(), 0), 0U);
  EXPECT_EQ(dtof_crc(words.data(), 1), 0x9AE0DAAFU);
  CounterRandom random{1, 2, 3, 4};
  std::vector<std::uint64_t> many(1000);
  for (std::size_t i = 0; i < many.size(); ++i) {
    many[i] = std::uint64_t{random()} << 32U | random();
    boost::crc_32_type expected;
    for (std::size_t k = 0; k <= i; ++k) {
      for (unsigned byte = 0; byte < 8; ++byte) {
        expected.process_byte(static_cast<unsigned char>(many[k] >> (8 * byte)));
      }
    }
    ASSERT_EQ(dtof_crc(many.data(), i + 1), expected.checksum());
  }
}

TEST(DriverAlone, ChecksAFrameAgainstItsOwnChecksumAlone) {
  // A frame that ends between two reads: the count differs, and the checksum may be either's.
  struct Counting {
    std::uint32_t frames = 0;
    std::uint32_t step = 1;
  } counting;
  dtof_device device{};
  device.bus = {&counting,
                [](void* context, std::uint32_t offset, std::uint32_t* value) {
                  auto& device_state = *static_cast<Counting*>(context);
                  *value = offset == DTOF_FRAME_COUNT ? device_state.frames += device_state.step : 0;
                  return true;
                },
                nullptr};
  std::uint32_t frame = 0;
  const std::uint64_t aborted = DTOF_RESULT_ABORTED_MASK;
  EXPECT_EQ(dtof_check_frame(&device, nullptr, 0, &frame), DTOF_BUSY);
  counting.step = 0;
  EXPECT_EQ(dtof_check_frame(&device, nullptr, 0, &frame), DTOF_OK) << "the checksum of nothing";
  EXPECT_EQ(dtof_check_frame(&device, &aborted, 1, &frame), DTOF_ABORTED);
}

TEST(DriverAlone, GivesUpWhenAnAbortDoesNothing) {
  Memory memory;
  dtof_device device{};
  ASSERT_EQ(dtof_probe(&device, {&memory, memory_read, memory_write}), DTOF_OK);
  memory.values[DTOF_STATUS] = DTOF_STATUS_BUSY_MASK;
  EXPECT_EQ(dtof_abort(&device, false), DTOF_BUSY);
  EXPECT_EQ(memory.values[DTOF_CONTROL], DTOF_CONTROL_ABORT_MASK);
  EXPECT_EQ(dtof_recover(&device), DTOF_BUSY);
  EXPECT_EQ(memory.values[DTOF_CONTROL], DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK);
  memory.values[DTOF_STATUS] = 0;
  EXPECT_EQ(dtof_recover(&device), DTOF_OK);
  dtof_state state{};
  memory.accesses_left = 0;
  EXPECT_EQ(dtof_abort(&device, false), DTOF_BUS);
  EXPECT_EQ(dtof_recover(&device), DTOF_BUS);
  EXPECT_EQ(dtof_read_state(&device, &state), DTOF_BUS);
  EXPECT_EQ(dtof_commit(&device), DTOF_BUS);
  EXPECT_EQ(dtof_set_watchdog(&device, 1), DTOF_BUS);
}

TEST(DriverAlone, ReportsAnAbortedFrame) {
  Memory memory;
  dtof_device device{};
  ASSERT_EQ(dtof_probe(&device, {&memory, memory_read, memory_write}), DTOF_OK);  // 2 columns of 3 rows
  const std::vector<std::uint64_t> words = {0, 1, DTOF_RESULT_ABORTED_MASK};
  const std::vector<std::uint64_t> and_next = {0, DTOF_RESULT_ABORTED_MASK, 0, 0, 0, 0};
  std::vector<dtof_result> results(6);
  EXPECT_EQ(dtof_unpack(&device, words[2], results.data()), DTOF_ABORTED);
  EXPECT_EQ(dtof_unpack_frame(&device, words.data(), words.size(), results.data()), DTOF_ABORTED);
  EXPECT_EQ(dtof_unpack_frame(&device, words.data(), 2, results.data()), DTOF_STREAM);
  EXPECT_EQ(dtof_unpack_frame(&device, and_next.data(), and_next.size(), results.data()), DTOF_ABORTED)
      << "words of the next frame after it";
}

TEST(DriverAlone, ReportsAnIncompleteFrame) {
  Memory memory;
  dtof_device device{};
  ASSERT_EQ(dtof_probe(&device, {&memory, memory_read, memory_write}), DTOF_OK);  // 2 columns of 3 rows
  std::vector<std::uint64_t> words;
  for (std::uint64_t row = 0; row < 3; ++row) {
    for (std::uint64_t column = 0; column < 2; ++column) {
      words.push_back(row << DTOF_RESULT_ROW_LSB | column << DTOF_RESULT_COLUMN_LSB | (10 * row + column));
    }
  }
  std::swap(words[0], words[5]);
  std::vector<dtof_result> results(words.size());
  ASSERT_EQ(dtof_unpack_frame(&device, words.data(), words.size(), results.data()), DTOF_OK);
  EXPECT_EQ(results[5].position, 21);
  EXPECT_EQ(dtof_unpack_frame(&device, words.data(), words.size() - 1, results.data()), DTOF_STREAM);
  std::vector<std::uint64_t> twice = words;
  twice[1] = twice[2];
  EXPECT_EQ(dtof_unpack_frame(&device, twice.data(), twice.size(), results.data()), DTOF_STREAM);
  words[3] = std::uint64_t{3} << DTOF_RESULT_ROW_LSB;
  EXPECT_EQ(dtof_unpack_frame(&device, words.data(), words.size(), results.data()), DTOF_STREAM);
}

TEST(DriverAlone, TakesASecondTargetOfEveryPixelOrOfNone) {
  Memory memory;
  dtof_device device{};
  ASSERT_EQ(dtof_probe(&device, {&memory, memory_read, memory_write}), DTOF_OK);  // 2 columns of 3 rows
  std::vector<std::uint64_t> words;
  for (std::uint64_t pixel = 0; pixel < 6; ++pixel) {
    const std::uint64_t place = pixel / 2 << DTOF_RESULT_ROW_LSB | pixel % 2 << DTOF_RESULT_COLUMN_LSB;
    words.push_back(place | (10 + pixel));
    words.push_back(place | DTOF_RESULT_SECOND_MASK | (20 + pixel));
  }
  std::vector<dtof_result> results(6);
  ASSERT_EQ(dtof_unpack_frame(&device, words.data(), words.size(), results.data()), DTOF_OK);
  EXPECT_EQ(results[4].position, 14);
  EXPECT_TRUE(results[4].has_second);
  EXPECT_EQ(results[4].second_position, 24);
  const auto refused = [&](auto change) {
    std::vector<std::uint64_t> changed = words;
    change(changed);
    return dtof_unpack_frame(&device, changed.data(), changed.size(), results.data()) == DTOF_STREAM;
  };
  EXPECT_TRUE(refused([](auto& changed) { changed.resize(6); })) << "half a frame";
  EXPECT_TRUE(refused([](auto& changed) { changed.pop_back(); }));
  EXPECT_TRUE(refused([](auto& changed) { std::swap(changed[0], changed[1]); })) << "no first before it";
  EXPECT_TRUE(refused([](auto& changed) { std::swap(changed[1], changed[3]); })) << "another pixel's";
  EXPECT_TRUE(refused([](auto& changed) { changed[1] = changed[0]; })) << "no second";
}

TEST(DriverAlone, FollowsTheOrderOfEngines) {
  for (const auto& [rows, columns, of_engine] :
       {std::array{3, 7, 3}, std::array{2, 6, 3}, std::array{4, 2, 5}, std::array{1, 1, 34},
        std::array{160, 200, 34}}) {
    RtlConfiguration configuration;
    configuration.parameters.readout = Readout::kPoolPointer;
    configuration.parameters.pool.engine_columns = of_engine;
    configuration.pixels_per_sram = rows;
    configuration.sram_num = columns;
    dtof_device device{};
    device.has_schedule = true;
    device.rows = static_cast<std::uint16_t>(rows);
    device.columns = static_cast<std::uint16_t>(columns);
    device.engine_columns = static_cast<std::uint16_t>(of_engine);
    std::size_t index = 0;
    for (const ResultAddress& pixel : configuration.result_order()) {
      std::uint16_t row = 0;
      std::uint16_t column = 0;
      ASSERT_EQ(dtof_pixel_at(&device, index++, &row, &column), DTOF_OK);
      ASSERT_EQ(std::pair(int{row}, int{column}), std::pair(pixel.row, pixel.column));
    }
  }
}

TEST(DriverAlone, TakesShortFramesThatAreWhole) {
  dtof_device device{};
  const auto result = [](std::uint64_t position) { return DTOF_SHORT_RESULT_VALID_MASK | position; };
  const std::uint64_t second = DTOF_SHORT_RESULT_SECOND_MASK;
  const std::uint64_t aborted = DTOF_SHORT_RESULT_ABORTED_MASK;
  std::vector<dtof_result> results(3);
  const auto unpack = [&](const std::vector<std::uint64_t>& words) {
    return dtof_unpack_short_frame(&device, words.data(), words.size(), results.data());
  };
  device.columns = 3;
  device.rows = 1;
  ASSERT_EQ(unpack({result(10) | result(11) << 32U, result(12)}), DTOF_OK);
  EXPECT_EQ(results[1].position, 11);
  EXPECT_EQ(results[2].column, 2);
  EXPECT_FALSE(results[2].has_second);
  EXPECT_EQ(unpack({}), DTOF_STREAM);
  EXPECT_EQ(unpack({result(10) | result(11) << 32U}), DTOF_STREAM) << "half a frame";
  EXPECT_EQ(unpack({result(10) | result(11) << 32U, result(12) | result(13) << 32U}), DTOF_STREAM)
      << "a result too many";
  EXPECT_EQ(unpack({result(10), result(12)}), DTOF_STREAM) << "a padding in the middle";
  EXPECT_EQ(unpack({result(10) | result(11) << 32U, result(12) | second}), DTOF_STREAM);
  EXPECT_EQ(unpack({result(10) | result(11) << 32U, aborted}), DTOF_ABORTED);
  EXPECT_EQ(unpack({result(10) | aborted << 32U}), DTOF_ABORTED);
  EXPECT_EQ(unpack({result(10) | aborted << 32U, result(12)}), DTOF_ABORTED)
      << "a word of the next frame after it";
  ASSERT_EQ(unpack({result(10) | (second | result(20)) << 32U, result(11) | (second | result(21)) << 32U,
                    result(12) | (second | result(22)) << 32U}),
            DTOF_OK);
  EXPECT_EQ(results[2].position, 12);
  EXPECT_TRUE(results[2].has_second);
  EXPECT_EQ(results[2].second_position, 22);
  EXPECT_EQ(unpack({result(10) | (second | result(20)) << 32U, result(11) | result(12) << 32U}), DTOF_STREAM);
  device.columns = 1;
  EXPECT_EQ(unpack({result(10)}), DTOF_OK);
  EXPECT_FALSE(results[0].has_second);
  EXPECT_EQ(unpack({result(10) | (second | result(20)) << 32U}), DTOF_OK);
  EXPECT_TRUE(results[0].has_second);
  std::uint32_t frame = 0;
  EXPECT_EQ(dtof_check_frame(&device, &aborted, 1, &frame), DTOF_ABORTED);
}

TEST(DriverAlone, TakesAmplitudesOfWholeFrames) {
  dtof_device device{};
  device.columns = 3;
  device.rows = 1;
  device.has_schedule = true;
  device.engine_columns = 2;  // columns 0, 2, 1
  const auto result = [](std::uint64_t position, std::uint64_t amplitude, std::uint64_t ambient) {
    return DTOF_RESULT_VALID_MASK | ambient << 44U | amplitude << 32U | std::uint64_t{7} << 16U | position;
  };
  std::vector<dtof_result> results(3);
  const auto unpack = [&](const std::vector<std::uint64_t>& words) {
    return dtof_unpack_amplitude_frame(&device, words.data(), words.size(), results.data());
  };
  const std::vector<std::uint64_t> words = {result(10, 688, 39), result(11, 0, 0), result(12, 4095, 4094)};
  ASSERT_EQ(unpack(words), DTOF_OK);
  EXPECT_EQ(results[0].amplitude, 688);
  EXPECT_EQ(results[0].ambient, 39);
  EXPECT_EQ(results[2].position, 11);
  EXPECT_EQ(results[2].column, 2);
  EXPECT_TRUE(results[2].has_amplitude);
  EXPECT_EQ(results[1].amplitude, 4095);
  EXPECT_EQ(results[1].ambient, 4094);
  EXPECT_EQ(results[1].confidence, 7);
  EXPECT_EQ(unpack({words[0], words[1]}), DTOF_STREAM) << "not whole";
  EXPECT_EQ(unpack({}), DTOF_STREAM);
  EXPECT_EQ(unpack({words[0], DTOF_RESULT_ABORTED_MASK}), DTOF_ABORTED);
  EXPECT_EQ(unpack({words[0], DTOF_RESULT_ABORTED_MASK, words[0]}), DTOF_ABORTED)
      << "a word of the next frame after it";
  EXPECT_EQ(unpack({words[0], words[1], words[2] | DTOF_RESULT_RAW_MASK}), DTOF_STREAM) << "a raw word";
  EXPECT_EQ(unpack({words[0], words[1], 0}), DTOF_STREAM) << "a word that never came";
  EXPECT_EQ(unpack({0, 0, 0}), DTOF_STREAM) << "memory that no word was written to";
  EXPECT_EQ(unpack({words[0], words[1] | DTOF_RESULT_SECOND_MASK, words[2]}), DTOF_STREAM)
      << "a second target of one pixel";
  const auto second = [&](std::size_t i) { return DTOF_RESULT_SECOND_MASK | (words[i] + 10); };
  std::vector<std::uint64_t> both = {words[0], second(0), words[1], second(1), words[2], second(2)};
  ASSERT_EQ(unpack(both), DTOF_OK);
  EXPECT_EQ(results[1].second_position, 22);
  EXPECT_EQ(dtof_second(&results[1]).amplitude, 4095);
  both[3] ^= std::uint64_t{1} << 32U;
  EXPECT_EQ(unpack(both), DTOF_STREAM) << "another pixel's amplitude";
  both[3] ^= std::uint64_t{1} << 32U | std::uint64_t{1} << 44U;
  EXPECT_EQ(unpack(both), DTOF_STREAM) << "another pixel's ambient";
  // Other words have none.
  ASSERT_EQ(dtof_unpack_short(DTOF_SHORT_RESULT_VALID_MASK, results.data()), DTOF_OK);
  EXPECT_FALSE(results[0].has_amplitude);
  EXPECT_EQ(results[0].amplitude, 0);
  ASSERT_EQ(dtof_unpack(&device, 10, results.data() + 1), DTOF_OK);
  EXPECT_FALSE(results[1].has_amplitude);
  EXPECT_EQ(results[1].ambient, 0);
}

TEST(DriverAlone, ATableOfOnePointIsThatDistance) {
  const dtof_device device{};
  const dtof_result result{};
  const dtof_point point = {7.0, 1234.0};
  EXPECT_EQ(dtof_distance_mm(&device, &result, &point, 1), 1234.0);
}

}  // namespace
}  // namespace dtof
