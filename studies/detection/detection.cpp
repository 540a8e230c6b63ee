// SPDX-License-Identifier: Apache-2.0
#include "detection/detection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "common/engine_frame.hpp"
#include "common/percent_text.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/confidence_counts.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {
namespace {

constexpr double kRight = 0.10;
// Seeds of the skies: those that set the thresholds, and those that are held out.
constexpr std::uint64_t kSkySeeds = 2'000'000;
constexpr std::uint64_t kHeldOutSeeds = 3'000'000;
constexpr double kShownKlux = 50.0;

struct PixelCounts {
  ConfidenceCounts right;
  ConfidenceCounts wrong;
};

/// Each read-out's counts of one frame that looks at one target everywhere.
std::vector<PixelCounts> count_pixels(const DetectionSettings& settings, PixelTarget target, double klux,
                                      std::uint64_t seed) {
  const SensorModel& sensor = settings.sensor;
  const PhotonSource source(sensor, TargetMap(engine_columns_read(), sensor.rows, target), klux, seed);
  const std::vector<EngineResults> results = read_engine(source, settings.readouts);
  // A pulse's mean is its width behind the way there and back (spec section 4). 10 % is far more than walk.
  const double exact =
      (2.0 * target.depth_m / kSpeedOfLight + sensor.pulse_fwhm_s) / sensor.time_resolution_s();
  const double range = 2.0 * target.depth_m / kSpeedOfLight / sensor.time_resolution_s();
  std::vector<PixelCounts> counts(settings.readouts.size());
  for (std::size_t r = 0; r < counts.size(); ++r) {
    for (int column = 0; column < engine_columns_judged(); ++column) {
      for (const PixelResult& result : results[r][static_cast<std::size_t>(column)]) {
        const Measurement measured = to_measurement(result, settings.readouts[r].fraction_bits);
        const bool right = target.returns_signal() && std::abs(measured.position - exact) <= kRight * range;
        ++(right ? counts[r].right : counts[r].wrong)[static_cast<int>(measured.confidence)];
      }
    }
  }
  return counts;
}

void validate(const DetectionSettings& settings) {
  if (settings.readouts.empty() || settings.klux.empty() || settings.sky_reflectivities.empty() ||
      settings.distances_m.empty()) {
    throw InputError("detection: needs a read-out, a light, a sky and a distance");
  }
  if (settings.seeds < 2) {
    throw InputError(fmt::format("detection: an interval needs at least 2 seeds, not {}", settings.seeds));
  }
  // Written so that a NaN fails.
  if (!(settings.false_alarms > 0.0 && settings.false_alarms < 1.0)) {
    throw InputError(fmt::format("detection: the share of false alarms must be above 0 and below 1, not {}",
                                 settings.false_alarms));
  }
  if (settings.sensor.columns < engine_columns_read()) {
    throw InputError(fmt::format("detection: {} columns are read, but the sensor has {}",
                                 engine_columns_read(), settings.sensor.columns));
  }
}

/// Counts of `seeds` frames of each target and light, by index target-first within a light.
std::vector<std::vector<std::vector<PixelCounts>>> measure(const DetectionSettings& settings,
                                                           const std::vector<PixelTarget>& targets,
                                                           std::uint64_t first_seed, Progress& progress) {
  const auto seeds = static_cast<std::size_t>(settings.seeds);
  const std::size_t cells = settings.klux.size() * targets.size();
  std::vector<std::vector<std::vector<PixelCounts>>> counts(cells,
                                                            std::vector<std::vector<PixelCounts>>(seeds));
  parallel_for(cells * seeds, settings.threads, [&](std::size_t index) {
    const std::size_t cell = index / seeds;
    counts[cell][index % seeds] =
        count_pixels(settings, targets[cell % targets.size()], settings.klux[cell / targets.size()],
                     first_seed + index % seeds);
    progress.advance(1);
  });
  return counts;
}

std::vector<PixelTarget> skies(const DetectionSettings& settings) {
  std::vector<PixelTarget> targets;
  for (const double reflectivity : settings.sky_reflectivities) {
    targets.push_back({0.0, reflectivity});
  }
  return targets;
}

constexpr double kMost = 0.9;

/// "poolPointer to 5 m" of each read-out that detects most pixels of some wall at the light.
std::vector<std::string> reaches(const std::vector<ReadoutDetection>& study, double klux) {
  std::vector<std::string> found;
  for (const ReadoutDetection& readout : study) {
    double farthest = 0.0;
    for (const DetectionCell& cell : readout.cells) {
      if (cell.klux == klux && cell.detected.value >= kMost) {
        farthest = std::max(farthest, cell.distance_m);
      }
    }
    if (farthest > 0.0) {
      found.push_back(fmt::format("{} to {:g} m", readout_title(readout.readout), farthest));
    }
  }
  return found;
}

PageData answer(const std::vector<ReadoutDetection>& study, double klux) {
  const std::vector<std::string> readouts = reaches(study, klux);
  std::optional<PageData> detected;
  if (!readouts.empty()) {
    detected = PageData().set("by_readouts", "{}", fmt::join(readouts, ", "));
  }
  return PageData()
      .set("klux", "{:g}", klux)
      .set("percent", "{:g}", 100.0 * kMost)
      .part("detected", std::move(detected));
}

std::string title_of(const ReadoutDetection& readout) { return std::string(readout_title(readout.readout)); }

Table thresholds_table(const std::vector<ReadoutDetection>& study) {
  Table table({"read-out", "threshold", "most false alarms of a held-out sky, in 1e-3"});
  for (const ReadoutDetection& readout : study) {
    table.add({title_of(readout), fmt::format("{}", readout.threshold),
               fmt::format("{:.2f}", 1e3 * std::ranges::max(readout.held_out_alarms))});
  }
  return table;
}

Table walls_table(const DetectionSettings& settings, const std::vector<ReadoutDetection>& study,
                  double klux) {
  std::vector<std::string> header = {"read-out"};
  for (const double distance : settings.distances_m) {
    header.push_back(fmt::format("{:g} m", distance));
  }
  Table table(std::move(header));
  for (const ReadoutDetection& readout : study) {
    std::vector<std::string> row = {title_of(readout)};
    for (const DetectionCell& cell : readout.cells) {
      if (cell.klux == klux) {
        row.push_back(fmt::format("{:.2f} / {:.2f}", 100.0 * cell.detected.value, 100.0 * cell.right.value));
      }
    }
    table.add(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<ReadoutDetection> run_detection(const DetectionSettings& settings) {
  validate(settings);
  std::vector<PixelTarget> walls;
  for (const double distance : settings.distances_m) {
    walls.push_back({distance, settings.wall_reflectivity});
  }
  const std::size_t sky_cells = settings.klux.size() * settings.sky_reflectivities.size();
  Progress progress("detection", (2 * sky_cells + settings.klux.size() * walls.size()) *
                                     static_cast<std::size_t>(settings.seeds));
  const auto sky = measure(settings, skies(settings), settings.seed + kSkySeeds, progress);
  const auto held_out = measure(settings, skies(settings), settings.seed + kHeldOutSeeds, progress);
  const auto wall = measure(settings, walls, settings.seed, progress);
  std::vector<ReadoutDetection> study;
  for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
    ReadoutDetection readout;
    readout.readout = settings.readouts[r].readout;
    const auto pooled = [&](const std::vector<std::vector<PixelCounts>>& seeds) {
      ConfidenceCounts sum;
      for (const std::vector<PixelCounts>& counts : seeds) {
        for (const auto& [confidence, pixels] : counts[r].wrong) {
          sum[confidence] += pixels;
        }
      }
      return sum;
    };
    for (const auto& seeds : sky) {
      readout.threshold = std::max(readout.threshold, lowest_threshold(pooled(seeds), settings.false_alarms));
    }
    for (const auto& seeds : held_out) {
      const auto counts = pooled(seeds);
      readout.held_out_alarms.push_back(static_cast<double>(count_from(counts, readout.threshold)) /
                                        static_cast<double>(count_from(counts, 0)));
    }
    for (std::size_t cell = 0; cell < wall.size(); ++cell) {
      std::vector<double> detected;
      std::vector<double> right;
      std::uint64_t pixels = 0;
      for (const std::vector<PixelCounts>& counts : wall[cell]) {
        pixels = count_from(counts[r].right, 0) + count_from(counts[r].wrong, 0);
        detected.push_back(static_cast<double>(count_from(counts[r].right, readout.threshold)) /
                           static_cast<double>(pixels));
        right.push_back(static_cast<double>(count_from(counts[r].right, 0)) / static_cast<double>(pixels));
      }
      readout.cells.push_back({.klux = settings.klux[cell / walls.size()],
                               .distance_m = walls[cell % walls.size()].depth_m,
                               .detected = estimate_share_of_frames(detected, pixels),
                               .right = estimate_share_of_frames(right, pixels)});
    }
    study.push_back(std::move(readout));
  }
  return study;
}

PageData detection_page(const DetectionSettings& settings, const std::vector<ReadoutDetection>& study,
                        const std::string& command_line) {
  std::vector<PageData> answers;
  std::vector<PageData> lights;
  for (const double klux : settings.klux) {
    answers.push_back(answer(study, klux));
    lights.push_back(
        PageData().set("klux", "{:g}", klux).set("pixels_of_walls", walls_table(settings, study, klux)));
  }
  PageData data;
  data.set("sensor", "{}", settings.sensor.name)
      .set("false_alarms", "{:g}", settings.false_alarms)
      .set("least_klux", "{:g}", std::ranges::min(settings.klux))
      .set("most_klux", "{:g}", std::ranges::max(settings.klux))
      .set("darkest_sky", "{:g}", std::ranges::min(settings.sky_reflectivities))
      .set("brightest_sky", "{:g}", std::ranges::max(settings.sky_reflectivities))
      .set("wall_reflectivity", "{:g}", settings.wall_reflectivity)
      .list("answers", std::move(answers))
      .set("thresholds", thresholds_table(study))
      .list("lights", std::move(lights))
      .set("seeds", "{}", settings.seeds)
      .set("columns", "{}", engine_columns_judged())
      .set("rows", "{}", settings.sensor.rows)
      .set("skies", "{}", settings.klux.size() * settings.sky_reflectivities.size())
      .set("command", "{}", command_line);
  return data;
}

Table detection_csv(const std::vector<ReadoutDetection>& study) {
  Table table({"readout", "threshold", "klux", "distance_m", "detected", "detected_low", "detected_high",
               "right", "right_low", "right_high"});
  for (const ReadoutDetection& readout : study) {
    for (const DetectionCell& cell : readout.cells) {
      std::vector<std::string> row = {std::string(readout_name(readout.readout)),
                                      fmt::format("{}", readout.threshold), fmt::format("{:g}", cell.klux),
                                      fmt::format("{:g}", cell.distance_m)};
      for (const Estimate& estimate : {cell.detected, cell.right}) {
        for (const double value : {estimate.value, estimate.interval.low, estimate.interval.high}) {
          row.push_back(fmt::format("{:.6f}", value));
        }
      }
      table.add(std::move(row));
    }
  }
  return table;
}

double detection_klux(const DetectionSettings& settings) {
  return *std::ranges::min_element(settings.klux, {},
                                   [](double klux) { return std::abs(klux - kShownKlux); });
}

std::vector<PlotSeries> detection_curves(const DetectionSettings& settings,
                                         const std::vector<ReadoutDetection>& study) {
  const double shown = detection_klux(settings);
  std::vector<PlotSeries> curves;
  for (const ReadoutDetection& readout : study) {
    PlotSeries curve{title_of(readout), {}, {}};
    for (const DetectionCell& cell : readout.cells) {
      if (cell.klux == shown) {
        curve.x.push_back(cell.distance_m);
        curve.y.push_back(100.0 * cell.detected.value);
      }
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace dtof
