// SPDX-License-Identifier: Apache-2.0
// The C driver on the Verilated subsystem, and alone on a bus that lies.
#include <gtest/gtest.h>

#include <array>
#include <boost/crc.hpp>
#include <map>

#include "dtof.h"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/lookup_table.hpp"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

bool bench_read(void* context, std::uint32_t offset, std::uint32_t* value) {
  const BusResponse response = static_cast<SubsystemBench*>(context)->read(offset);
  *value = response.data;
  return !response.error;
}

bool bench_write(void* context, std::uint32_t offset, std::uint32_t value) {
  return !static_cast<SubsystemBench*>(context)->write(offset, value).error;
}

class Driver : public Subsystem {
 protected:
  void SetUp() override {
    Subsystem::SetUp();
    ASSERT_EQ(dtof_probe(&device_, {&bench_, bench_read, bench_write}), DTOF_OK);
  }

  dtof_device device_{};
};

INSTANTIATE_TEST_SUITE_P(All, Driver, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(Driver, FindsWhatIsThere) {
  const RtlConfiguration& configuration = bench_.configuration();
  EXPECT_EQ(device_.columns, configuration.sram_num);
  EXPECT_EQ(device_.rows, configuration.pixels_per_sram);
  EXPECT_EQ(device_.slots, configuration.parameters.slots);
  EXPECT_EQ(device_.timestamp_bits, configuration.parameters.np);
  EXPECT_EQ(device_.fraction_bits, configuration.parameters.fraction_bits);
  EXPECT_EQ(device_.acquisition_bits, 16);
  EXPECT_EQ(device_.acquisition_lines, bench_.acquisition_lines());
  EXPECT_EQ(device_.has_schedule, is_pool_readout(configuration.parameters.readout));
  EXPECT_EQ(device_.has_gate, configuration.parameters.time_gate.has_value());
  EXPECT_EQ(device_.has_second_target, configuration.parameters.pool.second_target);
  EXPECT_EQ(device_.has_prior, configuration.parameters.pool.prior);
  EXPECT_EQ(device_.has_raw_histogram, configuration.raw_histogram);
  EXPECT_EQ(device_.has_parity, (bench_.get(DTOF_READOUT) & DTOF_READOUT_PARITY_MASK) != 0);
  EXPECT_EQ(device_.has_self_test, (bench_.get(DTOF_READOUT) & DTOF_READOUT_SELF_TEST_MASK) != 0);
  EXPECT_EQ(device_.clock_waits, bench_.clock_waits());
  EXPECT_EQ(device_.source_waits, bench_.source_waits());
  EXPECT_EQ(device_.has_raster_order, (bench_.get(DTOF_READOUT) & DTOF_READOUT_RASTER_ORDER_MASK) != 0);
  EXPECT_EQ(device_.count_width, configuration.parameters.count_width);
  EXPECT_EQ(device_.nb, configuration.parameters.nb);
  EXPECT_EQ(device_.window_centred, configuration.parameters.window_centred);
  EXPECT_EQ(device_.pointer_step, configuration.parameters.pointer_step);
  if (configuration.parameters.readout == Readout::kHisPointer) {
    EXPECT_EQ(device_.guard, static_cast<std::uint32_t>(configuration.parameters.guard));
  }
  const PoolPointerParameters pool = device_.has_schedule ? configuration.parameters.pool
                                                          : PoolPointerParameters{.group_size = 0,
                                                                                  .labels = 0,
                                                                                  .score_bits = 0,
                                                                                  .offset_bits = 0,
                                                                                  .count_bits = 0,
                                                                                  .pointer_shift = 0,
                                                                                  .rival_moves = false,
                                                                                  .cell_shift = 0,
                                                                                  .coarse_share = 0,
                                                                                  .track_share = 0,
                                                                                  .engine_columns = 0};
  EXPECT_EQ(device_.group_size, pool.group_size);
  EXPECT_EQ(device_.labels, pool.labels);
  EXPECT_EQ(device_.score_bits, pool.score_bits);
  EXPECT_EQ(device_.offset_bits, pool.offset_bits);
  EXPECT_EQ(device_.advantage_width, pool.count_bits);
  EXPECT_EQ(device_.pointer_shift, pool.pointer_shift);
  EXPECT_EQ(device_.rival_moves, pool.rival_moves);
  EXPECT_EQ(device_.cell_shift, pool.cell_shift);
  EXPECT_EQ(device_.engine_columns, pool.engine_columns);
  EXPECT_EQ(device_.coarse_share, pool.coarse_share);
  EXPECT_EQ(device_.track_share, pool.track_share);
}

TEST_P(Driver, ReadsFramesInMillimetres) {
  CounterRandom random = this->random(20);
  const RtlConfiguration& configuration = bench_.configuration();
  const auto columns = static_cast<std::size_t>(configuration.sram_num);
  const LookupTable table = LookupTable::fit(
      std::array<CalibrationPoint, 4>{{{10.0, 0.4}, {40.0, 1.5}, {90.5, 4.0}, {200.0, 9.0}}});
  std::vector<dtof_point> points;
  points.reserve(table.knots().size());
  for (const CalibrationPoint& knot : table.knots()) {
    points.push_back({knot.position, 1000.0 * knot.distance_m});
  }
  constexpr double kCodePicoseconds = 45.0;
  constexpr double kPulsePicoseconds = 2000.0;
  const DepthScale scale(kCodePicoseconds * 1e-12 * configuration.parameters.code_count(),
                         configuration.parameters.np, kPulsePicoseconds * 1e-12);

  std::vector<PoolPrior> priors;
  PoolTemplate chosen_template{};
  for (std::size_t frame = 0; frame < 8; ++frame) {
    FrameSettings settings{
        .acquisitions = random() % 30,
        .gate = {pick(random, 4), configuration.parameters.no_detection() - pick(random, 4)},
        .weak_below = random() % 4,
        .enabled =
            [&] {
              std::vector<bool> enabled(columns);
              for (std::size_t i = 0; i < columns; ++i) {
                enabled[i] = pick(random, 5) != 0;
              }
              return enabled;
            }(),
        .second_target = device_.has_second_target && frame % 2 == 0,
        .smooth = frame % 4 < 2,
        .prior = device_.has_prior && frame % 4 != 2,
        .short_words = frame % 3 == 1};
    dtof_settings chosen = dtof_default_settings(&device_, settings.acquisitions);
    chosen.gate_begin = static_cast<std::uint16_t>(settings.gate.begin);
    chosen.gate_end = static_cast<std::uint16_t>(settings.gate.end);
    chosen.weak_below = static_cast<std::uint16_t>(settings.weak_below);
    chosen.second_target = settings.second_target;
    chosen.smooth = settings.smooth;
    chosen.prior = settings.prior;
    chosen.short_words = settings.short_words;
    if (device_.has_schedule && frame % 2 == 0) {
      chosen_template = random_template(random);
      ASSERT_EQ(dtof_set_template(&device_, chosen_template.data()), DTOF_OK);
    }
    settings.coarse_template = chosen_template;
    std::vector<std::uint32_t> mask((columns + 31) / 32);
    for (std::size_t i = 0; i < columns; ++i) {
      mask[i / 32] |= settings.enabled[i] ? 1U << (i % 32) : 0U;
    }
    ASSERT_EQ(dtof_configure(&device_, &chosen), DTOF_OK);
    ASSERT_EQ(dtof_enable_columns(&device_, mask.data()), DTOF_OK);
    ASSERT_EQ(dtof_enable_interrupts(&device_, true, false), DTOF_OK);
    const std::vector<Line> lines = make_lines(configuration, settings.acquisitions, random);
    push_lines(bench_, lines);
    ASSERT_EQ(dtof_start(&device_, false), DTOF_OK);
    bench_.wait_for_frames(1);
    EXPECT_TRUE(bench_.interrupt());
    std::uint32_t causes = 0;
    ASSERT_EQ(dtof_take_interrupts(&device_, &causes), DTOF_OK);
    EXPECT_EQ(causes, DTOF_IRQ_STATUS_FRAME_MASK);
    EXPECT_FALSE(bench_.interrupt());
    std::uint32_t frames = 0;
    std::uint32_t cycles = 0;
    ASSERT_EQ(dtof_frames(&device_, &frames, &cycles), DTOF_OK);
    EXPECT_EQ(frames, frame + 1);
    EXPECT_EQ(cycles, bench_.frames().back().cycles);

    const std::vector<std::uint64_t>& words = bench_.sink().frames().back();
    std::uint32_t checked = 0;
    ASSERT_EQ(dtof_check_frame(&device_, words.data(), words.size(), &checked), DTOF_OK);
    EXPECT_EQ(checked, frame + 1);
    std::vector<std::uint64_t> damaged = words;
    damaged[random() % damaged.size()] ^= std::uint64_t{1} << (random() % DTOF_RESULT_ABORTED_LSB);
    EXPECT_EQ(dtof_check_frame(&device_, damaged.data(), damaged.size(), &checked), DTOF_CORRUPT);
    EXPECT_EQ(dtof_check_frame(&device_, words.data() + 1, words.size() - 1, &checked), DTOF_CORRUPT);
    EXPECT_EQ(dtof_check_frame(&device_, words.data(), words.size() - 1, &checked), DTOF_CORRUPT);
    std::vector<dtof_result> results(columns * static_cast<std::size_t>(configuration.pixels_per_sram));
    const auto unpack = settings.short_words ? dtof_unpack_short_frame : dtof_unpack_frame;
    ASSERT_EQ(unpack(&device_, words.data(), words.size(), results.data()), DTOF_OK);
    for (const ResultFields& expected : expected_results(bench_, settings, lines, &priors)) {
      const dtof_result& of_pixel = results[static_cast<std::size_t>(expected.row) * columns +
                                            static_cast<std::size_t>(expected.column)];
      ASSERT_EQ(of_pixel.has_second, settings.second_target);
      const dtof_result result = expected.second ? dtof_second(&of_pixel) : of_pixel;
      const ResultFields fields{.position = result.position,
                                .confidence = result.confidence,
                                .row = result.row,
                                .column = result.column,
                                .valid = result.valid,
                                .weak = result.weak,
                                .empty = result.empty,
                                .masked = result.masked,
                                .saturated = result.saturated,
                                .second = expected.second};
      ASSERT_EQ(fields, expected);
      const double position = expected.position / static_cast<double>(1 << device_.fraction_bits);
      EXPECT_NEAR(dtof_distance_mm(&device_, &result, points.data(), points.size()),
                  1000.0 * table.distance(position), 1e-6);
      EXPECT_NEAR(dtof_time_of_flight_mm(&device_, &result, kCodePicoseconds, kPulsePicoseconds),
                  1000.0 * scale.depth(position), 1e-6);
    }
  }
}

TEST_P(Driver, KnowsTheOrderOfTheStream) {
  std::size_t index = 0;
  std::uint16_t row = 0;
  std::uint16_t column = 0;
  for (const ResultAddress& pixel : stream_order(bench_)) {
    ASSERT_EQ(dtof_pixel_at(&device_, index++, &row, &column), DTOF_OK);
    ASSERT_EQ(std::pair(int{row}, int{column}), std::pair(pixel.row, pixel.column)) << "index " << index - 1;
  }
  EXPECT_EQ(dtof_pixel_at(&device_, index, &row, &column), DTOF_ARGUMENT);
}

TEST_P(Driver, ReadsRawHistograms) {
  if (!device_.has_raw_histogram) {
    GTEST_SKIP() << "the subsystem sends none";
  }
  CounterRandom random = this->random(21);
  const RtlConfiguration& configuration = bench_.configuration();
  const int rows = configuration.pixels_per_sram;
  for (const auto& [first, last] : {std::pair(0, rows - 1), std::pair(1, 2), std::pair(rows - 1, rows - 1)}) {
    const FrameSettings settings{.acquisitions = 20,
                                 .gate = {0, configuration.parameters.no_detection()},
                                 .weak_below = 0,
                                 .enabled = {},
                                 .raw = true,
                                 .raw_first = first,
                                 .raw_last = last};
    dtof_settings chosen = dtof_default_settings(&device_, settings.acquisitions);
    chosen.raw = true;
    chosen.raw_first_row = static_cast<std::uint16_t>(first);
    chosen.raw_last_row = static_cast<std::uint16_t>(last);
    ASSERT_EQ(dtof_configure(&device_, &chosen), DTOF_OK);
    const std::vector<Line> lines = make_lines(configuration, settings.acquisitions, random);
    push_lines(bench_, lines);
    ASSERT_EQ(dtof_start(&device_, false), DTOF_OK);
    bench_.wait_for_frames(1);
    const std::vector<std::uint64_t>& words = bench_.sink().frames().back();
    std::vector<dtof_result> bins(words.size());
    ASSERT_EQ(dtof_unpack_raw(&device_, chosen.raw_first_row, chosen.raw_last_row, words.data(), words.size(),
                              bins.data()),
              DTOF_OK);
    const std::vector<ResultFields> expected = expected_results(bench_, settings, lines);
    ASSERT_EQ(expected.size(), words.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const std::size_t bin = i / device_.columns % device_.raw_bins;
      const std::size_t pixel =
          i / device_.columns / device_.raw_bins * device_.columns + i % device_.columns;
      const dtof_result& result = bins[pixel * device_.raw_bins + bin];
      ASSERT_TRUE(result.raw);
      ASSERT_EQ(result.row, expected[i].row);
      ASSERT_EQ(result.column, expected[i].column);
      ASSERT_EQ(result.position, expected[i].position);
      ASSERT_EQ(result.confidence, expected[i].confidence);
      ASSERT_EQ(result.saturated, expected[i].saturated);
    }
    std::vector<std::uint64_t> other = words;
    std::swap(other.front(), other.back());
    EXPECT_EQ(dtof_unpack_raw(&device_, chosen.raw_first_row, chosen.raw_last_row, other.data(), other.size(),
                              bins.data()),
              DTOF_STREAM);
    EXPECT_EQ(dtof_unpack_raw(&device_, chosen.raw_first_row, chosen.raw_last_row, words.data(),
                              words.size() - 1, bins.data()),
              DTOF_STREAM);
  }
}

TEST_P(Driver, StopsContinuousFramesAndTakesErrors) {
  dtof_settings settings = dtof_default_settings(&device_, 0);
  ASSERT_EQ(dtof_configure(&device_, &settings), DTOF_OK);
  ASSERT_EQ(dtof_start(&device_, true), DTOF_OK);
  bool busy = false;
  ASSERT_EQ(dtof_busy(&device_, &busy), DTOF_OK);
  EXPECT_TRUE(busy);
  EXPECT_EQ(dtof_start(&device_, false), DTOF_BUSY);
  EXPECT_EQ(dtof_flush(&device_), DTOF_BUSY);
  bench_.wait_for_frames(3);
  ASSERT_EQ(dtof_stop(&device_), DTOF_OK);
  bench_.clocks(5000);
  ASSERT_EQ(dtof_busy(&device_, &busy), DTOF_OK);
  EXPECT_FALSE(busy);
  std::uint32_t errors = 1;
  ASSERT_EQ(dtof_take_errors(&device_, &errors), DTOF_OK);
  EXPECT_EQ(errors, 0U) << "the driver did not start a frame while another was under way";
  ASSERT_EQ(bench_.write(DTOF_RELEASE, 0).error, false);
  ASSERT_EQ(dtof_start(&device_, false), DTOF_OK);
  ASSERT_EQ(dtof_take_errors(&device_, &errors), DTOF_OK);
  EXPECT_EQ(errors, DTOF_ERROR_ILLEGAL_SCHEDULE_MASK);
  ASSERT_EQ(dtof_take_errors(&device_, &errors), DTOF_OK);
  EXPECT_EQ(errors, 0U);
  EXPECT_EQ(dtof_flush(&device_), DTOF_OK);
}

TEST_P(Driver, RecoversFromADeadSourceAndASinkThatStops) {
  CounterRandom random = this->random(22);
  const RtlConfiguration& configuration = bench_.configuration();
  const auto lines_of_an_acquisition = static_cast<std::uint32_t>(bench_.acquisition_lines());
  EXPECT_EQ(dtof_set_watchdog(&device_, 1U << 24U), DTOF_ARGUMENT);
  ASSERT_EQ(dtof_set_watchdog(&device_, 0), DTOF_OK);
  FrameSettings settings{.acquisitions = 4,
                         .gate = {0, configuration.parameters.no_detection()},
                         .weak_below = 0,
                         .enabled = {}};
  const dtof_settings chosen = dtof_default_settings(&device_, settings.acquisitions);
  for (const bool sink_stops : {false, true}) {
    SCOPED_TRACE(testing::Message() << (sink_stops ? "the sink stops" : "the source dies"));
    ASSERT_EQ(dtof_configure(&device_, &chosen), DTOF_OK);
    std::vector<Line> lines = make_lines(configuration, settings.acquisitions, random);
    if (!sink_stops) {
      lines.resize(lines.size() - lines_of_an_acquisition);
    }
    push_lines(bench_, lines);
    bench_.sink().blocked = sink_stops;
    ASSERT_EQ(dtof_start(&device_, sink_stops), DTOF_OK);
    bench_.clocks(10000);
    dtof_state state{};
    ASSERT_EQ(dtof_read_state(&device_, &state), DTOF_OK);
    EXPECT_TRUE(state.busy);
    EXPECT_EQ(dtof_start(&device_, false), DTOF_BUSY);
    EXPECT_EQ(dtof_flush(&device_), DTOF_BUSY);
    EXPECT_EQ(state.warnings, 0U);
    bench_.source().reset();
    ASSERT_EQ(dtof_recover(&device_), DTOF_OK);
    ASSERT_EQ(dtof_read_state(&device_, &state), DTOF_OK);
    EXPECT_FALSE(state.busy);
    EXPECT_EQ(state.level, 0);
    EXPECT_EQ(state.errors, 0U);
    EXPECT_EQ(state.warnings, 0U);
    EXPECT_EQ(state.lost_lines, 0U);
    EXPECT_EQ(state.lost_acquisitions, 0U);
    bench_.sink().blocked = false;
    bench_.clocks(1000);

    lines = make_lines(configuration, settings.acquisitions, random);
    push_lines(bench_, lines);
    ASSERT_EQ(dtof_start(&device_, false), DTOF_OK) << "the settings are still there";
    bench_.wait_for_frames(1);
    ASSERT_EQ(received_results(bench_, bench_.sink().frames().size() - 1),
              expected_results(bench_, settings, lines));
  }
  // A source that the software has not stopped: the rest of its acquisition is no frame's.
  const std::vector<Line> lines = make_lines(configuration, 120, random);
  push_lines(bench_, lines);
  const dtof_settings longer = dtof_default_settings(&device_, 60);
  ASSERT_EQ(dtof_configure(&device_, &longer), DTOF_OK);
  ASSERT_EQ(dtof_start(&device_, false), DTOF_OK);
  while (bench_.source().waiting() > lines.size() - lines_of_an_acquisition - 1) {
    bench_.clock();
  }
  ASSERT_EQ(dtof_abort(&device_, false), DTOF_OK);
  dtof_state state{};
  ASSERT_EQ(dtof_read_state(&device_, &state), DTOF_OK);
  EXPECT_EQ(state.warnings, DTOF_WARNING_ABORTED_MASK);
  ASSERT_EQ(dtof_configure(&device_, &chosen), DTOF_OK);
  ASSERT_EQ(dtof_start(&device_, false), DTOF_OK);
  bench_.wait_for_frames(1);
  const std::vector<Line>& taken = bench_.frames().back().lines;
  std::size_t places = 0;
  for (std::size_t line = 0; line + taken.size() <= lines.size(); line += lines_of_an_acquisition) {
    const auto first = lines.begin() + static_cast<std::ptrdiff_t>(line);
    places += std::equal(taken.begin(), taken.end(), first) ? 1 : 0;
  }
  EXPECT_GT(places, 0U) << "the frame is not of whole acquisitions one behind the other";
  ASSERT_EQ(received_results(bench_, bench_.sink().frames().size() - 1),
            expected_results(bench_, settings, taken));
}

TEST_P(Driver, CommitsSettingsOfContinuousFrames) {
  dtof_settings settings = dtof_default_settings(&device_, 0);
  ASSERT_EQ(dtof_configure(&device_, &settings), DTOF_OK);
  ASSERT_EQ(dtof_start(&device_, true), DTOF_OK);
  bench_.wait_for_frames(2);
  settings = dtof_default_settings(&device_, 2);
  const std::vector<std::uint32_t> none((device_.columns + 31U) / 32U, 0);
  ASSERT_EQ(dtof_configure(&device_, &settings), DTOF_OK);
  ASSERT_EQ(dtof_enable_columns(&device_, none.data()), DTOF_OK);
  bench_.wait_for_frames(4);
  EXPECT_FALSE(fields_of(bench_.sink().frames().back().front()).masked) << "not committed";
  ASSERT_EQ(dtof_commit(&device_), DTOF_OK);
  push_lines(bench_, dark_lines(bench_.configuration(), 20));
  bench_.wait_for_frames(4);
  EXPECT_TRUE(fields_of(bench_.sink().frames().back().front()).masked);
  EXPECT_EQ(bench_.frames().at(bench_.sink().numbers().back()).lines.size(), 2 * bench_.acquisition_lines());
  ASSERT_EQ(dtof_abort(&device_, true), DTOF_OK);
}

TEST_P(Driver, RefusesWhatTheHardwareCannotTake) {
  const dtof_settings good = dtof_default_settings(&device_, 5);
  const auto refused = [&](auto change) {
    EXPECT_EQ(dtof_configure(&device_, &good), DTOF_OK);
    dtof_settings settings = good;
    settings.acquisitions = 6;
    change(settings);
    return dtof_configure(&device_, &settings) == DTOF_ARGUMENT && bench_.get(DTOF_ACQUISITIONS) == 5;
  };
  EXPECT_TRUE(refused([](dtof_settings& settings) { settings.acquisitions = 65536; }));
  EXPECT_TRUE(refused([](dtof_settings& settings) { settings.release = 1000; }));
  EXPECT_TRUE(refused([](dtof_settings& settings) { settings.weak_below = 5000; }));
  EXPECT_EQ(refused([](dtof_settings& settings) { settings.gate_end = 5000; }), device_.has_gate);
  EXPECT_EQ(refused([](dtof_settings& settings) { settings.second_target = true; }),
            !device_.has_second_target);
  EXPECT_EQ(refused([](dtof_settings& settings) { settings.prior = true; }), !device_.has_prior);
  EXPECT_EQ(refused([](dtof_settings& settings) { settings.raw = true; }), !device_.has_raw_histogram);
  EXPECT_TRUE(refused([](dtof_settings& settings) {
    settings.raw = true;
    settings.raw_last_row = 1000;
  }));
  EXPECT_EQ(refused([](dtof_settings& settings) {
              settings.track_share = static_cast<std::uint8_t>(65 - settings.coarse_share);
            }),
            device_.has_schedule);
}

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

TEST(DriverAlone, TellsWhatItDoesNotFind) {
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

TEST(DriverAlone, TellsWhenTheBusFails) {
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

TEST(DriverAlone, TellsWhenAFrameWasAborted) {
  Memory memory;
  dtof_device device{};
  ASSERT_EQ(dtof_probe(&device, {&memory, memory_read, memory_write}), DTOF_OK);  // 2 columns of 3 rows
  const std::vector<std::uint64_t> words = {0, 1, DTOF_RESULT_ABORTED_MASK};
  std::vector<dtof_result> results(6);
  EXPECT_EQ(dtof_unpack(&device, words[2], results.data()), DTOF_ABORTED);
  EXPECT_EQ(dtof_unpack_frame(&device, words.data(), words.size(), results.data()), DTOF_ABORTED);
  EXPECT_EQ(dtof_unpack_frame(&device, words.data(), 2, results.data()), DTOF_STREAM);
}

TEST(DriverAlone, TellsWhenAFrameIsNotWhole) {
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

TEST(DriverAlone, KnowsTheOrderOfEngines) {
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

TEST(DriverAlone, ATableOfOnePointIsThatDistance) {
  const dtof_device device{};
  const dtof_result result{};
  const dtof_point point = {7.0, 1234.0};
  EXPECT_EQ(dtof_distance_mm(&device, &result, &point, 1), 1234.0);
}

}  // namespace
}  // namespace dtof
