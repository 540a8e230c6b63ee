// SPDX-License-Identifier: Apache-2.0
#include "app/thesis_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "core/parallel.hpp"
#include "metrics/depth.hpp"
#include "photon/physics.hpp"

namespace dtof {
namespace {

// Histograms of every frame, from the acquisitions before `acquisitions`; the no-detection code is dropped.
std::vector<std::vector<double>> histograms(const FigureScene& scene, std::uint32_t acquisitions) {
  const IndependentPixels pixels(scene.sensor, scene.frames);
  const TargetMap targets =
      pixels.targets({.depth_m = scene.distance_m, .reflectivity = scene.sensor.default_reflectivity});
  const std::unique_ptr<StreamSource> source =
      make_exact_source(scene.sensor, targets, scene.klux, scene.seed, 0);
  const auto rows = static_cast<std::size_t>(pixels.rows);
  const auto bins = (std::size_t{1} << static_cast<unsigned>(scene.sensor.np)) - 1;
  std::vector<std::vector<double>> counts(static_cast<std::size_t>(scene.frames));
  parallel_for(static_cast<std::size_t>(pixels.columns), scene.threads, [&](std::size_t column) {
    const ColumnStream stream = source->column(pixels.column(static_cast<int>(column)));
    for (std::size_t row = 0; row < rows; ++row) {
      std::vector<double>& histogram = counts[column * rows + row];
      histogram.resize(bins);
      for (const Detection& detection : stream.row(pixels.row(static_cast<int>(row)))) {
        if (detection.acquisition < acquisitions && detection.timestamp < bins) {
          histogram[detection.timestamp] += 1.0;
        }
      }
    }
  });
  return counts;
}

Spread spread(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.025), at(0.5), at(0.975)};
}

bool holds(const Spread& spread, double value) { return spread.low <= value && value <= spread.high; }

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

HistogramPeaks histogram_peaks(const FigureScene& scene, std::uint32_t acquisitions) {
  const DepthScale scale(scene.sensor.integration_time_s, scene.sensor.np, scene.sensor.pulse_fwhm_s);
  std::vector<std::vector<double>> frames = histograms(scene, acquisitions);
  std::vector<double> counts;
  std::vector<double> bins;
  double fakes = 0.0;
  for (const std::vector<double>& histogram : frames) {
    const auto peak = std::ranges::max_element(histogram);
    const auto code = static_cast<double>(peak - histogram.begin());
    counts.push_back(*peak);
    bins.push_back(code + 1.0);
    fakes += std::abs(scale.depth(code) - scene.distance_m) > 0.1 * scene.distance_m ? 1.0 : 0.0;
  }
  return {spread(counts), spread(bins), fakes / static_cast<double>(frames.size()),
          std::move(frames.front())};
}

double PileUp::lost_share() const { return 1.0 - sum(delivered) / sum(arriving); }

PileUp pile_up(const FigureScene& scene) {
  const SensorModel& sensor = scene.sensor;
  const double codes = std::ldexp(1.0, sensor.np);
  const double background = sensor.background_events(scene.klux, sensor.default_reflectivity) / codes;
  const double signal = sensor.signal_events(scene.distance_m, sensor.default_reflectivity);
  const double sigma = pulse_sigma_s(sensor.pulse_fwhm_s) / sensor.time_resolution_s();
  const double centre = arrival_centre_s(scene.distance_m, sensor.pulse_fwhm_s) / sensor.time_resolution_s();
  const auto share_before = [&](double bin) {
    return 0.5 * std::erfc((centre - bin) / sigma / std::numbers::sqrt2);
  };
  PileUp result;
  for (double bin = 0.0; bin < codes - 1.0; bin += 1.0) {
    result.arriving.push_back(sensor.acquisitions *
                              (background + signal * (share_before(bin + 1.0) - share_before(bin))));
  }
  result.delivered.resize(result.arriving.size());
  for (const std::vector<double>& histogram : histograms(scene, sensor.acquisitions)) {
    for (std::size_t i = 0; i < histogram.size(); ++i) {
      result.delivered[i] += histogram[i] / scene.frames;
    }
  }
  const double bin_ns = sensor.time_resolution_s() * 1e9;
  result.arriving_fwhm_ns = full_width_at_half_maximum(result.arriving) * bin_ns;
  result.delivered_fwhm_ns = full_width_at_half_maximum(result.delivered) * bin_ns;
  return result;
}

double full_width_at_half_maximum(std::span<const double> curve) {
  if (curve.empty()) {
    throw std::logic_error("the width of an empty curve");
  }
  const double half = 0.5 * *std::ranges::max_element(curve);
  const auto reaches = [half](double value) { return value >= half; };
  const auto first = static_cast<std::size_t>(std::ranges::find_if(curve, reaches) - curve.begin());
  std::size_t last = curve.size() - 1;
  while (!reaches(curve[last])) {
    --last;
  }
  if (first == 0 || last + 1 == curve.size()) {
    throw std::logic_error("the curve does not fall to half its maximum on both sides");
  }
  const double rise = (half - curve[first - 1]) / (curve[first] - curve[first - 1]);
  const double fall = (half - curve[last + 1]) / (curve[last] - curve[last + 1]);
  return (static_cast<double>(last) + 1.0 - fall) - (static_cast<double>(first) - 1.0 + rise);
}

Judgement judge_peak(const HistogramPeaks& peaks, double count, double bin) {
  return {holds(peaks.count, count) && holds(peaks.bin, bin) ? Verdict::kAgrees : Verdict::kDisagrees,
          fmt::format("95 % of frames: {:g} to {:g} counts (median {:g}) in bin {:g} to {:g}",
                      peaks.count.low, peaks.count.high, peaks.count.median, peaks.bin.low, peaks.bin.high)};
}

Judgement judge_pile_up(const PileUp& near, const PileUp& far) {
  const auto narrowed = [](const PileUp& p) { return p.delivered_fwhm_ns / p.arriving_fwhm_ns; };
  const bool distorted = far.lost_share() > 0.0 && narrowed(far) < 1.0;
  const bool worse_near = near.lost_share() > far.lost_share() && narrowed(near) < narrowed(far);
  return {distorted && worse_near ? Verdict::kAgrees : Verdict::kDisagrees,
          fmt::format("lost: {:.0f} % and {:.0f} %; FWHM {:.2f} ns becomes {:.2f} and {:.2f} ns",
                      near.lost_share() * 100.0, far.lost_share() * 100.0, far.arriving_fwhm_ns,
                      near.delivered_fwhm_ns, far.delivered_fwhm_ns)};
}

}  // namespace dtof
