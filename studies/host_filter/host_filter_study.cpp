// SPDX-License-Identifier: Apache-2.0
#include "host_filter/host_filter_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/host/host_filter.hpp"

namespace dtof {
namespace {

constexpr double kThreePercent = 0.03;
constexpr double kTenPercent = 0.10;
/// The study's figures have no line for this reference of SceneStudy.
constexpr const char* kNotShown = "hisPointer pairs";

bool is_within_3(double measured, double distance) {
  return std::abs(measured - distance) <= kThreePercent * distance;
}

/// Whether a distance is that of the pixel or of one of its eight neighbours.
bool is_on_a_surface(const SceneTruth& truth, int column, int row, double measured) {
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, truth.rows - 1); ++y) {
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, truth.columns - 1); ++x) {
      if (is_within_3(measured, truth.distance_m[static_cast<std::size_t>(y * truth.columns + x)])) {
        return true;
      }
    }
  }
  return false;
}

void count_pixel_if(PixelCount& counter, bool hit) {
  ++counter.pixels;
  counter.hits += hit ? 1 : 0;
}

}  // namespace

FilterCounts count_pixels(const SceneTruth& truth, std::span<const double> measured_m) {
  FilterCounts counts;
  auto& [above_3, above_10, edges, singles, flying] = counts;
  for (int row = 0; row < truth.rows; ++row) {
    for (int column = 0; column < truth.columns; ++column) {
      const auto i = static_cast<std::size_t>(row * truth.columns + column);
      const double distance = truth.distance_m[i];
      if (distance <= 0.0) {
        continue;
      }
      const bool beyond_10 = std::abs(measured_m[i] - distance) > kTenPercent * distance;
      count_pixel_if(above_3, !is_within_3(measured_m[i], distance));
      count_pixel_if(above_10, beyond_10);
      if (truth.edge[i]) {
        count_pixel_if(edges, !is_within_3(measured_m[i], distance));
        count_pixel_if(flying, !is_on_a_surface(truth, column, row, measured_m[i]));
      }
      if (truth.single[i]) {
        count_pixel_if(singles, beyond_10);
      }
    }
  }
  return counts;
}

StudyScene middle_columns(const StudyScene& scene, int columns) {
  const int width = std::min(columns, scene.targets.columns());
  const int first = (scene.targets.columns() - width) / 2;
  StudyScene part{scene.name, TargetMap(width, scene.targets.rows()), width};
  for (int row = 0; row < part.targets.rows(); ++row) {
    for (int column = 0; column < width; ++column) {
      part.targets.at(column, row) = scene.targets.at(first + column, row);
      if (!scene.guessed.empty()) {
        part.guessed.push_back(
            scene.guessed[static_cast<std::size_t>(row * scene.targets.columns() + first + column)]);
      }
    }
  }
  return part;
}

std::vector<double> filtered_distances(const SceneMeasurement& measurement, int columns, double pulse_m) {
  std::vector<double> metres = measurement.distance_m;
  filter_depth(metres, columns, pulse_m);
  return metres;
}

FilterLight::FilterLight(double klux, std::vector<std::string> scenes, std::vector<std::string> estimators)
    : klux_(klux),
      scenes_(std::move(scenes)),
      estimators_(std::move(estimators)),
      counts_(scenes_.size() * estimators_.size() * 2) {}

void FilterLight::add(std::size_t scene, std::size_t estimator, bool filtered, const FilterCounts& counts) {
  counts_[2 * (scene * estimators_.size() + estimator) + (filtered ? 1 : 0)].push_back(counts);
}

const std::vector<FilterCounts>& FilterLight::of(std::size_t scene, std::size_t estimator,
                                                 bool filtered) const {
  return counts_[2 * (scene * estimators_.size() + estimator) + (filtered ? 1 : 0)];
}

std::vector<std::size_t> FilterLight::all_scenes() const {
  std::vector<std::size_t> all(scenes_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::uint64_t FilterLight::pixels(std::span<const std::size_t> scenes, std::size_t figure) const {
  std::uint64_t sum = 0;
  for (const std::size_t scene : scenes) {
    for (const FilterCounts& counts : of(scene, 0, false)) {
      sum += counts.at(figure).pixels;
    }
  }
  return sum;
}

Estimate FilterLight::estimate(std::span<const std::size_t> scenes, std::size_t estimator, bool filtered,
                               std::size_t figure) const {
  const std::size_t seeds = of(scenes.front(), estimator, filtered).size();
  std::vector<double> shares;
  std::uint64_t all = 0;
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    PixelCount sum;
    for (const std::size_t scene : scenes) {
      const PixelCount& part = of(scene, estimator, filtered)[seed].at(figure);
      sum.hits += part.hits;
      sum.pixels += part.pixels;
    }
    if (sum.pixels > 0) {
      shares.push_back(static_cast<double>(sum.hits) / static_cast<double>(sum.pixels));
      all += sum.pixels;
    }
  }
  return estimate_share_of_frames(shares, all / shares.size());
}

FilterLight measure_host_filter(const HostFilterSettings& settings, double klux) {
  if (settings.seeds < 2) {
    throw InputError(fmt::format("host filter: an interval needs at least 2 seeds, not {}", settings.seeds));
  }
  std::optional<FilterLight> light;
  const double pulse_m = pulse_distance_m(settings.sensor.pulse_fwhm_s);
  for (int i = 0; i < settings.seeds; ++i) {
    const std::uint64_t seed = settings.seed + static_cast<std::uint64_t>(i);
    const std::vector<StudyScene> scenes = settings.scenes(seed);
    Progress progress(fmt::format("{:g} klux, seed {}", klux, seed), scenes.size() + 1);
    const SceneStudy study(settings.sensor, klux, settings.readouts, seed, settings.threads, TableRule::kFlat,
                           settings.references);
    progress.advance();
    std::vector<std::string> titles = study.estimators();
    std::erase(titles, kNotShown);
    if (!light) {
      std::vector<std::string> names;
      std::ranges::transform(scenes, std::back_inserter(names), &StudyScene::name);
      light.emplace(klux, std::move(names), titles);
    }
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      const StudyScene part = middle_columns(scenes[s], settings.columns);
      const SceneTruth truth = scene_truth(part);
      const std::vector<SceneMeasurement> measured = study.measure(part);
      std::size_t place = 0;
      for (std::size_t e = 0; e < measured.size(); ++e) {
        if (study.estimators()[e] == kNotShown) {
          continue;
        }
        light->add(s, place, false, count_pixels(truth, measured[e].distance_m));
        light->add(s, place, true,
                   count_pixels(truth, filtered_distances(measured[e], part.columns, pulse_m)));
        ++place;
      }
      progress.advance();
    }
  }
  return light.value();
}

}  // namespace dtof
