// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include "common/readout_variant.hpp"
#include "dtof/analytic/pulse_match.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/metrics/cramer_rao.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/matched_filter.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/paired_his_pointer.hpp"
#include "dtof/readout/pooled_matched_filter.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

constexpr double kOutlier = 0.10;
constexpr double kEdge = 0.10;
constexpr std::uint32_t kSceneFrame = scene_frame(0);

struct Judged {
  double confidence;
  bool outlier;
};

/// Pixels of equal confidence are dropped alike.
std::vector<double> removed_outliers(std::vector<Judged> pixels) {
  std::ranges::sort(pixels, {}, &Judged::confidence);
  const auto outliers = static_cast<double>(std::ranges::count(pixels, true, &Judged::outlier));
  std::vector<double> removed;
  for (const double dropped : kDropped) {
    double left = dropped * static_cast<double>(pixels.size());
    double found = 0.0;
    for (auto level = pixels.begin(); level != pixels.end() && left > 0.0;) {
      const auto end =
          std::ranges::upper_bound(level, pixels.end(), level->confidence, {}, &Judged::confidence);
      const auto count = static_cast<double>(end - level);
      const double share = std::min(1.0, left / count);
      found +=
          share * static_cast<double>(std::count_if(level, end, [](const Judged& p) { return p.outlier; }));
      left -= count;
      level = end;
    }
    removed.push_back(outliers > 0.0 ? found / outliers : std::nan(""));
  }
  return removed;
}

}  // namespace

int picked_column(const StudyScene& scene, int index) {
  return static_cast<int>((2 * std::int64_t{index} + 1) * scene.targets.columns() /
                          (2 * std::int64_t{scene.columns}));
}

SceneTruth scene_truth(const StudyScene& scene) {
  SceneTruth truth{
      .columns = scene.columns, .rows = scene.targets.rows(), .distance_m = {}, .edge = {}, .single = {}};
  constexpr double kDim = 0.25;
  double brightest = 0.0;
  for (int row = 0; row < truth.rows; ++row) {
    for (int column = 0; column < scene.targets.columns(); ++column) {
      brightest = std::max(brightest, scene.targets.at(column, row).reflectivity);
    }
  }
  const auto distance = [&](int column, int row) {
    const PixelTarget& target = scene.targets.at(column, row);
    return target.returns_signal() ? target.depth_m : 0.0;
  };
  for (int row = 0; row < truth.rows; ++row) {
    for (int i = 0; i < scene.columns; ++i) {
      const int column = picked_column(scene, i);
      const double here = distance(column, row);
      bool edge = false;
      bool single = true;
      constexpr std::array<std::pair<int, int>, 4> kNeighbours = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
      for (const auto& [right, down] : kNeighbours) {
        const int x = column + right;
        const int y = row + down;
        if (x >= 0 && x < scene.targets.columns() && y >= 0 && y < truth.rows) {
          const bool differs = std::abs(distance(x, y) - here) > kEdge * here;
          edge = edge || differs;
          single = single && differs;
        }
      }
      const std::size_t pixel =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(scene.targets.columns()) +
          static_cast<std::size_t>(column);
      truth.distance_m.push_back(!scene.guessed.empty() && scene.guessed[pixel] ? 0.0 : here);
      truth.edge.push_back(edge);
      truth.single.push_back(edge && single);
      truth.dim.push_back(scene.targets.at(column, row).reflectivity <= kDim * brightest);
    }
  }
  return truth;
}

SceneScore score_scene(const SceneTruth& truth, const SceneMeasurement& measurement) {
  ErrorShareCounter all;
  ErrorShareCounter edges;
  ErrorShareCounter rest;
  ErrorShareCounter dims;
  ErrorShareCounter singles;
  std::vector<Judged> judged;
  for (std::size_t i = 0; i < truth.distance_m.size(); ++i) {
    const double distance = truth.distance_m[i];
    if (distance <= 0.0) {
      continue;
    }
    const double measured = measurement.distance_m[i];
    all.add(distance, measured);
    (truth.edge[i] ? edges : rest).add(distance, measured);
    if (truth.single[i]) {
      singles.add(distance, measured);
    }
    if (!truth.dim.empty() && truth.dim[i]) {
      dims.add(distance, measured);
    }
    judged.push_back({measurement.confidence[i], std::abs(measured - distance) > kOutlier * distance});
  }
  return {all.shares(),  edges.shares(),   rest.shares(),
          dims.shares(), singles.shares(), removed_outliers(std::move(judged))};
}

double median_error_over_bound(const SceneTruth& truth, std::span<const double> relative_bound,
                               const SceneMeasurement& measurement) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < relative_bound.size(); ++i) {
    const double bound = relative_bound[i] * truth.distance_m[i];
    if (bound > 0.0 && std::isfinite(bound)) {
      ratios.push_back(std::abs(measurement.distance_m[i] - truth.distance_m[i]) / bound);
    }
  }
  if (ratios.empty()) {
    return std::nan("");
  }
  constexpr double kNormalMedian = 0.674489750196;  // of |x| for a standard normal x
  return median(std::move(ratios)) / kNormalMedian;
}

SceneStudy::SceneStudy(SensorModel sensor, double klux, std::span<const ReadoutParameters> readouts,
                       std::uint64_t seed, int threads, TableRule table, bool references)
    : sensor_(std::move(sensor)),
      klux_(klux),
      readouts_(readouts.begin(), readouts.end()),
      seed_(seed),
      threads_(threads),
      references_(references),
      scale_(sensor_.integration_time_s, sensor_.np, sensor_.pulse_fwhm_s) {
  for (const ReadoutParameters& readout : readouts_) {
    titles_.push_back(variant_title(readout, sensor_));
  }
  if (references_) {
    titles_.emplace_back("hisPointer pairs");
    titles_.emplace_back("matched filter (single pixel)");
    titles_.emplace_back("pooled matched filter");
  }

  if (table == TableRule::kNone) {
    return;
  }
  const FlatCalibration calibration(sensor_);
  const StudyScene scene{"calibration", calibration.targets(),
                         static_cast<int>(calibration.distances_m().size())};
  const Positions positions = read(sensor_.as_calibrated(), scene, FlatCalibration::kFrame);
  const auto photons = [&](const TargetMap& targets) {
    return std::make_unique<PhotonSource>(sensor_.as_calibrated(), targets, klux_, seed_,
                                          FlatCalibration::kFrame);
  };
  for (std::size_t e = 0; e < titles_.size(); ++e) {
    if (uses_other_columns(e)) {
      converters_.push_back(calibration.fit(photons, std::span(&readouts_[e], 1), seed_, threads_).front());
      continue;
    }
    const double step = e < readouts_.size() ? std::ldexp(1.0, -readouts_[e].fraction_bits)
                                             : (e == readouts_.size() ? 1.0 : 0.0);
    converters_.push_back(calibration.fit(positions[e], step, seed_));
  }
}

bool SceneStudy::uses_other_columns(std::size_t estimator) const {
  return estimator < readouts_.size() && readouts_[estimator].columns_together() > 1;
}

double SceneStudy::distance(std::size_t estimator, double position) const {
  return converters_.empty() ? scale_.depth(position) : converters_[estimator].distance(position);
}

SceneStudy::Positions SceneStudy::read(const SensorModel& sensor, const StudyScene& scene,
                                       std::uint32_t frame) const {
  const PhotonSource source(sensor, scene.targets, klux_, seed_, frame);
  const auto width = static_cast<std::size_t>(scene.columns);
  const auto rows = static_cast<std::size_t>(scene.targets.rows());
  Positions positions(titles_.size(), std::vector<Measurement>(width * rows));
  parallel_for(width, threads_, [&](std::size_t index) {
    const int column = picked_column(scene, static_cast<int>(index));
    const ColumnStream stream = source.column(column);
    const auto store = [&](std::size_t estimator, ReadoutModel& model, int fraction_bits) {
      const std::vector<PixelResult> results = model.run_column(stream, sensor_.acquisitions);
      for (std::size_t row = 0; row < rows; ++row) {
        positions[estimator][row * width + index] = to_measurement(results[row], fraction_bits);
      }
    };
    for (std::size_t e = 0; e < readouts_.size(); ++e) {
      if (uses_other_columns(e)) {
        continue;
      }
      store(e, *make_readout_model(readouts_[e]), readouts_[e].fraction_bits);
    }
    if (!references_) {
      return;
    }
    const ReadoutParameters his_pointer = default_parameters(Readout::kHisPointer, sensor_);
    store(readouts_.size(), *make_paired_his_pointer(his_pointer), his_pointer.fraction_bits);
    // The template depends on the rates: neighbouring pixels of equal rates share a filter.
    std::unique_ptr<MatchedFilter> filter;
    PixelRates matched;
    const std::size_t single = readouts_.size() + 1;
    const std::size_t pooled = readouts_.size() + 2;
    // A pixel without a target has no pulse to look for and tells its neighbours nothing.
    const auto bins = (std::size_t{1} << static_cast<unsigned>(sensor_.np)) - 1;
    std::vector<std::vector<double>> scores(rows, std::vector<double>(bins, 0.0));
    for (std::size_t row = 0; row < rows; ++row) {
      const PixelRates rates = source.rates(column, static_cast<int>(row));
      if (rates.signal <= 0.0) {
        continue;
      }
      if (!filter || rates.signal != matched.signal || rates.background != matched.background) {
        filter = std::make_unique<MatchedFilter>(matched_to(sensor_, rates));
        matched = rates;
      }
      std::ranges::copy(filter->scores(stream.row(static_cast<int>(row))), scores[row].begin());
      const auto peak = std::ranges::max_element(scores[row]);
      const auto bin = static_cast<std::size_t>(peak - scores[row].begin());
      positions[single][row * width + index] = {refined_peak(scores[row], bin), *peak};
    }
    const std::vector<MatchedFilter::Result> results = pool_column(scores);
    for (std::size_t row = 0; row < rows; ++row) {
      positions[pooled][row * width + index] = {results[row].position, results[row].score};
    }
  });
  return positions;
}

void SceneStudy::read_engines(const StudyScene& scene, std::uint32_t frame, Positions& positions) const {
  const PhotonSource source(sensor_, scene.targets, klux_, seed_, frame);
  std::vector<int> columns(static_cast<std::size_t>(scene.columns));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns[i] = picked_column(scene, static_cast<int>(i));
  }
  for (std::size_t e = 0; e < readouts_.size(); ++e) {
    if (!uses_other_columns(e)) {
      continue;
    }
    const std::vector<PixelResult> results = run_frame(source, readouts_[e], threads_, columns);
    for (std::size_t i = 0; i < results.size(); ++i) {
      positions[e][i] = to_measurement(results[i], readouts_[e].fraction_bits);
    }
  }
}

std::vector<SceneMeasurement> SceneStudy::measure(const StudyScene& scene, std::uint32_t n) const {
  Positions positions = read(sensor_, scene, scene_frame(n));
  read_engines(scene, scene_frame(n), positions);
  std::vector<SceneMeasurement> measurements;
  for (std::size_t e = 0; e < titles_.size(); ++e) {
    SceneMeasurement measurement;
    for (std::size_t i = 0; i < positions[e].size(); ++i) {
      // The host knows the skew.
      const int column = picked_column(scene, static_cast<int>(i) % scene.columns);
      const double skew = sensor_.surroundings.skew.of_pixel(column, static_cast<int>(i) / scene.columns,
                                                             scene.targets.columns()) /
                          sensor_.time_resolution_s();
      measurement.distance_m.push_back(distance(e, positions[e][i].position - skew));
      measurement.confidence.push_back(positions[e][i].confidence);
    }
    measurements.push_back(std::move(measurement));
  }
  return measurements;
}

std::vector<double> SceneStudy::relative_bounds(const StudyScene& scene) const {
  const PhotonSource source(sensor_, scene.targets, klux_, seed_, kSceneFrame);
  const auto width = static_cast<std::size_t>(scene.columns);
  const auto rows = static_cast<std::size_t>(scene.targets.rows());
  std::vector<double> bounds(width * rows, 0.0);
  parallel_for(width, threads_, [&](std::size_t index) {
    const int column = picked_column(scene, static_cast<int>(index));
    for (std::size_t row = 0; row < rows; ++row) {
      const double distance = scene.targets.at(column, static_cast<int>(row)).depth_m;
      const PixelRates rates = source.rates(column, static_cast<int>(row));
      if (rates.signal > 0.0) {
        const double bins = cramer_rao_bound(pulse_observation(sensor_, rates));
        bounds[row * width + index] = bins * scale_.bin_depth() / distance;
      }
    }
  });
  return bounds;
}

}  // namespace dtof
