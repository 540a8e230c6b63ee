// SPDX-License-Identifier: Apache-2.0
#include "common/map_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include "dtof/core/error.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "run/readout_run.hpp"
#include "run/region.hpp"

namespace dtof {
namespace {

constexpr int kFewestFrames = 4;

void validate(const MapAccuracySettings& settings) {
  if (settings.frames < kFewestFrames) {
    throw InputError(
        fmt::format("accuracy: a map needs at least {} frames, not {}", kFewestFrames, settings.frames));
  }
  const std::vector<double>& edges = settings.band_edges_m;
  if (edges.size() < 2 || !std::ranges::is_sorted(edges, std::less_equal()) || !std::isfinite(edges.back()) ||
      !(edges.front() >= 0.0)) {
    throw InputError("accuracy: distance bands need two or more ascending edges, finite and at least 0 m");
  }
}

/// Pixels of a band, index = row * columns + column.
std::vector<std::size_t> pixels_of_band(std::span<const double> truth_m, double from_m, double to_m,
                                        bool closed) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < truth_m.size(); ++i) {
    if (truth_m[i] > 0.0 && truth_m[i] >= from_m && (truth_m[i] < to_m || (closed && truth_m[i] == to_m))) {
      pixels.push_back(i);
    }
  }
  return pixels;
}

std::vector<double> truth_of(const TargetMap& targets) {
  std::vector<double> truth;
  for (int row = 0; row < targets.rows(); ++row) {
    for (int column = 0; column < targets.columns(); ++column) {
      const PixelTarget& target = targets.at(column, row);
      truth.push_back(target.returns_signal() ? target.depth_m : 0.0);
    }
  }
  return truth;
}

/// A frame's figures over the pixels of a band.
struct FrameFigures {
  std::vector<double> bias_m;
  std::vector<double> mean_square;
  std::vector<double> above_3_percent;
  std::vector<double> above_10_percent;
};

Estimate root(const Estimate& square) {
  return {std::sqrt(square.value),
          {std::sqrt(std::max(0.0, square.interval.low)), std::sqrt(square.interval.high)}};
}

}  // namespace

std::vector<double> equal_bands(const TargetMap& targets) {
  constexpr int kBands = 10;
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  for (const double truth : truth_of(targets)) {
    if (truth > 0.0) {
      nearest = std::min(nearest, truth);
      farthest = std::max(farthest, truth);
    }
  }
  if (farthest == 0.0) {
    throw InputError("accuracy: no pixel of the map has a target");
  }
  if (nearest == farthest) {
    return {nearest, std::nextafter(nearest, std::numeric_limits<double>::infinity())};
  }
  std::vector<double> edges;
  for (int i = 0; i <= kBands; ++i) {
    edges.push_back(std::lerp(nearest, farthest, static_cast<double>(i) / kBands));
  }
  return edges;
}

std::vector<BandAccuracy> run_map_accuracy(const MapAccuracySettings& settings) {
  validate(settings);
  const std::vector<double> truth = truth_of(settings.targets);
  const std::vector<double>& edges = settings.band_edges_m;
  std::vector<BandAccuracy> bands;
  std::vector<std::vector<std::size_t>> members;
  const auto add_band = [&](double from, double to, bool closed) {
    std::vector<std::size_t> pixels = pixels_of_band(truth, from, to, closed);
    if (!pixels.empty()) {
      bands.push_back({"", "", settings.klux, from, to, pixels.size(), settings.frames, {}, {}, {}, {}});
      members.push_back(std::move(pixels));
    }
  };
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    add_band(edges[i], edges[i + 1], i + 2 == edges.size());
  }
  if (bands.empty()) {
    throw InputError(fmt::format("accuracy: no pixel of the map lies between {:g} and {:g} m", edges.front(),
                                 edges.back()));
  }
  add_band(edges.front(), edges.back(), true);

  const FlatCalibration calibration(settings.sensor);
  const std::vector<RangeConverter> tables = calibration.fit(
      [&](const TargetMap& targets) {
        return settings.make_source(settings.sensor, targets, settings.klux, settings.run.seed,
                                    FlatCalibration::kFrame);
      },
      settings.readouts, settings.run.seed, settings.run.threads);
  std::vector<std::vector<FrameFigures>> figures(settings.readouts.size(),
                                                 std::vector<FrameFigures>(bands.size()));
  const Region whole = Region::whole(settings.targets.columns(), settings.targets.rows());
  for (int frame = 0; frame < settings.frames; ++frame) {
    const std::unique_ptr<StreamSource> source =
        settings.make_source(settings.sensor, settings.targets, settings.klux, settings.run.seed,
                             scene_frame(static_cast<std::uint32_t>(frame)));
    for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
      const ReadoutParameters& readout = settings.readouts[r];
      const ReadoutRun run = run_readout(*source, readout, settings.run, whole, settings.command);
      for (std::size_t b = 0; b < bands.size(); ++b) {
        ErrorStatistics statistics;
        for (const std::size_t i : members[b]) {
          statistics.add(truth[i], tables[r].distance(code_position(run.results[i], readout.fraction_bits)));
        }
        const ErrorSummary summary = statistics.summary();
        FrameFigures& figure = figures[r][b];
        figure.bias_m.push_back(summary.bias_m);
        figure.mean_square.push_back(summary.rmse_m * summary.rmse_m);
        figure.above_3_percent.push_back(summary.share_above_3_percent);
        figure.above_10_percent.push_back(summary.share_above_10_percent);
      }
    }
  }
  std::vector<BandAccuracy> rows;
  for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
    for (std::size_t b = 0; b < bands.size(); ++b) {
      BandAccuracy& row = rows.emplace_back(bands[b]);
      row.readout = readout_name(settings.readouts[r].readout);
      row.title = readout_title(settings.readouts[r].readout);
      const FrameFigures& figure = figures[r][b];
      row.bias_m = estimate_mean(figure.bias_m);
      row.rmse_m = root(estimate_mean(figure.mean_square));
      row.above_3_percent = estimate_share_of_frames(figure.above_3_percent, row.pixels);
      row.above_10_percent = estimate_share_of_frames(figure.above_10_percent, row.pixels);
    }
  }
  return rows;
}

}  // namespace dtof
