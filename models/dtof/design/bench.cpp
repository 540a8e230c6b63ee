// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/bench.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/design/candidates.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/metrics/confidence_counts.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

// Frames of the sky: those that set thresholds, and those that are held out.
constexpr std::uint32_t kSkyFrame = 1'000'000;
constexpr std::uint32_t kHeldOutSky = 2'000'000;
constexpr double kSkyPixelsPassing = 10.0;  // at least, in the mean, at the threshold
constexpr double kRight = 0.10;

double range_s(const SensorModel& sensor) { return sensor.integration_time_s - sensor.pulse_fwhm_s; }

/// Counts of one read-out in one light.
struct Counts {
  std::vector<double> above_3;  // share of each frame's pixels
  std::vector<double> above_10;
  std::vector<double> detected;
  double squares = 0.0;
  std::uint64_t pixels = 0;  // of all frames
};

struct Sky {
  ConfidenceCounts set_by;
  ConfidenceCounts held_out;
};

bool has_confidence(const ReadoutParameters& parameters) {
  return !is_pointer_readout(parameters.readout) || parameters.confidence_width > 0;
}

/// Shares of one scene's pixels in one frame.
struct SceneCounts {
  std::uint64_t pixels = 0;
  std::uint64_t above_3 = 0;
  std::uint64_t above_10 = 0;
  std::uint64_t detected = 0;
  double squares = 0.0;

  void add(const MeasuredFrame& frame, const FrameTruth& truth, std::optional<int> threshold) {
    const FrameFigures& figures = frame.maps.figures;
    if (figures.errors.count() == 0) {
      return;
    }
    const ErrorSummary errors = figures.errors.summary();
    const auto count = static_cast<double>(errors.count);
    pixels += errors.count;
    above_3 += static_cast<std::uint64_t>(std::llround(errors.share_above_3_percent * count));
    above_10 += static_cast<std::uint64_t>(std::llround(errors.share_above_10_percent * count));
    squares += frame.maps.mean_square * count;
    for (std::size_t i = 0; threshold && i < truth.metres.size(); ++i) {
      // Comparisons with an unknown error or distance are false.
      detected += frame.run.results[i].confidence >= *threshold &&
                          std::abs(frame.maps.error[i]) <= kRight * truth.metres[i]
                      ? 1
                      : 0;
    }
  }
};

/// Read-outs that take as many slots see the same photons.
class SlotsBench {
 public:
  SlotsBench(const BenchSettings& settings, std::vector<ReadoutParameters> readouts,
             const BenchEffort& effort, Progress* progress)
      : settings_(settings),
        sensor_(with_slots(settings.sensor, readouts.front().slots)),
        readouts_(std::move(readouts)),
        effort_(effort),
        progress_(progress),
        region_{bench_columns(sensor_, effort.pixels), {0, sensor_.rows}},
        engine_(
            {.threads = settings.threads, .own_rows = true, .observer = [](std::size_t, std::size_t) {}}) {
    for (const Scene scene : settings.scenes) {
      targets_.push_back(scaled_scene(scene, sensor_, settings.seed));
      require_reachable(targets_.back(), sensor_, "design: the scene " + std::string(scene_name(scene)));
    }
  }

  [[nodiscard]] std::vector<ReadoutScore> run() {
    std::vector<ReadoutScore> scores(readouts_.size());
    std::vector<std::vector<Sky>> skies(settings_.klux.size(), std::vector<Sky>(readouts_.size()));
    if (effort_.detection) {
      for (std::size_t light = 0; light < settings_.klux.size(); ++light) {
        look_at_sky(settings_.klux[light], kSkyFrame, skies[light], &Sky::set_by);
        look_at_sky(settings_.klux[light], kHeldOutSky, skies[light], &Sky::held_out);
      }
      for (std::size_t r = 0; r < readouts_.size(); ++r) {
        for (std::size_t light = 0; has_confidence(readouts_[r]) && light < skies.size(); ++light) {
          scores[r].threshold = std::max(scores[r].threshold.value_or(1),
                                         lowest_threshold(skies[light][r].set_by, settings_.false_alarms));
        }
      }
    }
    for (std::size_t light = 0; light < settings_.klux.size(); ++light) {
      add_light(settings_.klux[light], skies[light], scores);
    }
    return scores;
  }

 private:
  void advance(std::size_t steps = 1) {
    if (progress_ != nullptr) {
      progress_->advance(steps);
    }
    check_interruption();
  }

  /// So many frames that the share of false alarms shows.
  [[nodiscard]] std::uint32_t sky_frames() const {
    const double pixels = static_cast<double>(region_.columns.size()) * sensor_.rows;
    return static_cast<std::uint32_t>(std::ceil(kSkyPixelsPassing / settings_.false_alarms / pixels));
  }

  void look_at_sky(double klux, std::uint32_t first_frame, std::vector<Sky>& skies,
                   ConfidenceCounts Sky::*counts) {
    const TargetMap sky(sensor_.columns, sensor_.rows, {0.0, sensor_.default_reflectivity});
    for (std::uint32_t frame = 0; frame < sky_frames(); ++frame) {
      const FramePipeline pipeline(PhotonSource(sensor_, sky, klux, settings_.seed, first_frame + frame),
                                   engine_,
                                   {.region = region_, .seed = settings_.seed, .threads = settings_.threads});
      for (std::size_t r = 0; r < readouts_.size(); ++r) {
        for (const PixelResult& result : pipeline.measure({readouts_[r], std::nullopt}).run.results) {
          ++(skies[r].*counts)[result.confidence];
        }
      }
      check_interruption();
    }
    advance(readouts_.size());
  }

  void add_light(double klux, const std::vector<Sky>& skies, std::vector<ReadoutScore>& scores) {
    std::vector<Counts> counts(readouts_.size());
    const std::vector<RangeConverter> tables =
        flat_tables(sensor_, klux, Fidelity::kExact, readouts_, settings_.seed, settings_.threads);
    for (int frame = 0; frame < effort_.frames; ++frame) {
      std::vector<SceneCounts> sums(readouts_.size());
      for (const TargetMap& targets : targets_) {
        const FramePipeline pipeline(
            PhotonSource(sensor_, targets, klux, settings_.seed,
                         scene_frame(static_cast<std::uint32_t>(frame))),
            engine_, {.region = region_, .seed = settings_.seed, .threads = settings_.threads});
        for (std::size_t r = 0; r < readouts_.size(); ++r) {
          sums[r].add(pipeline.measure({readouts_[r], tables[r]}), pipeline.truth(), scores[r].threshold);
          advance();
        }
      }
      for (std::size_t r = 0; r < readouts_.size(); ++r) {
        if (sums[r].pixels == 0) {
          throw InputError("design: no pixel of the scenes can be judged");
        }
        const auto pixels = static_cast<double>(sums[r].pixels);
        counts[r].above_3.push_back(static_cast<double>(sums[r].above_3) / pixels);
        counts[r].above_10.push_back(static_cast<double>(sums[r].above_10) / pixels);
        counts[r].detected.push_back(static_cast<double>(sums[r].detected) / pixels);
        counts[r].squares += sums[r].squares;
        counts[r].pixels += sums[r].pixels;
      }
    }
    for (std::size_t r = 0; r < readouts_.size(); ++r) {
      scores[r].pixels = counts[r].pixels / static_cast<std::uint64_t>(effort_.frames);
      scores[r].lights.push_back(score_of(klux, counts[r], skies[r], scores[r]));
    }
  }

  [[nodiscard]] LightScore score_of(double klux, const Counts& counts, const Sky& sky,
                                    const ReadoutScore& score) const {
    const auto share = [&](const std::vector<double>& frames) {
      return frames.size() > 1 ? estimate_share_of_frames(frames, score.pixels)
                               : estimate_share(static_cast<std::uint64_t>(std::llround(
                                                    frames.front() * static_cast<double>(score.pixels))),
                                                score.pixels);
    };
    LightScore light{.klux = klux,
                     .above_3_percent = share(counts.above_3),
                     .above_10_percent = share(counts.above_10),
                     .rmse_m = std::sqrt(counts.squares / static_cast<double>(counts.pixels)),
                     .detected = std::nullopt,
                     .false_alarms = std::nullopt};
    if (score.threshold) {
      light.detected = share(counts.detected);
      light.false_alarms =
          estimate_rare_share(count_from(sky.held_out, *score.threshold), count_from(sky.held_out, 0));
    }
    return light;
  }

  const BenchSettings& settings_;
  SensorModel sensor_;
  std::vector<ReadoutParameters> readouts_;
  BenchEffort effort_;
  Progress* progress_;
  Region region_;
  ModelEngine engine_;
  std::vector<TargetMap> targets_;
};

}  // namespace

TargetMap scaled_scene(Scene scene, const SensorModel& sensor, std::uint64_t seed) {
  SceneParameters parameters;
  parameters.columns = sensor.columns;
  parameters.rows = sensor.rows;
  parameters.reflectivity = sensor.default_reflectivity;
  parameters.seed = seed;
  TargetMap targets = make_scene(scene, parameters);
  const double scale = range_s(sensor) / range_s(parse_preset("thesis"));
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      targets.at(column, row).depth_m *= scale;
    }
  }
  return targets;
}

const LightScore& ReadoutScore::worst() const {
  return *std::ranges::max_element(lights, {},
                                   [](const LightScore& light) { return light.above_3_percent.value; });
}

std::vector<int> bench_columns(const SensorModel& sensor, double pixels) {
  constexpr int kParts = 3;
  const double wanted = std::max(pixels / sensor.rows / kParts, 1.0);
  std::set<int> columns;
  const int of_part = wanted >= sensor.columns ? sensor.columns : static_cast<int>(wanted);
  for (int part = 0; part < kParts; ++part) {
    const int middle = sensor.columns * (2 * part + 1) / (2 * kParts);
    for (int i = 0; i < of_part; ++i) {
      const int column = middle - of_part / 2 + i;
      if (kParts * of_part < sensor.columns && column >= 0 && column < sensor.columns) {
        columns.insert(column);
      }
    }
  }
  if (kParts * of_part >= sensor.columns) {
    for (int column = 0; column < sensor.columns; ++column) {
      columns.insert(column);
    }
  }
  return {columns.begin(), columns.end()};
}

std::vector<ReadoutScore> run_bench(const BenchSettings& settings,
                                    std::span<const ReadoutParameters> readouts, const BenchEffort& effort,
                                    Progress* progress) {
  std::map<int, std::vector<std::size_t>> by_slots;
  for (std::size_t r = 0; r < readouts.size(); ++r) {
    by_slots[readouts[r].slots].push_back(r);
  }
  std::vector<ReadoutScore> scores(readouts.size());
  for (const auto& [slots, places] : by_slots) {
    std::vector<ReadoutParameters> together;
    for (const std::size_t place : places) {
      together.push_back(readouts[place]);
    }
    std::vector<ReadoutScore> found = SlotsBench(settings, together, effort, progress).run();
    for (std::size_t i = 0; i < places.size(); ++i) {
      scores[places[i]] = std::move(found[i]);
    }
  }
  return scores;
}

}  // namespace dtof
