// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/bench.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "dtof/design/bench_counts.hpp"
#include "dtof/design/candidates.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/metrics/confidence_counts.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

double range_s(const SensorModel& sensor) { return sensor.integration_time_s - sensor.pulse_fwhm_s; }

struct Sky {
  ConfidenceCounts set_by;
  ConfidenceCounts held_out;
};

bool has_confidence(const ReadoutParameters& parameters) {
  return !is_pointer_readout(parameters.readout) || parameters.confidence_width > 0;
}

/// Adds a frame of one scene.
void add(FrameCounts& counts, const MeasuredFrame& frame, const FrameTruth& truth,
         std::optional<int> threshold) {
  counts.add(frame.maps.figures.errors, frame.maps.mean_square);
  for (std::size_t i = 0; threshold && i < truth.metres.size(); ++i) {
    // Comparisons with an unknown error or distance are false.
    counts.detected += frame.run.results[i].confidence >= *threshold &&
                               std::abs(frame.maps.error[i]) <= kRight * truth.metres[i]
                           ? 1
                           : 0;
  }
}

/// Read-outs that take as many slots see the same photons.
class SlotsBench {
 public:
  SlotsBench(const BenchSettings& settings, std::vector<ReadoutParameters> readouts,
             const BenchEffort& effort, BenchTables& tables, Progress* progress)
      : settings_(settings),
        sensor_(with_slots(settings.sensor, readouts.front().slots)),
        readouts_(std::move(readouts)),
        effort_(effort),
        tables_(tables),
        progress_(progress),
        region_(bench_region(sensor_, effort.pixels, effort.engine_columns)),
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

  void look_at_sky(double klux, std::uint32_t first_frame, std::vector<Sky>& skies,
                   ConfidenceCounts Sky::*counts) {
    const TargetMap sky(sensor_.columns, sensor_.rows, {0.0, sensor_.default_reflectivity});
    const std::uint32_t frames =
        sky_frames(settings_, region_.columns.size() * static_cast<std::size_t>(region_.rows.count));
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
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
    std::vector<LightCounts> counts(readouts_.size());
    const std::vector<RangeConverter> tables = tables_.of(sensor_, klux, readouts_, settings_);
    for (int frame = 0; frame < effort_.frames; ++frame) {
      std::vector<FrameCounts> sums(readouts_.size());
      for (const TargetMap& targets : targets_) {
        const FramePipeline pipeline(
            PhotonSource(sensor_, targets, klux, settings_.seed,
                         scene_frame(static_cast<std::uint32_t>(frame))),
            engine_, {.region = region_, .seed = settings_.seed, .threads = settings_.threads});
        for (std::size_t r = 0; r < readouts_.size(); ++r) {
          add(sums[r], pipeline.measure({readouts_[r], tables[r]}), pipeline.truth(), scores[r].threshold);
          advance();
        }
      }
      for (std::size_t r = 0; r < readouts_.size(); ++r) {
        counts[r].add(sums[r]);
      }
    }
    for (std::size_t r = 0; r < readouts_.size(); ++r) {
      scores[r].pixels = counts[r].pixels();
      LightScore light = counts[r].score(klux, scores[r].threshold.has_value());
      if (scores[r].threshold) {
        light.false_alarms = estimate_rare_share(count_from(skies[r].held_out, *scores[r].threshold),
                                                 count_from(skies[r].held_out, 0));
      }
      scores[r].lights.push_back(light);
    }
  }

  const BenchSettings& settings_;
  SensorModel sensor_;
  std::vector<ReadoutParameters> readouts_;
  BenchEffort effort_;
  BenchTables& tables_;
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

int bench_frames(const BenchSettings& settings, int frames) {
  constexpr double kFewestPixels = 4000.0;
  const double of_a_frame = static_cast<double>(settings.sensor.rows) * settings.sensor.columns *
                            static_cast<double>(settings.scenes.size());
  return std::max(frames, static_cast<int>(std::ceil(kFewestPixels / of_a_frame)));
}

int bench_engine_columns(std::span<const ReadoutParameters> readouts) {
  int fewest = 0;
  for (const ReadoutParameters& one : readouts) {
    if (is_pool_readout(one.readout)) {
      const int own = ReadoutParameters::defaults(one.readout, one.np).pool.engine_columns;
      fewest = fewest == 0 ? own : std::min(fewest, own);
    }
  }
  return std::max(fewest, 1);
}

const LightScore& ReadoutScore::worst() const {
  return *std::ranges::max_element(lights, {},
                                   [](const LightScore& light) { return light.above_3_percent.value; });
}

std::vector<int> bench_columns(const SensorModel& sensor, double pixels, int engine_columns) {
  constexpr int kMostParts = 3;
  const double wanted = pixels / sensor.rows;
  const bool all = wanted >= sensor.columns;
  const int parts = all ? 1 : std::clamp(static_cast<int>(wanted / engine_columns), 1, kMostParts);
  const int of_part =
      all ? sensor.columns : engine_columns * std::max(static_cast<int>(wanted / parts / engine_columns), 1);
  std::set<int> columns;
  for (int part = 0; part < parts && parts * of_part < sensor.columns; ++part) {
    const int middle = sensor.columns * (2 * part + 1) / (2 * parts);
    const int first = (middle - of_part / 2 + engine_columns / 2) / engine_columns * engine_columns;
    for (int column = first; column < std::min(first + of_part, sensor.columns); ++column) {
      columns.insert(column);
    }
  }
  for (int column = 0; parts * of_part >= sensor.columns && column < sensor.columns; ++column) {
    columns.insert(column);
  }
  return {columns.begin(), columns.end()};
}

Region bench_region(const SensorModel& sensor, double pixels, int engine_columns) {
  constexpr int kLeastRows = 64;
  constexpr int kStep = 32;  // the largest GROUP_SIZE
  Region region{bench_columns(sensor, pixels, engine_columns), {0, sensor.rows}};
  const double wanted = pixels / static_cast<double>(region.columns.size());
  if (wanted < sensor.rows) {
    const int rows = std::max(static_cast<int>(wanted) / kStep * kStep, kLeastRows);
    if (rows < sensor.rows) {
      region.rows = {(sensor.rows - rows) / 2 / kStep * kStep, rows};
    }
  }
  return region;
}

std::vector<RangeConverter> BenchTables::of(const SensorModel& sensor, double klux,
                                            std::span<const ReadoutParameters> readouts,
                                            const BenchSettings& settings) {
  const auto entry = [&](const ReadoutParameters& one) {
    return std::ranges::find_if(entries_, [&](const Entry& e) { return e.klux == klux && e.readout == one; });
  };
  std::vector<ReadoutParameters> missing;
  for (const ReadoutParameters& one : readouts) {
    if (entry(one) == entries_.end()) {
      missing.push_back(one);
    }
  }
  if (!missing.empty()) {
    std::vector<RangeConverter> fitted =
        flat_tables(sensor, klux, Fidelity::kExact, missing, settings.seed, settings.threads);
    for (std::size_t i = 0; i < missing.size(); ++i) {
      entries_.push_back({klux, missing[i], std::move(fitted[i])});
    }
  }
  std::vector<RangeConverter> tables;
  for (const ReadoutParameters& one : readouts) {
    tables.push_back(entry(one)->table);
  }
  return tables;
}

std::vector<ReadoutParameters> distinct_readouts(std::span<const ReadoutParameters> readouts) {
  std::vector<ReadoutParameters> distinct;
  for (const ReadoutParameters& one : readouts) {
    if (std::ranges::find(distinct, one) == distinct.end()) {
      distinct.push_back(one);
    }
  }
  return distinct;
}

std::vector<ReadoutScore> run_bench(const BenchSettings& settings,
                                    std::span<const ReadoutParameters> readouts, const BenchEffort& effort,
                                    Progress* progress, BenchTables* tables) {
  BenchTables own_tables;
  std::map<int, std::vector<ReadoutParameters>> by_slots;
  for (const ReadoutParameters& one : distinct_readouts(readouts)) {
    by_slots[one.slots].push_back(one);
  }
  std::map<int, std::vector<ReadoutScore>> found;
  for (const auto& [slots, together] : by_slots) {
    found[slots] =
        SlotsBench(settings, together, effort, tables != nullptr ? *tables : own_tables, progress).run();
  }
  std::vector<ReadoutScore> scores;
  for (const ReadoutParameters& one : readouts) {
    const std::vector<ReadoutParameters>& together = by_slots[one.slots];
    scores.push_back(
        found[one.slots][static_cast<std::size_t>(std::ranges::find(together, one) - together.begin())]);
  }
  return scores;
}

}  // namespace dtof
