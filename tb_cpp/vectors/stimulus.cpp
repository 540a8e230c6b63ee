// SPDX-License-Identifier: Apache-2.0
#include "vectors/stimulus.hpp"

#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/pool_pointer.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/sensor/preset.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kLongFrame = 1000;
constexpr std::uint32_t kShortestFrameToReset = 2;
constexpr int kBitsPerDigit = 4;

/// One depth for the whole column in strong light: what lets poolPointer's advantages grow to their end.
/// Every third acquisition, more or less, detects nothing.
ColumnStream surface_column(const ArrayParameters& array, std::uint32_t acquisitions, CounterRandom& random) {
  const int codes = array.readout.code_count();
  const int depth = pick(random, codes);
  const int width = 1 + codes / 256;
  ColumnStream column;
  for (int row = 0; row < array.rows; ++row) {
    for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
      if (pick(random, 3) == 0) {
        continue;
      }
      for (int slot = 0; slot < array.readout.slots; ++slot) {
        const bool background = pick(random, 16) == 0;
        const int code = background ? pick(random, codes) : depth + pick(random, width) - width / 2;
        column.append({acquisition, static_cast<Timestamp>(std::clamp(code, 0, codes - 1))});
      }
    }
    column.finish_row();
  }
  return column;
}

ColumnStream adversarial_column(const ArrayParameters& array, std::uint32_t acquisitions, std::size_t& kind,
                                CounterRandom& random) {
  ColumnStream column;
  for (int row = 0; row < array.rows; ++row) {
    column.append_row(
        make_stream(kStreamKinds[kind % kStreamKinds.size()], array.readout, acquisitions, random));
    ++kind;
  }
  return column;
}

/// The bus as hexadecimal digits, column 0 in the lowest bits.
std::string bus_digits(std::span<const Timestamp> timestamps, int np) {
  const std::size_t bits = timestamps.size() * static_cast<std::size_t>(np);
  std::string digits((bits + kBitsPerDigit - 1) / kBitsPerDigit, '0');
  for (std::size_t digit = 0; digit < digits.size(); ++digit) {
    unsigned value = 0;
    for (std::size_t bit = 0; bit < kBitsPerDigit; ++bit) {
      const std::size_t position = digit * kBitsPerDigit + bit;
      if (position < bits) {
        const auto timestamp = static_cast<unsigned>(timestamps[position / static_cast<std::size_t>(np)]);
        value |= (timestamp >> (position % static_cast<std::size_t>(np)) & 1U) << bit;
      }
    }
    digits[digits.size() - 1 - digit] = "0123456789abcdef"[value];
  }
  return digits;
}

/// `print(text)`: writes a line's end, too.
template <typename Print>
void write_timestamps(const Print& print, const ArrayParameters& array, std::span<const ColumnStream> columns,
                      std::uint32_t acquisitions) {
  const auto slots = static_cast<std::size_t>(array.readout.slots);
  std::vector<std::size_t> next(columns.size() * static_cast<std::size_t>(array.rows), 0);
  std::vector<Timestamp> lines(slots * columns.size());  // of a pixel, slot by slot
  for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
    for (int row = 0; row < array.rows; ++row) {
      std::ranges::fill(lines, static_cast<Timestamp>(array.readout.no_detection()));
      for (std::size_t column = 0; column < columns.size(); ++column) {
        const std::span<const Detection> detections = columns[column].row(row);
        std::size_t& cursor = next[static_cast<std::size_t>(row) * columns.size() + column];
        for (std::size_t slot = 0;
             cursor < detections.size() && detections[cursor].acquisition == acquisition; ++slot) {
          lines[slot * columns.size() + column] = detections[cursor].timestamp;
          ++cursor;
        }
      }
      for (std::size_t slot = 0; slot < slots; ++slot) {
        print(fmt::format("{}\n", bus_digits(std::span(lines).subspan(slot * columns.size(), columns.size()),
                                             array.readout.np)));
      }
    }
  }
}

/// The array as the bench drives it: in each frame of a pool read-out with TIME_GATE = 1 the gate leaves out
/// the first and the last eighth of the range.
ArrayParameters as_in_bench(ArrayParameters array) {
  ReadoutParameters& readout = array.readout;
  if (is_pool_readout(readout.readout) && readout.time_gate) {
    const std::int32_t eighth = 1 << (readout.np - 3);
    readout.time_gate = CodeGate{.begin = eighth, .end = (1 << readout.np) - eighth};
  }
  return array;
}

/// The detections inside the gate.
std::vector<ColumnStream> gated(std::span<const ColumnStream> columns, const CodeGate& gate) {
  std::vector<ColumnStream> kept(columns.size());
  for (std::size_t column = 0; column < columns.size(); ++column) {
    for (int row = 0; row < columns[column].rows(); ++row) {
      for (const Detection& detection : columns[column].row(row)) {
        if (gate.contains(detection.timestamp)) {
          kept[column].append(detection);
        }
      }
      kept[column].finish_row();
    }
  }
  return kept;
}

using Results = std::vector<std::vector<PixelResult>>;  ///< column, row

Results results_of(const ArrayParameters& array, std::span<const ColumnStream> columns,
                   std::uint32_t acquisitions) {
  return make_readout_model(array.readout)->run_columns(columns, acquisitions);
}

/// Results of an array with PRIOR = 1. `priors` is what the frame begins from and, afterwards, what the frame
/// leaves.
Results results_of(const ArrayParameters& array, std::span<const ColumnStream> columns,
                   std::uint32_t acquisitions, std::vector<PoolPrior>& priors) {
  const std::vector<ColumnStream> kept =
      array.readout.time_gate ? gated(columns, *array.readout.time_gate) : std::vector<ColumnStream>{};
  const auto column = [&](int index) -> const ColumnStream& {
    return (kept.empty() ? columns : std::span(kept))[static_cast<std::size_t>(index)];
  };
  return run_pool_pointer(array.columns, column, array.readout.np, acquisitions,
                          pool_pointer_parameters(array.readout), &priors);
}

template <typename Print>
void write_results(const Print& print, const ArrayParameters& array, const Results& results) {
  for (int row = 0; row < array.rows; ++row) {
    for (const std::vector<PixelResult>& column : results) {
      const PixelResult& result = column[static_cast<std::size_t>(row)];
      print(fmt::format("{:04x}{:04x}{:04x}\n", result.code, result.fraction, result.confidence));
    }
  }
}

/// The three files of write_vectors().
class VectorFiles {
 public:
  explicit VectorFiles(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
      throw InputError(fmt::format("{}: cannot make the folder ({})", folder.string(), error.message()));
    }
    frames_.emplace(fmt::output_file((folder / "frames.txt").string()));
    timestamps_.emplace(fmt::output_file((folder / "timestamps.hex").string()));
    results_.emplace(fmt::output_file((folder / "results.hex").string()));
  }

  void write(const ArrayParameters& array, std::uint32_t acquisitions,
             const std::array<std::uint32_t, 3>& settings, int pause, int stall, bool reset,
             std::span<const ColumnStream> columns, const Results& results) {
    frames_->print("{} {} {} {} {} {} {}\n", acquisitions, settings[0], settings[1], settings[2], pause,
                   stall, reset ? 1 : 0);
    write_timestamps([this](const std::string& line) { timestamps_->print("{}", line); }, array, columns,
                     acquisitions);
    write_results([this](const std::string& line) { results_->print("{}", line); }, array, results);
  }

 private:
  std::optional<fmt::ostream> frames_;
  std::optional<fmt::ostream> timestamps_;
  std::optional<fmt::ostream> results_;
};

constexpr std::uint32_t kPriorSetting = 2;  // beside S1's switch
constexpr std::uint32_t kTemplateSetting = 4;

/// What the bench drives where a frame asks for a template.
PoolTemplate bench_template() {
  PoolTemplate taken{};
  for (std::size_t i = 0; i < taken.size(); ++i) {
    taken[i] = static_cast<std::uint8_t>(255U >> (i / 2));
  }
  return taken;
}

/// The third is S1's switch.
std::array<std::uint32_t, 3> schedule_settings(const ReadoutParameters& readout, std::uint32_t acquisitions) {
  const PoolSchedule schedule(acquisitions, readout.pool);
  return {schedule.coarse_end, schedule.track_end, readout.pool.smooth ? 1U : 0U};
}

}  // namespace

std::vector<ColumnStream> random_columns(const ArrayParameters& array, std::uint32_t acquisitions,
                                         std::size_t& kind, CounterRandom& random) {
  if (acquisitions >= kLongFrame) {
    kind = static_cast<std::size_t>(StreamKind::kConstant);  // counters saturate
  }
  const bool pool = is_pool_readout(array.readout.readout);
  std::vector<ColumnStream> columns;
  columns.reserve(static_cast<std::size_t>(array.columns));
  for (int column = 0; column < array.columns; ++column) {
    columns.push_back(pool && column % 2 == 0 ? surface_column(array, acquisitions, random)
                                              : adversarial_column(array, acquisitions, kind, random));
  }
  return columns;
}

void write_vectors(const ArrayParameters& array, std::span<const std::uint32_t> frames, std::uint64_t seed,
                   const std::filesystem::path& folder) {
  constexpr std::array<int, 4> kPauses = {0, 10, 40, 75};
  constexpr std::array<int, 4> kStalls = {0, 20, 60, 90};
  CounterRandom random(seed, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  VectorFiles files(folder);
  ArrayParameters frame_array = as_in_bench(array);
  const bool pool = is_pool_readout(array.readout.readout);
  const bool has_prior = pool && array.readout.pool.prior;
  std::vector<PoolPrior> priors;
  std::size_t kind = 0;
  for (const std::uint32_t acquisitions : frames) {
    std::array<std::uint32_t, 3> settings{};
    if (pool) {
      frame_array.readout.pool.smooth = pick(random, 2) != 0;
      const bool with_template = pick(random, 2) != 0;
      frame_array.readout.pool.coarse_template = with_template ? bench_template() : PoolTemplate{};
      settings = schedule_settings(frame_array.readout, acquisitions);
      settings[2] |= with_template ? kTemplateSetting : 0;
    } else if (array.readout.time_gate) {
      const int codes = array.readout.code_count();
      const CodeGate gate{.begin = pick(random, codes), .end = pick(random, codes)};
      frame_array.readout.time_gate = gate;
      settings = {static_cast<std::uint32_t>(gate.begin), static_cast<std::uint32_t>(gate.end), 0};
    }
    const int pause = acquisitions < kLongFrame
                          ? kPauses[static_cast<std::size_t>(pick(random, kPauses.size()))]
                          : kPauses[1];
    const int stall = kStalls[static_cast<std::size_t>(pick(random, kStalls.size()))];
    bool reset = acquisitions >= kShortestFrameToReset && acquisitions < kLongFrame;
    const std::vector<ColumnStream> columns = random_columns(frame_array, acquisitions, kind, random);
    if (!has_prior) {
      files.write(frame_array, acquisitions, settings, pause, stall, reset, columns,
                  results_of(frame_array, columns, acquisitions));
      continue;
    }
    // After a reset there is no last frame.
    reset = reset && pick(random, 3) == 0;
    if (pick(random, 4) == 0) {
      priors.clear();
    } else {
      settings[2] |= kPriorSetting;
    }
    files.write(frame_array, acquisitions, settings, pause, stall, reset, columns,
                results_of(frame_array, columns, acquisitions, priors));
    if (reset) {
      priors.clear();
    }
  }
}

void write_scene_vectors(const ArrayParameters& array, Scene scene, double klux,
                         std::span<const std::uint32_t> frames, std::uint64_t seed,
                         const std::filesystem::path& folder) {
  SensorModel sensor = parse_preset("thesis");
  sensor.np = array.readout.np;
  sensor.slots = array.readout.slots;
  SceneParameters parameters;
  parameters.rows = array.rows;
  parameters.columns = std::max(parameters.columns, array.columns);
  const TargetMap targets = make_scene(scene, parameters);
  const int first = (parameters.columns - array.columns) / 2;
  VectorFiles files(folder);
  std::uint32_t number = 0;
  for (const std::uint32_t acquisitions : frames) {
    sensor.acquisitions = acquisitions;
    const PhotonSource source(sensor, targets, klux, seed, number);
    ++number;
    std::vector<ColumnStream> columns;
    columns.reserve(static_cast<std::size_t>(array.columns));
    for (int column = 0; column < array.columns; ++column) {
      columns.push_back(source.column(first + column));
    }
    std::array<std::uint32_t, 3> settings{};
    if (is_pool_readout(array.readout.readout)) {
      settings = schedule_settings(array.readout, acquisitions);
    } else if (array.readout.time_gate) {
      settings = {0, static_cast<std::uint32_t>(array.readout.code_count() - 1), 0};
    }
    files.write(array, acquisitions, settings, 0, 0, false, columns,
                results_of(as_in_bench(array), columns, acquisitions));
  }
}

FrameVectors source_vectors(const ArrayParameters& array, const StreamSource& source) {
  std::vector<ColumnStream> columns;
  columns.reserve(static_cast<std::size_t>(array.columns));
  for (int column = 0; column < array.columns; ++column) {
    columns.push_back(source.column(column));
  }
  const std::vector<PixelResult> frame = run_frame(source, array.readout);
  Results results(static_cast<std::size_t>(array.columns));
  for (std::size_t pixel = 0; pixel < frame.size(); ++pixel) {
    results[pixel % results.size()].push_back(frame[pixel]);
  }
  FrameVectors vectors;
  write_timestamps([&](const std::string& line) { vectors.timestamps += line; }, array, columns,
                   source.acquisitions());
  write_results([&](const std::string& line) { vectors.results += line; }, array, results);
  return vectors;
}

}  // namespace dtof
