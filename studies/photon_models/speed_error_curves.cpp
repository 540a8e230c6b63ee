// SPDX-License-Identifier: Apache-2.0
#include "photon_models/speed_error_curves.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>

#include "dtof/analytic/code_distribution.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

constexpr std::array kReadouts = {Readout::kEzPointer, Readout::kHisPointer, Readout::kSifh, Readout::kFifh,
                                  Readout::kThreeSteps};
/// By read-out, then by block: every column of a frame is a block of one pixel's frames.
using BlockErrors = std::array<std::vector<ErrorStatistics>, kReadouts.size()>;

/// Exact frames of one pixel at a distance, as the independent pixels of a flat scene.
PhotonSource frames_at(const SensorModel& sensor, double distance, double klux, int frames,
                       std::uint64_t seed) {
  return {sensor,
          TargetMap(frames / kCurveBlock, kCurveBlock,
                    {.depth_m = distance, .reflectivity = sensor.default_reflectivity}),
          klux, seed};
}

using ReadColumn = std::function<std::vector<PixelResult>(int column, const ReadoutParameters& parameters)>;

/// Errors of every block, from `columns(column)`, which draws a block's photons.
BlockErrors block_errors(const SensorModel& sensor, double distance, int blocks, int threads,
                         const std::function<ReadColumn(int column)>& columns) {
  BlockErrors errors;
  errors.fill(std::vector<ErrorStatistics>(static_cast<std::size_t>(blocks)));
  parallel_for(static_cast<std::size_t>(blocks), threads, [&](std::size_t block) {
    const ReadColumn read = columns(static_cast<int>(block));
    for (std::size_t r = 0; r < kReadouts.size(); ++r) {
      const ReadoutParameters parameters = default_parameters(kReadouts[r], sensor);
      const DepthScale scale(sensor.integration_time_s, parameters.np, sensor.pulse_fwhm_s);
      for (const PixelResult& result : read(static_cast<int>(block), parameters)) {
        errors[r][block].add(distance, scale.depth(code_position(result, parameters.fraction_bits)));
      }
    }
  });
  return errors;
}

BlockErrors stream_errors(const StreamSource& source, const SensorModel& sensor, double distance,
                          int threads) {
  return block_errors(sensor, distance, source.columns(), threads, [&](int column) {
    return [&source, stream = source.column(column)](int, const ReadoutParameters& parameters) {
      return make_readout_model(parameters)->run_column(stream, source.acquisitions());
    };
  });
}

BlockErrors sampler_errors(const SampledSource& source, const SensorModel& sensor, double distance,
                           int threads) {
  return block_errors(sensor, distance, source.columns(), threads, [&](int) {
    return [&source](int column, const ReadoutParameters& parameters) {
      std::vector<PixelResult> results(kCurveBlock);
      make_readout_model(parameters)
          ->run_sampled_column(*source.pixel_sampler(), column, source.acquisitions(), results);
      return results;
    };
  });
}

/// Number of timed runs; one is enough where a run is long.
int repeats_of(int frames) { return frames > 10'000 ? 1 : 3; }

bool is_blocks(int frames) { return frames >= kCurveBlock && frames % kCurveBlock == 0; }

}  // namespace

void ErrorCurveSettings::validate() const {
  if (distances_m.empty() || frames.empty()) {
    throw InputError("error curves need at least one distance and one number of frames");
  }
  const bool ascending = std::ranges::adjacent_find(frames, std::ranges::greater_equal()) == frames.end();
  if (!ascending || !std::ranges::all_of(frames, is_blocks) || !is_blocks(reference_frames)) {
    throw InputError(
        fmt::format("error curves: numbers of frames must be ascending multiples of {}, not {}; {}",
                    kCurveBlock, fmt::join(frames, ", "), reference_frames));
  }
}

ErrorAnswer error_answer(std::span<const ErrorStatistics> blocks, double distance_m) {
  ErrorStatistics all;
  for (const ErrorStatistics& block : blocks) {
    all.merge(block);
  }
  const ErrorSummary summary = all.summary();
  return {.bias = summary.bias_m / distance_m, .precision = summary.relative_precision};
}

void AnswerError::add(const ErrorAnswer& answer, const ErrorAnswer& truth) {
  const double bias = answer.bias - truth.bias;
  const double precision = answer.precision - truth.precision;
  sum_ += bias * bias + precision * precision;
  count_ += 2.0;
}

void AnswerError::add_sets(std::span<const ErrorStatistics> blocks, std::size_t blocks_a_set,
                           double distance_m, const ErrorAnswer& truth) {
  for (std::size_t begin = 0; begin + blocks_a_set <= blocks.size(); begin += blocks_a_set) {
    add(error_answer(blocks.subspan(begin, blocks_a_set), distance_m), truth);
  }
}

double AnswerError::percent() const { return std::sqrt(sum_ / count_) * 100.0; }

double least_cpu_ms(const std::function<void()>& run, int repeats) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t begin = std::clock();
    run();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

std::vector<ErrorCurve> speed_error_curves(const SensorModel& sensor, const ErrorCurveSettings& settings,
                                           std::uint64_t seed, int threads) {
  settings.validate();
  enum Model : std::uint8_t { kExact, kFastStream, kFastSampler, kAnalytic, kModels };
  std::vector<ErrorCurve> curves(kModels);
  curves[kExact].model = "exact";
  curves[kFastStream].model = "fast stream";
  curves[kFastSampler].model = "fast sampler";
  curves[kAnalytic].model = "analytic";
  const ReadoutParameters timed = default_parameters(Readout::kHisPointer, sensor);
  const std::vector<int>& frames = settings.frames;
  const auto pixel_at = [&](double distance, int count) {
    return frames_at(sensor, distance, settings.klux, count, seed);
  };

  std::array<std::vector<AnswerError>, kAnalytic> errors;
  errors.fill(std::vector<AnswerError>(frames.size()));
  AnswerError analytic_error;
  for (const double distance : settings.distances_m) {
    const BlockErrors truth =
        stream_errors(pixel_at(distance, settings.reference_frames).at_frame(1), sensor, distance, threads);
    const PhotonSource exact = pixel_at(distance, frames.back());
    const FastPhotonSource fast(exact);
    const std::array drawn = {stream_errors(exact, sensor, distance, threads),
                              stream_errors(fast, sensor, distance, threads),
                              sampler_errors(fast, sensor, distance, threads)};
    for (std::size_t r = 0; r < kReadouts.size(); ++r) {
      const ErrorAnswer right = error_answer(truth[r], distance);
      for (std::size_t model = 0; model < drawn.size(); ++model) {
        for (std::size_t n = 0; n < frames.size(); ++n) {
          errors[model][n].add_sets(drawn[model][r], static_cast<std::size_t>(frames[n] / kCurveBlock),
                                    distance, right);
        }
      }
      const ReadoutParameters parameters = default_parameters(kReadouts[r], sensor);
      const PredictedErrors predicted = predict_errors(
          code_distribution(sensor, exact.rates(0, 0), parameters), sensor, parameters, distance);
      analytic_error.add({.bias = predicted.bias_m / distance, .precision = predicted.relative_precision},
                         right);
    }
  }

  const auto distance_count = static_cast<double>(settings.distances_m.size());
  for (std::size_t n = 0; n < frames.size(); ++n) {
    const int repeats = repeats_of(frames[n]);
    std::array<double, kAnalytic> time{};
    for (const double distance : settings.distances_m) {
      const PhotonSource exact = pixel_at(distance, frames[n]);
      const FastPhotonSource fast(exact);
      time[kExact] += least_cpu_ms([&] { (void)run_frame(exact, timed, threads); }, repeats);
      time[kFastStream] += least_cpu_ms([&] { (void)run_frame(fast, timed, threads); }, repeats);
      time[kFastSampler] += least_cpu_ms([&] { (void)run_sampled_frame(fast, timed, threads); }, repeats);
    }
    for (std::size_t model = 0; model < time.size(); ++model) {
      curves[model].frames.push_back(frames[n]);
      curves[model].cpu_ms.push_back(time[model] / distance_count);
      curves[model].error_percent.push_back(errors[model][n].percent());
    }
  }
  double analytic_time = 0.0;
  for (const double distance : settings.distances_m) {
    const PixelRates rates = pixel_at(distance, kCurveBlock).rates(0, 0);
    analytic_time += least_cpu_ms([&] { (void)code_distribution(sensor, rates, timed); }, 3);
  }
  curves[kAnalytic].cpu_ms.push_back(analytic_time / distance_count);
  curves[kAnalytic].error_percent.push_back(analytic_error.percent());
  return curves;
}

double cost_to_reach(const ErrorCurve& curve, double error_percent) {
  for (std::size_t i = 0; i < curve.cpu_ms.size(); ++i) {
    if (curve.error_percent[i] > error_percent) {
      continue;
    }
    if (i == 0 || curve.error_percent[i] == curve.error_percent[i - 1]) {
      return curve.cpu_ms[i];
    }
    const double part = std::log(curve.error_percent[i - 1] / error_percent) /
                        std::log(curve.error_percent[i - 1] / curve.error_percent[i]);
    return curve.cpu_ms[i - 1] * std::pow(curve.cpu_ms[i] / curve.cpu_ms[i - 1], part);
  }
  return std::nan("");
}

}  // namespace dtof
