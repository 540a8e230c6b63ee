// SPDX-License-Identifier: Apache-2.0
#include "reproduction/thesis_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "dtof/core/parallel.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/physics.hpp"

namespace dtof {
namespace {

// Histograms of every frame, from the acquisitions in [begin, end); the no-detection code is dropped.
std::vector<std::vector<double>> histograms(const FigureScene& scene, std::uint32_t begin,
                                            std::uint32_t end) {
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
        if (detection.acquisition >= begin && detection.acquisition < end && detection.timestamp < bins) {
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

std::size_t highest_bin(const std::vector<double>& histogram) {
  return static_cast<std::size_t>(std::ranges::max_element(histogram) - histogram.begin());
}

// First of 2^nb coarse bins with the most counts, and its width in bins.
struct CoarsePeak {
  std::size_t index;
  std::size_t width;
};
CoarsePeak coarse_peak(const std::vector<double>& histogram, int np, int nb) {
  const std::size_t width = std::size_t{1} << static_cast<unsigned>(np - nb);
  std::vector<double> coarse(std::size_t{1} << static_cast<unsigned>(nb));
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    coarse[bin / width] += histogram[bin];
  }
  return {highest_bin(coarse), width};
}

// Share of the counts above `bin` among those beside it.
double share_above(const std::vector<double>& histogram, std::size_t bin) {
  const auto peak = histogram.begin() + static_cast<std::ptrdiff_t>(bin);
  const double below = std::accumulate(histogram.begin(), peak, 0.0);
  const double above = std::accumulate(peak + 1, histogram.end(), 0.0);
  return below + above == 0.0 ? 0.5 : above / (below + above);
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

HistogramPeaks histogram_peaks(const FigureScene& scene, std::uint32_t acquisitions) {
  const DepthScale scale(scene.sensor.integration_time_s, scene.sensor.np, scene.sensor.pulse_fwhm_s);
  std::vector<std::vector<double>> frames = histograms(scene, 0, acquisitions);
  std::vector<double> counts;
  std::vector<double> bins;
  std::uint64_t fakes = 0;
  for (const std::vector<double>& histogram : frames) {
    const auto peak = std::ranges::max_element(histogram);
    const auto code = static_cast<double>(peak - histogram.begin());
    counts.push_back(*peak);
    bins.push_back(code + 1.0);
    fakes += std::abs(scale.depth(code) - scene.distance_m) > 0.1 * scene.distance_m ? 1 : 0;
  }
  return {spread(counts), spread(bins), estimate_rare_share(fakes, frames.size()), std::move(frames.front())};
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
  for (const std::vector<double>& histogram : histograms(scene, 0, sensor.acquisitions)) {
    for (std::size_t i = 0; i < histogram.size(); ++i) {
      result.delivered[i] += histogram[i] / scene.frames;
    }
  }
  const double bin_ns = sensor.time_resolution_s() * 1e9;
  result.arriving_fwhm_ns = full_width_at_half_maximum(result.arriving) * bin_ns;
  result.delivered_fwhm_ns = full_width_at_half_maximum(result.delivered) * bin_ns;
  return result;
}

std::vector<double> turned_to_peak(const std::vector<double>& histogram) {
  const std::size_t size = histogram.size();
  const std::size_t peak = highest_bin(histogram);
  std::vector<double> turned(size);
  for (std::size_t bin = 0; bin < size; ++bin) {
    turned[(bin + size - peak + size / 2) % size] = histogram[bin];
  }
  return turned;
}

SideShares side_shares(const FigureScene& scene) {
  std::vector<double> as_counted;
  std::vector<double> turned;
  SideShares result;
  for (const std::vector<double>& histogram : histograms(scene, 0, scene.sensor.acquisitions)) {
    as_counted.push_back(share_above(histogram, highest_bin(histogram)));
    const std::vector<double> around = turned_to_peak(histogram);
    turned.push_back(share_above(around, around.size() / 2));
    if (result.one_frame.empty()) {
      result.one_frame = around;
    }
  }
  result.as_counted = estimate_mean(as_counted);
  result.turned = estimate_mean(turned);
  return result;
}

FineHistogram fine_histogram(const FigureScene& scene) {
  const ReadoutParameters sifh = ReadoutParameters::defaults(Readout::kSifh, scene.sensor.np);
  const std::uint32_t half = scene.sensor.acquisitions / 2;
  const auto coarse = histograms(scene, 0, half);
  const auto full = histograms(scene, half, scene.sensor.acquisitions);
  const auto side = std::ptrdiff_t{1} << static_cast<unsigned>(sifh.nb - 1);
  FineHistogram result;
  std::vector<double> bins;
  for (std::size_t frame = 0; frame < full.size(); ++frame) {
    const CoarsePeak peak = coarse_peak(coarse[frame], scene.sensor.np, sifh.nb);
    const std::ptrdiff_t lowest = static_cast<std::ptrdiff_t>(peak.index * peak.width) - side + 1;
    std::vector<double> fine(2 * static_cast<std::size_t>(side));
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const std::ptrdiff_t bin = lowest + static_cast<std::ptrdiff_t>(i);
      fine[i] = bin < 0 || bin >= std::ssize(full[frame]) ? 0.0 : full[frame][static_cast<std::size_t>(bin)];
    }
    bins.push_back(static_cast<double>(lowest) + static_cast<double>(highest_bin(fine)) + 1.0);
    if (frame == 0) {
      result.first_bin = static_cast<double>(lowest) + 1.0;
      result.one_frame = fine;
    }
  }
  result.bin = spread(bins);
  return result;
}

std::string guard_title(int guard) { return fmt::format("GUARD {}", guard); }

FilteredCounts filtered_counts(const FigureScene& scene, int guard) {
  const SensorModel& sensor = scene.sensor;
  const ReadoutParameters pointer = ReadoutParameters::defaults(Readout::kHisPointer, sensor.np);
  const std::uint32_t half = sensor.acquisitions / 2;
  const auto coarse = histograms(scene, 0, half);
  const auto full = histograms(scene, half, sensor.acquisitions);
  const double centre = arrival_centre_s(scene.distance_m, sensor.pulse_fwhm_s) / sensor.time_resolution_s();
  const double pulse = std::ceil(sensor.pulse_fwhm_s / sensor.time_resolution_s());
  const double side = std::ldexp(1.0, pointer.nb - 1) + guard;
  FilteredCounts result;
  result.guard = guard;
  result.remaining.resize(full.front().size());
  std::vector<double> kept_shares;
  for (std::size_t frame = 0; frame < full.size(); ++frame) {
    const CoarsePeak peak = coarse_peak(coarse[frame], sensor.np, pointer.nb);
    const std::size_t middle_code = peak.index * peak.width + peak.width / 2;
    const auto middle = static_cast<double>(middle_code);
    double of_pulse = 0.0;
    double kept = 0.0;
    for (std::size_t bin = 0; bin < full[frame].size(); ++bin) {
      const auto code = static_cast<double>(bin);
      const bool passes = code > middle - side && code <= middle + side;
      const double counts = full[frame][bin];
      result.remaining[bin] += passes ? counts / scene.frames : 0.0;
      if (std::abs(code + 0.5 - centre) <= pulse) {
        of_pulse += counts;
        kept += passes ? counts : 0.0;
      }
    }
    kept_shares.push_back(of_pulse == 0.0 ? 0.0 : kept / of_pulse);
  }
  result.kept = spread(kept_shares);
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

Judgement judge_sides(const SideShares& shares) {
  constexpr double kHalf = 0.5;
  constexpr double kWithin = 0.02;
  const auto inside = [&](double share) { return std::abs(share - kHalf) <= kWithin; };
  const Interval& interval = shares.turned.interval;
  const bool agrees = inside(interval.low) && inside(interval.high);
  const bool apart = interval.high < kHalf - kWithin || interval.low > kHalf + kWithin;
  return {agrees  ? Verdict::kAgrees
          : apart ? Verdict::kDisagrees
                  : Verdict::kOpen,
          fmt::format("above the peak: {:.1f} [{:.1f}, {:.1f}] % of the counts as they are, {:.1f} [{:.1f}, "
                      "{:.1f}] % turned",
                      100.0 * shares.as_counted.value, 100.0 * shares.as_counted.interval.low,
                      100.0 * shares.as_counted.interval.high, 100.0 * shares.turned.value,
                      100.0 * interval.low, 100.0 * interval.high)};
}

Judgement judge_fine_peak(const FineHistogram& fine, double bin) {
  return {holds(fine.bin, bin) ? Verdict::kAgrees : Verdict::kDisagrees,
          fmt::format("95 % of frames: bin {:g} to {:g} (median {:g})", fine.bin.low, fine.bin.high,
                      fine.bin.median)};
}

Judgement judge_filters(const FilteredCounts& narrow, const FilteredCounts& wide, const Estimate& narrow_rmse,
                        const Estimate& wide_rmse) {
  const bool cuts = narrow.kept.high < wide.kept.low;
  const bool worse = narrow_rmse.interval.low > wide_rmse.interval.high;
  const bool open = !worse && narrow_rmse.interval.high > wide_rmse.interval.low;
  const Verdict verdict = !cuts || (!worse && !open) ? Verdict::kDisagrees
                          : worse                    ? Verdict::kAgrees
                                                     : Verdict::kOpen;
  return {verdict,
          fmt::format("kept of the pulse in 95 % of frames: {:.0f} to {:.0f} % with {}, {:.0f} to {:.0f} % "
                      "with {}; rmse {:.1f} [{:.1f}, {:.1f}] and {:.1f} [{:.1f}, {:.1f}] mm",
                      narrow.kept.low * 100.0, narrow.kept.high * 100.0, guard_title(narrow.guard),
                      wide.kept.low * 100.0, wide.kept.high * 100.0, wide.guard, narrow_rmse.value * 1e3,
                      narrow_rmse.interval.low * 1e3, narrow_rmse.interval.high * 1e3, wide_rmse.value * 1e3,
                      wide_rmse.interval.low * 1e3, wide_rmse.interval.high * 1e3)};
}

Judgement judge_far_peak(const HistogramPeaks& far, const HistogramPeaks& near) {
  const Interval& away = far.fake_share.interval;
  const Interval& close = near.fake_share.interval;
  return {away.low > close.high   ? Verdict::kAgrees
          : away.high < close.low ? Verdict::kDisagrees
                                  : Verdict::kOpen,
          fmt::format("highest bin off by more than 10 %: {:.1f} [{:.1f}, {:.1f}] % of frames there, {:.1f} "
                      "[{:.1f}, {:.1f}] % nearer",
                      far.fake_share.value * 100.0, away.low * 100.0, away.high * 100.0,
                      near.fake_share.value * 100.0, close.low * 100.0, close.high * 100.0)};
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
