// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/rivals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/design/bench_counts.hpp"
#include "dtof/design/sram_macro.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/pipeline/region.hpp"
#include "dtof/rival/rival_reader.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kEarlierFrames = 3'000'000;  // frames before a measured frame

/// Measurements of a scene's pixels: row-major for each rival.
using Measurements = std::vector<std::vector<Measurement>>;

/// Lowest threshold above 0 that at most `share` of the sky's pixels reach.
double sky_threshold(std::vector<double> confidences, double share) {
  std::ranges::sort(confidences, std::greater<>());
  const auto passing = static_cast<std::size_t>(share * static_cast<double>(confidences.size()));
  const double highest_refused = passing < confidences.size() ? confidences[passing] : 0.0;
  return std::nextafter(std::max(highest_refused, 0.0), std::numeric_limits<double>::infinity());
}

class RivalBench {
 public:
  RivalBench(const BenchSettings& settings, std::span<RivalOption> options, const BenchEffort& effort,
             Progress* progress)
      : settings_(settings),
        options_(options),
        effort_(effort),
        progress_(progress),
        region_{bench_columns(settings.sensor, effort.pixels), {0, settings.sensor.rows}} {
    for (const RivalOption& option : options) {
      rivals_.push_back(option.entry->make(settings.sensor));
    }
    for (const Scene scene : settings.scenes) {
      targets_.push_back(scaled_scene(scene, settings.sensor, settings.seed));
    }
  }

  void run() {
    std::vector<double> thresholds(rivals_.size(), 0.0);
    std::vector<Measurements> held_out;
    for (const double klux : settings_.klux) {
      if (effort_.detection) {
        Measurements set_by = sky(klux, kSkyFrame);
        for (std::size_t r = 0; r < rivals_.size(); ++r) {
          std::vector<double> confidences;
          for (const Measurement& pixel : set_by[r]) {
            confidences.push_back(pixel.confidence);
          }
          thresholds[r] =
              std::max(thresholds[r], sky_threshold(std::move(confidences), settings_.false_alarms));
        }
        held_out.push_back(sky(klux, kHeldOutSky));
      }
    }
    for (std::size_t light = 0; light < settings_.klux.size(); ++light) {
      add_light(settings_.klux[light], thresholds);
      for (std::size_t r = 0; effort_.detection && r < rivals_.size(); ++r) {
        const std::vector<Measurement>& pixels = held_out[light][r];
        const auto passing = std::ranges::count_if(
            pixels, [&](const Measurement& pixel) { return pixel.confidence >= thresholds[r]; });
        options_[r].score.lights.back().false_alarms =
            estimate_rare_share(static_cast<std::uint64_t>(passing), pixels.size());
      }
    }
  }

 private:
  /// Reads some columns of targets in a frame.
  [[nodiscard]] Measurements read(const SensorModel& sensor, const TargetMap& targets, double klux,
                                  std::uint32_t frame, std::span<const int> columns) {
    std::vector<std::uint32_t> frames;
    const std::size_t of_a_result = most_frames(rivals_);
    for (std::size_t before = of_a_result; before-- > 1;) {
      frames.push_back(kEarlierFrames + frame * static_cast<std::uint32_t>(of_a_result) +
                       static_cast<std::uint32_t>(before));
    }
    frames.push_back(frame);
    const RivalReader reader(sensor, targets, klux, settings_.seed, std::move(frames), rivals_);
    const auto rows = static_cast<std::size_t>(targets.rows());
    Measurements found(rivals_.size(), std::vector<Measurement>(columns.size() * rows));
    parallel_for(columns.size(), settings_.threads, [&](std::size_t index) {
      const std::vector<std::vector<RivalWords>> words = reader.column(columns[index]);
      for (std::size_t r = 0; r < rivals_.size(); ++r) {
        for (std::size_t row = 0; row < rows; ++row) {
          found[r][row * columns.size() + index] = rivals_[r]->decode(words[r][row]);
        }
      }
    });
    if (progress_ != nullptr) {
      progress_->advance();
    }
    check_interruption();
    return found;
  }

  [[nodiscard]] Measurements sky(double klux, std::uint32_t first_frame) {
    const SensorModel& sensor = settings_.sensor;
    const TargetMap nothing(sensor.columns, sensor.rows, {0.0, sensor.default_reflectivity});
    const std::uint32_t frames =
        sky_frames(settings_, region_.columns.size() * static_cast<std::size_t>(sensor.rows));
    Measurements all(rivals_.size());
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
      const Measurements found = read(sensor, nothing, klux, first_frame + frame, region_.columns);
      for (std::size_t r = 0; r < rivals_.size(); ++r) {
        all[r].insert(all[r].end(), found[r].begin(), found[r].end());
      }
    }
    return all;
  }

  /// Look-up tables as flat_tables() has them for read-outs.
  [[nodiscard]] std::vector<RangeConverter> tables(double klux) {
    const SensorModel calibrated = settings_.sensor.as_calibrated();
    const FlatCalibration calibration(calibrated);
    std::vector<int> columns;
    for (std::size_t distance = 0; distance < calibration.distances_m().size(); ++distance) {
      columns.push_back(calibration.column(distance));
    }
    std::vector<RangeConverter> fitted;
    for (const std::vector<Measurement>& pixels :
         read(calibrated, calibration.targets(), klux, FlatCalibration::kFrame, columns)) {
      fitted.push_back(calibration.fit(pixels, 0.0, settings_.seed));
    }
    return fitted;
  }

  void add_light(double klux, std::span<const double> thresholds) {
    const std::vector<RangeConverter> converters = tables(klux);
    std::vector<LightCounts> counts(rivals_.size());
    for (int frame = 0; frame < effort_.frames; ++frame) {
      std::vector<FrameCounts> sums(rivals_.size());
      for (const TargetMap& targets : targets_) {
        const std::uint32_t number = scene_frame(static_cast<std::uint32_t>(frame));
        const Measurements found = read(settings_.sensor, targets, klux, number, region_.columns);
        const FrameTruth truth = frame_truth(targets, settings_.sensor, region_.columns, region_.rows);
        const std::vector<double> skews = skew_bins(targets.columns());
        for (std::size_t r = 0; r < rivals_.size(); ++r) {
          add(sums[r], found[r], converters[r], truth, skews, thresholds[r]);
        }
      }
      for (std::size_t r = 0; r < rivals_.size(); ++r) {
        counts[r].add(sums[r]);
      }
    }
    for (std::size_t r = 0; r < rivals_.size(); ++r) {
      options_[r].score.pixels = counts[r].pixels();
      options_[r].score.lights.push_back(counts[r].score(klux, effort_.detection));
    }
  }

  /// Timing skew in bins of the region's pixels, row-major, which the host knows; empty without any.
  [[nodiscard]] std::vector<double> skew_bins(int columns) const {
    std::vector<double> skews;
    const SensorModel& sensor = settings_.sensor;
    const TimingSkew& skew = sensor.surroundings.skew;
    for (int row = 0; !skew.none() && row < sensor.rows; ++row) {
      for (const int column : region_.columns) {
        skews.push_back(skew.of_pixel(column, row, columns) / sensor.time_resolution_s());
      }
    }
    return skews;
  }

  static void add(FrameCounts& counts, std::span<const Measurement> pixels, const RangeConverter& converter,
                  const FrameTruth& truth, std::span<const double> skews, double threshold) {
    ErrorStatistics errors;
    RunningMoments squares;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (std::isnan(truth.metres[i])) {
        continue;
      }
      const double metres = converter.distance(pixels[i].position - (skews.empty() ? 0.0 : skews[i]));
      const double error = metres - truth.metres[i];
      errors.add(truth.metres[i], metres);
      squares.add(error);
      counts.detected +=
          pixels[i].confidence >= threshold && std::abs(error) <= kRight * truth.metres[i] ? 1 : 0;
    }
    counts.add(errors, squares.mean_square());
  }

  const BenchSettings& settings_;
  std::span<RivalOption> options_;
  BenchEffort effort_;
  Progress* progress_;
  Region region_;
  std::vector<std::unique_ptr<Rival>> rivals_;
  std::vector<TargetMap> targets_;
};

}  // namespace

std::optional<double> rival_memory_mm2(const RivalHardware& hardware, const SensorModel& sensor) {
  constexpr int kMostMacros = 16;  // side by side
  std::optional<double> least;
  for (int macros = 1; macros <= std::min(kMostMacros, hardware.word_bits); ++macros) {
    const int bits = (hardware.word_bits + macros - 1) / macros;
    try {
      const SramMacro macro = sram_macro({hardware.words == 1 ? 1 : 2, sensor.rows * hardware.words, bits});
      const double mm2 = 1e-6 * sensor.columns * macros * macro.area_um2;
      least = std::min(least.value_or(mm2), mm2);
    } catch (const InputError&) {
      continue;  // wider words may have a macro where narrower ones have none
    }
  }
  return least;
}

RivalChoice choose_rivals(std::span<const RivalEntry> rivals, const SensorModel& sensor, double most_mm2) {
  RivalChoice choice;
  for (const RivalEntry& entry : rivals) {
    try {
      const std::unique_ptr<Rival> rival = entry.make(sensor);
      const std::optional<double> mm2 = rival_memory_mm2(rival->hardware(), sensor);
      if (!mm2) {
        choice.left_out.push_back({&entry, "with a memory that cannot be made"});
      } else if (*mm2 > most_mm2) {
        choice.left_out.push_back({&entry, fmt::format("its memory alone takes {:.2f} mm2", *mm2)});
      } else {
        choice.options.push_back({.entry = &entry,
                                  .bits_per_pixel = rival->bits_per_pixel(),
                                  .frames = rival->frames(),
                                  .memory_mm2 = *mm2,
                                  .score = {}});
      }
    } catch (const InputError& error) {
      choice.left_out.push_back({&entry, error.what()});
    }
  }
  return choice;
}

std::size_t rival_steps(const BenchSettings& settings, const BenchEffort& effort) {
  const std::size_t columns = bench_columns(settings.sensor, effort.pixels).size();
  const std::size_t skies =
      effort.detection ? 2 * sky_frames(settings, columns * static_cast<std::size_t>(settings.sensor.rows))
                       : 0;
  return settings.klux.size() *
         (1 + skies + settings.scenes.size() * static_cast<std::size_t>(effort.frames));
}

void read_rivals(const BenchSettings& settings, std::span<RivalOption> options, const BenchEffort& effort,
                 Progress* progress) {
  if (!options.empty()) {
    RivalBench(settings, options, effort, progress).run();
  }
}

}  // namespace dtof
