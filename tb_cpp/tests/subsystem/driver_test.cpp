// SPDX-License-Identifier: Apache-2.0
// The C driver on the Verilated subsystem.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

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
  EXPECT_EQ(device_.has_amplitude, configuration.parameters.pool.amplitude);
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
                                                                                  .engine_columns = 0,
                                                                                  .coarse_share = 0,
                                                                                  .track_share = 0};
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

constexpr double kCodePicoseconds = 45.0;
constexpr double kPulsePicoseconds = 2000.0;

/// Driver with a look-up table, for frames of random settings.
class DriverFrames : public Driver {
 protected:
  DriverFrames() {
    for (const CalibrationPoint& knot : table_.knots()) {
      points_.push_back({knot.position, 1000.0 * knot.distance_m});
    }
  }

  FrameSettings draw_settings(std::size_t frame, CounterRandom& random) const {
    return {.acquisitions = random() % 30,
            .gate = {pick(random, 4), configuration().parameters.no_detection() - pick(random, 4)},
            .weak_below = random() % 4,
            .enabled =
                [&] {
                  std::vector<bool> enabled(columns());
                  for (std::size_t i = 0; i < enabled.size(); ++i) {
                    enabled[i] = pick(random, 5) != 0;
                  }
                  return enabled;
                }(),
            .second_target = device_.has_second_target && frame % 2 == 0,
            .smooth = frame % 4 < 2,
            .prior = device_.has_prior && frame % 4 != 2,
            .short_words = frame % 3 == 1,
            .amplitude = device_.has_amplitude && frame % 4 != 3};
  }

  /// Writes all settings but the template by the driver.
  void configure(const FrameSettings& settings) {
    dtof_settings chosen = dtof_default_settings(&device_, settings.acquisitions);
    chosen.gate_begin = static_cast<std::uint16_t>(settings.gate.begin);
    chosen.gate_end = static_cast<std::uint16_t>(settings.gate.end);
    chosen.weak_below = static_cast<std::uint16_t>(settings.weak_below);
    chosen.second_target = settings.second_target;
    chosen.smooth = settings.smooth;
    chosen.prior = settings.prior;
    chosen.short_words = settings.short_words;
    chosen.amplitude = settings.amplitude;
    std::vector<std::uint32_t> mask((columns() + 31) / 32);
    for (std::size_t i = 0; i < columns(); ++i) {
      mask[i / 32] |= settings.enabled[i] ? 1U << (i % 32) : 0U;
    }
    ASSERT_EQ(dtof_configure(&device_, &chosen), DTOF_OK);
    ASSERT_EQ(dtof_enable_columns(&device_, mask.data()), DTOF_OK);
    ASSERT_EQ(dtof_enable_interrupts(&device_, true, false), DTOF_OK);
  }

  /// Reads one frame of the lines. `number` frames must be counted afterwards.
  void run(const std::vector<Line>& lines, std::size_t number) {
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
    EXPECT_EQ(frames, number);
    EXPECT_EQ(cycles, bench_.frames().back().cycles);
  }

  /// The driver accepts the words of the last frame, and refuses them with a changed bit or without a word.
  void expect_only_whole_frames_pass(std::size_t number, CounterRandom& random) {
    const std::vector<std::uint64_t>& words = bench_.sink().frames().back();
    std::uint32_t checked = 0;
    ASSERT_EQ(dtof_check_frame(&device_, words.data(), words.size(), &checked), DTOF_OK);
    EXPECT_EQ(checked, number);
    std::vector<std::uint64_t> damaged = words;
    damaged[random() % damaged.size()] ^= std::uint64_t{1} << (random() % DTOF_RESULT_ABORTED_LSB);
    EXPECT_EQ(dtof_check_frame(&device_, damaged.data(), damaged.size(), &checked), DTOF_CORRUPT);
    EXPECT_EQ(dtof_check_frame(&device_, words.data() + 1, words.size() - 1, &checked), DTOF_CORRUPT);
    EXPECT_EQ(dtof_check_frame(&device_, words.data(), words.size() - 1, &checked), DTOF_CORRUPT);
  }

  /// Fields and distances of a pixel's result, as the driver gives them.
  void expect_result(const dtof_result& of_pixel, const ResultFields& expected,
                     const FrameSettings& settings) {
    ASSERT_EQ(of_pixel.has_second, settings.second_target);
    ASSERT_EQ(of_pixel.has_amplitude, settings.amplitude && !settings.short_words);
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
                              .second = expected.second,
                              .amplitude = result.amplitude,
                              .ambient = result.ambient};
    ASSERT_EQ(fields, expected);
    const double position = expected.position / static_cast<double>(1 << device_.fraction_bits);
    EXPECT_NEAR(dtof_distance_mm(&device_, &result, points_.data(), points_.size()),
                1000.0 * table_.distance(position), 1e-6);
    EXPECT_NEAR(dtof_time_of_flight_mm(&device_, &result, kCodePicoseconds, kPulsePicoseconds),
                1000.0 * scale_.depth(position), 1e-6);
  }

  [[nodiscard]] const RtlConfiguration& configuration() const { return bench_.configuration(); }
  [[nodiscard]] std::size_t columns() const { return static_cast<std::size_t>(configuration().sram_num); }

  const LookupTable table_ = LookupTable::fit(
      std::array<CalibrationPoint, 4>{{{10.0, 0.4}, {40.0, 1.5}, {90.5, 4.0}, {200.0, 9.0}}});
  std::vector<dtof_point> points_;
  const DepthScale scale_{kCodePicoseconds * 1e-12 * configuration().parameters.code_count(),
                          configuration().parameters.np, kPulsePicoseconds * 1e-12};
};

INSTANTIATE_TEST_SUITE_P(All, DriverFrames, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(DriverFrames, AreReadInMillimetres) {
  CounterRandom random = this->random(20);
  std::vector<PoolPrior> priors;
  PoolTemplate chosen_template{};
  for (std::size_t frame = 0; frame < 8; ++frame) {
    FrameSettings settings = draw_settings(frame, random);
    if (device_.has_schedule && frame % 2 == 0) {
      chosen_template = random_template(random);
      ASSERT_EQ(dtof_set_template(&device_, chosen_template.data()), DTOF_OK);
    }
    settings.coarse_template = chosen_template;
    ASSERT_NO_FATAL_FAILURE(configure(settings));
    const std::vector<Line> lines = make_lines(configuration(), settings.acquisitions, random);
    ASSERT_NO_FATAL_FAILURE(run(lines, frame + 1));
    ASSERT_NO_FATAL_FAILURE(expect_only_whole_frames_pass(frame + 1, random));

    const std::vector<std::uint64_t>& words = bench_.sink().frames().back();
    std::vector<dtof_result> results(columns() * static_cast<std::size_t>(configuration().pixels_per_sram));
    const auto unpack = settings.short_words ? dtof_unpack_short_frame
                        : settings.amplitude ? dtof_unpack_amplitude_frame
                                             : dtof_unpack_frame;
    ASSERT_EQ(unpack(&device_, words.data(), words.size(), results.data()), DTOF_OK);
    for (const ResultFields& expected : expected_results(bench_, settings, lines, &priors)) {
      const std::size_t pixel =
          static_cast<std::size_t>(expected.row) * columns() + static_cast<std::size_t>(expected.column);
      ASSERT_NO_FATAL_FAILURE(expect_result(results[pixel], expected, settings));
    }
  }
}

TEST_P(Driver, FollowsTheOrderOfTheStream) {
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
  for (const auto& [first, last] :
       {std::pair(0, rows - 1), std::pair(1, std::min(2, rows - 1)), std::pair(rows - 1, rows - 1)}) {
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
  bench_.clocks(100000);
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
  EXPECT_EQ(refused([](dtof_settings& settings) { settings.amplitude = true; }), !device_.has_amplitude);
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

}  // namespace
}  // namespace dtof
