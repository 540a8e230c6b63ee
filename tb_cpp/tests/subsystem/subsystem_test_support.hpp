// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "dtof/core/random.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/pool_pointer.hpp"
#include "dtof_registers.h"
#include "subsystem/subsystem_bench.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {

/// Fields of a result word.
struct ResultFields {
  int position = 0;
  int confidence = 0;
  int row = 0;
  int column = 0;
  bool valid = false;
  bool weak = false;
  bool empty = false;
  bool masked = false;
  bool saturated = false;
  bool second = false;
  bool raw = false;
  int amplitude = 0;
  int ambient = 0;

  bool operator==(const ResultFields&) const = default;
};

inline void PrintTo(const ResultFields& fields, std::ostream* stream) {
  *stream << "row " << fields.row << " column " << fields.column << " position " << fields.position
          << " confidence " << fields.confidence << (fields.valid ? " valid" : "")
          << (fields.weak ? " weak" : "") << (fields.empty ? " empty" : "")
          << (fields.masked ? " masked" : "") << (fields.saturated ? " saturated" : "")
          << (fields.second ? " second" : "") << (fields.raw ? " raw" : "") << " amplitude "
          << fields.amplitude << " ambient " << fields.ambient;
}

inline ResultFields fields_of(std::uint64_t word) {
  const auto field = [&](std::uint64_t mask, int lsb) { return static_cast<int>((word & mask) >> lsb); };
  return {.position = field(DTOF_RESULT_POSITION_MASK, DTOF_RESULT_POSITION_LSB),
          .confidence = field(DTOF_RESULT_CONFIDENCE_MASK, DTOF_RESULT_CONFIDENCE_LSB),
          .row = field(DTOF_RESULT_ROW_MASK, DTOF_RESULT_ROW_LSB),
          .column = field(DTOF_RESULT_COLUMN_MASK, DTOF_RESULT_COLUMN_LSB),
          .valid = (word & DTOF_RESULT_VALID_MASK) != 0,
          .weak = (word & DTOF_RESULT_WEAK_MASK) != 0,
          .empty = (word & DTOF_RESULT_EMPTY_MASK) != 0,
          .masked = (word & DTOF_RESULT_MASKED_MASK) != 0,
          .saturated = (word & DTOF_RESULT_SATURATED_MASK) != 0,
          .second = (word & DTOF_RESULT_SECOND_MASK) != 0,
          .raw = (word & DTOF_RESULT_RAW_MASK) != 0};
}

/// Fields of a word with amplitude and ambient, which has neither row nor column.
inline ResultFields fields_of_amplitude(std::uint64_t word) {
  const auto field = [&](std::uint64_t mask, int lsb) { return static_cast<int>((word & mask) >> lsb); };
  ResultFields fields = fields_of(word);
  fields.row = 0;
  fields.column = 0;
  fields.amplitude = field(DTOF_AMPLITUDE_RESULT_AMPLITUDE_MASK, DTOF_AMPLITUDE_RESULT_AMPLITUDE_LSB);
  fields.ambient = field(DTOF_AMPLITUDE_RESULT_AMBIENT_MASK, DTOF_AMPLITUDE_RESULT_AMBIENT_LSB);
  return fields;
}

/// Largest confidence of a short word, to which larger ones are clipped.
inline constexpr int kLargestShortConfidence =
    static_cast<int>(DTOF_SHORT_RESULT_CONFIDENCE_MASK >> DTOF_SHORT_RESULT_CONFIDENCE_LSB);

/// Fields of a short word, without row and column.
inline ResultFields fields_of_short(std::uint32_t word) {
  const auto field = [&](std::uint32_t mask, int lsb) { return static_cast<int>((word & mask) >> lsb); };
  return {.position = field(DTOF_SHORT_RESULT_POSITION_MASK, DTOF_SHORT_RESULT_POSITION_LSB),
          .confidence = field(DTOF_SHORT_RESULT_CONFIDENCE_MASK, DTOF_SHORT_RESULT_CONFIDENCE_LSB),
          .valid = (word & DTOF_SHORT_RESULT_VALID_MASK) != 0,
          .weak = (word & DTOF_SHORT_RESULT_WEAK_MASK) != 0,
          .empty = (word & DTOF_SHORT_RESULT_EMPTY_MASK) != 0,
          .masked = (word & DTOF_SHORT_RESULT_MASKED_MASK) != 0,
          .saturated = (word & DTOF_SHORT_RESULT_SATURATED_MASK) != 0,
          .second = (word & DTOF_SHORT_RESULT_SECOND_MASK) != 0};
}

/// Values of a frame's registers. Settings that the configuration lacks have no effect.
struct FrameSettings {
  std::uint32_t acquisitions = 0;
  CodeGate gate{};  ///< without effect where there is none
  std::uint32_t weak_below = 0;
  std::vector<bool> enabled;   ///< columns; empty: all
  bool second_target = false;  ///< without effect where there is none
  bool raw = false;            ///< likewise
  bool smooth = true;          ///< likewise
  bool prior = false;          ///< likewise
  bool short_words = false;    ///< without effect on a raw frame
  bool amplitude = false;      ///< without effect where there is none, and on short words
  int raw_first = 0;
  int raw_last = 0;
  PoolTemplate coarse_template{};  ///< without effect where there is none
  std::uint32_t settle = 0;

  /// Acquisitions of a frame, including those that it drops.
  [[nodiscard]] std::uint32_t taken() const { return acquisitions > 0 ? acquisitions + settle : 0; }
};

/// Bits of OUTPUT that the configuration has.
inline std::uint32_t existing_outputs(const RtlConfiguration& configuration) {
  const ReadoutParameters& parameters = configuration.parameters;
  return DTOF_OUTPUT_SHORT_WORDS_MASK | (parameters.pool.second_target ? DTOF_OUTPUT_SECOND_TARGET_MASK : 0) |
         (parameters.pool.amplitude ? DTOF_OUTPUT_AMPLITUDE_MASK : 0) |
         (parameters.pool.prior ? DTOF_OUTPUT_PRIOR_MASK : 0) |
         (configuration.raw_histogram ? DTOF_OUTPUT_RAW_MASK : 0) |
         (is_pool_readout(parameters.readout) ? DTOF_OUTPUT_SMOOTH_MASK : 0);
}

/// Clocks after which an abort has ended the frame, without a sink that waits.
inline constexpr std::uint64_t kClocksOfAnAbort = 20;

inline void write_settings(SubsystemBench& bench, const FrameSettings& settings) {
  const RtlConfiguration& configuration = bench.configuration();
  bench.set(DTOF_ACQUISITIONS, settings.acquisitions);
  bench.set(DTOF_SETTLE, settings.settle);
  if (is_pool_readout(configuration.parameters.readout)) {
    const PoolSchedule schedule(settings.acquisitions, configuration.parameters.pool);
    bench.set(DTOF_COARSE_END, schedule.coarse_end);
    bench.set(DTOF_TRACK_END, schedule.track_end);
  }
  if (configuration.parameters.time_gate) {
    bench.set(DTOF_GATE, static_cast<std::uint32_t>(settings.gate.begin) << DTOF_GATE_BEGIN_LSB |
                             static_cast<std::uint32_t>(settings.gate.end) << DTOF_GATE_END_LSB);
  }
  bench.set(DTOF_WEAK_BELOW, settings.weak_below);
  bench.set(DTOF_OUTPUT,
            existing_outputs(configuration) &
                ((settings.second_target ? DTOF_OUTPUT_SECOND_TARGET_MASK : 0) |
                 (settings.raw ? DTOF_OUTPUT_RAW_MASK : 0) | (settings.smooth ? DTOF_OUTPUT_SMOOTH_MASK : 0) |
                 (settings.prior ? DTOF_OUTPUT_PRIOR_MASK : 0) |
                 (settings.amplitude ? DTOF_OUTPUT_AMPLITUDE_MASK : 0) |
                 (settings.short_words ? DTOF_OUTPUT_SHORT_WORDS_MASK : 0)));
  if (configuration.raw_histogram) {
    bench.set(DTOF_RAW_ROWS, static_cast<std::uint32_t>(settings.raw_first) << DTOF_RAW_ROWS_FIRST_LSB |
                                 static_cast<std::uint32_t>(settings.raw_last) << DTOF_RAW_ROWS_LAST_LSB);
  }
  for (std::size_t first = 0; first < settings.enabled.size(); first += 32) {
    std::uint32_t mask = 0;
    for (std::size_t i = first; i < std::min(first + 32, settings.enabled.size()); ++i) {
      mask |= settings.enabled[i] ? 1U << (i - first) : 0U;
    }
    bench.set(static_cast<std::uint32_t>(DTOF_COLUMN_ENABLE + first / 8), mask);
  }
}

/// Writes TEMPLATE if the configuration has it. Must not be called while a frame is under way.
inline void write_template(SubsystemBench& bench, const PoolTemplate& coarse_template) {
  if (is_pool_readout(bench.configuration().parameters.readout)) {
    for (std::size_t i = 0; i < coarse_template.size(); i += 4) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        word |= std::uint32_t{coarse_template[i + k]} << (8 * k);
      }
      bench.set(static_cast<std::uint32_t>(DTOF_TEMPLATE + i), word);
    }
  }
}

/// Random TEMPLATE entries: each is 0, 255, any byte, or below 16.
inline PoolTemplate random_template(CounterRandom& random) {
  PoolTemplate coarse_template{};
  for (std::uint8_t& entry : coarse_template) {
    const std::array<int, 4> kinds = {0, 255, pick(random, 256), pick(random, 16)};
    entry = static_cast<std::uint8_t>(kinds[static_cast<std::size_t>(pick(random, 4))]);
  }
  return coarse_template;
}

/// Words of a frame whose array took `lines`: results of the C++ model, and the status. `priors`: candidates
/// that the array keeps from frame to frame, used if the settings enable the prior.
inline std::vector<ResultFields> expected_results(SubsystemBench& bench, const FrameSettings& settings,
                                                  const std::vector<Line>& lines,
                                                  std::vector<PoolPrior>* priors = nullptr) {
  const RtlConfiguration& configuration = bench.configuration();
  ReadoutParameters parameters = configuration.parameters;
  if (parameters.time_gate) {
    parameters.time_gate = settings.gate;
  }
  parameters.pool.smooth = settings.smooth;
  parameters.pool.coarse_template = settings.coarse_template;
  const auto rows = static_cast<std::size_t>(configuration.pixels_per_sram);
  const auto slots = static_cast<std::size_t>(parameters.slots);
  std::vector<ColumnStream> streams;
  std::vector<std::vector<std::vector<PixelResult>>> histograms;  // bins of a raw frame: [column][row][bin]
  const bool raw = settings.raw && configuration.raw_histogram;
  const bool has_prior = priors != nullptr && parameters.pool.prior;
  // The model with a prior has no gate of its own.
  const auto passes = [&](Timestamp code) {
    return !has_prior || !parameters.time_gate || parameters.time_gate->contains(code);
  };
  for (std::size_t column = 0; column < static_cast<std::size_t>(configuration.sram_num); ++column) {
    const bool enabled = settings.enabled.empty() || settings.enabled[column];
    ColumnStream stream;
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = row * slots; enabled && i < lines.size(); i += rows * slots) {
        for (std::size_t slot = 0; slot < slots; ++slot) {
          const Timestamp code = lines[i + slot][column];
          if (passes(code)) {
            stream.append({static_cast<std::uint32_t>(i / (rows * slots)), code});
          }
        }
      }
      stream.finish_row();
    }
    if (raw) {
      histograms.push_back(make_readout_model(parameters)->run_raw_column(stream, settings.acquisitions));
    }
    streams.push_back(std::move(stream));
  }
  const bool has_confidence = !is_pointer_readout(parameters.readout) || parameters.confidence_width > 0;
  const bool counts = has_confidence && !is_pool_readout(parameters.readout);
  const int largest_count = (1 << parameters.count_width) - 1;
  const int largest_confidence =
      is_pointer_readout(parameters.readout) ? (1 << parameters.confidence_width) - 1 : largest_count;
  std::vector<ResultFields> expected;
  for (int row = settings.raw_first; raw && row <= settings.raw_last; ++row) {
    for (std::size_t bin = 0; bin < static_cast<std::size_t>(parameters.raw_bins()); ++bin) {
      for (std::size_t column = 0; column < histograms.size(); ++column) {
        const PixelResult& count = histograms[column][static_cast<std::size_t>(row)][bin];
        const bool masked = !settings.enabled.empty() && !settings.enabled[column];
        expected.push_back({.position = count.code << parameters.fraction_bits,
                            .confidence = count.confidence,
                            .row = row,
                            .column = static_cast<int>(column),
                            .valid = !masked,
                            .masked = masked,
                            .saturated = count.confidence == largest_count,
                            .raw = true});
      }
    }
  }
  if (raw) {
    return expected;
  }
  std::vector<std::vector<PixelResult>> results;
  if (has_prior) {
    if (!settings.prior) {
      priors->clear();
    }
    results = run_pool_pointer(configuration.sram_num, reader_of(streams), parameters.np,
                               settings.acquisitions, pool_pointer_parameters(parameters), priors);
  } else {
    results = make_readout_model(parameters)->run_columns(streams, settings.acquisitions);
  }
  for (const ResultAddress& address : configuration.result_order()) {
    const auto column = static_cast<std::size_t>(address.column);
    const PixelResult& result = results[column][static_cast<std::size_t>(address.row)];
    ResultFields fields{.position = (result.code << parameters.fraction_bits) + result.fraction,
                        .confidence = result.confidence,
                        .row = address.row,
                        .column = address.column};
    fields.weak = has_confidence && result.confidence < settings.weak_below;
    fields.empty = has_confidence && result.confidence == 0;
    fields.masked = !settings.enabled.empty() && !settings.enabled[column];
    fields.saturated = counts && result.confidence == largest_confidence;
    fields.valid = !fields.weak && !fields.empty && !fields.masked;
    fields.confidence =
        settings.short_words ? std::min(fields.confidence, kLargestShortConfidence) : fields.confidence;
    if (settings.amplitude && !settings.short_words) {
      fields.amplitude = result.amplitude;
      fields.ambient = result.ambient;
    }
    expected.push_back(fields);
    if (settings.second_target && parameters.pool.second_target) {
      fields.position = result.second;
      fields.second = true;
      expected.push_back(fields);
    }
  }
  if (bench.raster_order()) {
    std::ranges::sort(expected, {}, [](const ResultFields& fields) {
      return std::tuple(fields.row, fields.column, fields.second);
    });
  }
  return expected;
}

/// Rows and columns of a frame's results in the order of the stream.
inline std::vector<ResultAddress> stream_order(const SubsystemBench& bench) {
  std::vector<ResultAddress> order = bench.configuration().result_order();
  if (bench.raster_order()) {
    std::ranges::sort(order, {},
                      [](const ResultAddress& pixel) { return std::pair(pixel.row, pixel.column); });
  }
  return order;
}

/// Gives results their rows and columns, which follow from the order. Of a result too many, row and column
/// are -1.
inline void place_in_order(std::vector<ResultFields>& received, const SubsystemBench& bench) {
  const std::vector<ResultAddress> order = stream_order(bench);
  std::size_t pixel = 0;
  for (std::size_t i = 0; i < received.size(); ++i) {
    pixel += i > 0 && !received[i].second ? 1 : 0;
    received[i].row = pixel < order.size() ? order[pixel].row : -1;
    received[i].column = pixel < order.size() ? order[pixel].column : -1;
  }
}

/// Results of a frame of short words; their order gives row and column. Of a padding, or a result too many,
/// row and column are -1.
inline std::vector<ResultFields> short_results(const SubsystemBench& bench,
                                               const std::vector<std::uint64_t>& beats) {
  std::vector<ResultFields> received;
  for (const std::uint64_t& beat : beats) {
    received.push_back(fields_of_short(static_cast<std::uint32_t>(beat)));
    if (&beat != &beats.back() || beat >> 32U != 0) {
      received.push_back(fields_of_short(static_cast<std::uint32_t>(beat >> 32U)));
    }
  }
  place_in_order(received, bench);
  return received;
}

/// Results of words with amplitude and ambient.
inline std::vector<ResultFields> amplitude_results(const SubsystemBench& bench,
                                                   const std::vector<std::uint64_t>& words) {
  std::vector<ResultFields> received;
  for (const std::uint64_t word : words) {
    received.push_back(fields_of_amplitude(word));
  }
  place_in_order(received, bench);
  return received;
}

inline std::vector<ResultFields> received_results(const SubsystemBench& bench, std::size_t frame) {
  const std::vector<std::uint64_t>& words = bench.sink().frames().at(frame);
  if (bench.sink().short_words().at(frame)) {
    return short_results(bench, words);
  }
  if (bench.sink().amplitude().at(frame)) {
    return amplitude_results(bench, words);
  }
  std::vector<ResultFields> received;
  for (const std::uint64_t word : words) {
    received.push_back(fields_of(word));
  }
  return received;
}

/// Lines of whole acquisitions without detections.
inline std::vector<Line> dark_lines(const RtlConfiguration& configuration, std::uint32_t acquisitions) {
  const auto rows = static_cast<std::size_t>(configuration.pixels_per_sram);
  const auto slots = static_cast<std::size_t>(configuration.parameters.slots);
  const auto none = static_cast<Timestamp>(configuration.parameters.no_detection());
  return {acquisitions * rows * slots, Line(static_cast<std::size_t>(configuration.sram_num), none)};
}

/// Puts a pixel's detections, which must be sorted by acquisition, into the lines.
inline void put_pixel(std::vector<Line>& lines, const RtlConfiguration& configuration, std::size_t column,
                      std::size_t row, std::span<const Detection> detections) {
  const auto rows = static_cast<std::size_t>(configuration.pixels_per_sram);
  const auto slots = static_cast<std::size_t>(configuration.parameters.slots);
  std::size_t slot = 0;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    slot = i > 0 && detections[i].acquisition == detections[i - 1].acquisition ? slot + 1 : 0;
    lines[(detections[i].acquisition * rows + row) * slots + slot][column] = detections[i].timestamp;
  }
}

/// Lines of whole acquisitions; each pixel has another kind of stream.
inline std::vector<Line> make_lines(const RtlConfiguration& configuration, std::uint32_t acquisitions,
                                    CounterRandom& random) {
  std::vector<Line> lines = dark_lines(configuration, acquisitions);
  std::size_t kind = random() % kStreamKinds.size();
  for (std::size_t column = 0; column < static_cast<std::size_t>(configuration.sram_num); ++column) {
    for (std::size_t row = 0; row < static_cast<std::size_t>(configuration.pixels_per_sram); ++row) {
      put_pixel(lines, configuration, column, row,
                make_stream(kStreamKinds[kind++ % kStreamKinds.size()], configuration.parameters,
                            acquisitions, random));
    }
  }
  return lines;
}

/// Lines with a detection in each of them, so that the bench can tell every line from a missing one.
inline std::vector<Line> bright_lines(const RtlConfiguration& configuration, std::uint32_t acquisitions,
                                      CounterRandom& random) {
  std::vector<Line> lines = make_lines(configuration, acquisitions, random);
  const int codes = configuration.parameters.code_count();
  for (Line& line : lines) {
    line.back() = static_cast<Timestamp>(pick(random, codes - 1));
  }
  return lines;
}

inline void push_lines(SubsystemBench& bench, const std::vector<Line>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    bench.source().push(lines[i], i % bench.acquisition_lines() == bench.acquisition_lines() - 1);
  }
}

/// Runs `frames` frames of `lines` in continuous mode, then aborts. Meanwhile software sets and clears the
/// bits `output` of OUTPUT, with and without a commit, and the sink waits at random.
inline void run_with_changing_output(SubsystemBench& bench, std::uint32_t output,
                                     const std::vector<Line>& lines, std::size_t frames,
                                     CounterRandom& random) {
  push_lines(bench, lines);
  bench.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK | DTOF_CONTROL_CONTINUOUS_MASK);
  while (bench.sink().frames().size() < frames) {
    bench.set(DTOF_OUTPUT, existing_outputs(bench.configuration()) &
                               (DTOF_OUTPUT_SMOOTH_MASK | (pick(random, 2) == 0 ? output : 0U)));
    if (pick(random, 3) != 0) {
      bench.set(DTOF_COMMIT, DTOF_COMMIT_SETTINGS_MASK);
    }
    bench.sink().stall_probability = pick(random, 2) == 0 ? 0.0 : 0.9;
    bench.clocks(random() % 60);
    if (pick(random, 4) == 0) {  // a sink that holds the last words of a frame while the next one begins
      bench.sink().blocked = true;
      bench.clocks(random() % 300);
      bench.sink().blocked = false;
    }
  }
  bench.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK);
}

/// Lines of a frame that reach the array: those after the acquisitions that the frame drops.
inline std::vector<Line> settled_lines(const SubsystemBench& bench, const FrameSettings& settings,
                                       const std::vector<Line>& lines) {
  const std::size_t dropped =
      (settings.taken() - settings.acquisitions) * static_cast<std::size_t>(bench.acquisition_lines());
  return {lines.begin() + static_cast<std::ptrdiff_t>(dropped), lines.end()};
}

/// Tests of each compiled subsystem whose source can wait.
class Subsystem : public testing::TestWithParam<CompiledSubsystem> {
 protected:
  void SetUp() override {
    if (!bench_.source_waits()) {
      GTEST_SKIP() << "a source that cannot wait has tests of its own";
    }
  }

  [[nodiscard]] CounterRandom random(std::uint32_t which) const {
    return {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), which, 0};
  }

  SubsystemBench bench_{GetParam(), test_seed()};
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

inline std::string subsystem_test_name(const testing::TestParamInfo<CompiledSubsystem>& subsystem) {
  const RtlConfiguration& configuration = subsystem.param.configuration;
  std::string name = fmt::format("{}_{}x{}", readout_name(configuration.parameters.readout),
                                 configuration.sram_num, configuration.pixels_per_sram);
  std::ranges::replace(name, '-', '_');  // GoogleTest wants letters, digits and these
  return name;
}

inline void PrintTo(const CompiledSubsystem& subsystem, std::ostream* stream) {
  *stream << subsystem.configuration.to_string();
}

}  // namespace dtof
