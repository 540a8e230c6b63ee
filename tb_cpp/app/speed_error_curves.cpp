// SPDX-License-Identifier: Apache-2.0
#include "app/speed_error_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>

#include "analytic/code_distribution.hpp"
#include "core/parallel.hpp"
#include "metrics/depth.hpp"
#include "metrics/error_statistics.hpp"
#include "photon/fast_photon_source.hpp"
#include "readout/model.hpp"
#include "readout/run_frame.hpp"

namespace dtof {
namespace {

constexpr std::array kReadouts = {Readout::kEzPointer, Readout::kHisPointer, Readout::kSifh, Readout::kFifh,
                                  Readout::kThreeSteps};
constexpr std::array kDistances = {0.5, 1.0, 2.0, 3.0};
constexpr double kKlux = 14.0;
constexpr std::array kFrames = {100, 200, 500, 1000, 2000, 5000, 10'000, 20'000, 50'000, 100'000};
constexpr int kBlock = 100;  // rows: every column is a set of this many frames of one pixel

using BlockErrors = std::array<ErrorStatistics, kReadouts.size()>;

struct Answer {
  double bias;  // relative to the distance
  double precision;
};

/// Exact frames of one pixel at a distance, as the independent pixels of a flat scene.
PhotonSource frames_at(const SensorModel& sensor, double distance, int frames, std::uint64_t seed) {
  return {
      sensor,
      TargetMap(frames / kBlock, kBlock, {.depth_m = distance, .reflectivity = sensor.default_reflectivity}),
      kKlux, seed};
}

using ReadColumn = std::function<std::vector<PixelResult>(int column, const ReadoutParameters& parameters)>;

/// Errors of every block, from `columns(column)`, which draws a block's photons.
std::vector<BlockErrors> block_errors(const SensorModel& sensor, double distance, int blocks, int threads,
                                      const std::function<ReadColumn(int column)>& columns) {
  std::vector<BlockErrors> errors(static_cast<std::size_t>(blocks));
  parallel_for(errors.size(), threads, [&](std::size_t block) {
    const ReadColumn read = columns(static_cast<int>(block));
    for (std::size_t r = 0; r < kReadouts.size(); ++r) {
      const ReadoutParameters parameters = ReadoutParameters::defaults(kReadouts[r], sensor.np);
      const DepthScale scale(sensor.integration_time_s, parameters.np, sensor.pulse_fwhm_s);
      for (const PixelResult& result : read(static_cast<int>(block), parameters)) {
        errors[block][r].add(distance, scale.depth(code_position(result, parameters.fraction_bits)));
      }
    }
  });
  return errors;
}

std::vector<BlockErrors> stream_errors(const StreamSource& source, const SensorModel& sensor, double distance,
                                       int threads) {
  return block_errors(sensor, distance, source.columns(), threads, [&](int column) {
    return [&source, stream = source.column(column)](int, const ReadoutParameters& parameters) {
      return make_readout_model(parameters)->run_column(stream, source.acquisitions());
    };
  });
}

std::vector<BlockErrors> sampler_errors(const SampledSource& source, const SensorModel& sensor,
                                        double distance, int threads) {
  return block_errors(sensor, distance, source.columns(), threads, [&](int) {
    return [&source](int column, const ReadoutParameters& parameters) {
      std::vector<PixelResult> results(kBlock);
      make_readout_model(parameters)
          ->run_sampled_column(*source.pixel_sampler(), column, source.acquisitions(), results);
      return results;
    };
  });
}

/// Of blocks [begin, end) together.
Answer answer(const std::vector<BlockErrors>& errors, std::size_t readout, std::size_t begin, std::size_t end,
              double distance) {
  ErrorStatistics all;
  for (std::size_t block = begin; block < end; ++block) {
    all.merge(errors[block][readout]);
  }
  const ErrorSummary summary = all.summary();
  return {summary.bias_m / distance, summary.relative_precision};
}

double squared_distance(const Answer& a, const Answer& b) {
  return (a.bias - b.bias) * (a.bias - b.bias) + (a.precision - b.precision) * (a.precision - b.precision);
}

/// Root of the mean of squared differences, two an answer, in per cent.
class RmsPercent {
 public:
  void add(const Answer& a, const Answer& b) {
    sum_ += squared_distance(a, b);
    count_ += 2.0;
  }
  [[nodiscard]] double value() const { return std::sqrt(sum_ / count_) * 100.0; }

 private:
  double sum_ = 0.0;
  double count_ = 0.0;
};

double cpu_ms(const std::function<void()>& run, int repeats) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t begin = std::clock();
    run();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

}  // namespace

std::vector<ErrorCurve> speed_error_curves(const SensorModel& sensor, std::uint64_t seed, int threads) {
  enum Model : std::uint8_t { kExact, kFastStream, kFastSampler, kAnalytic, kModels };
  std::vector<ErrorCurve> curves(kModels);
  curves[kExact].model = "exact";
  curves[kFastStream].model = "fast stream";
  curves[kFastSampler].model = "fast sampler";
  curves[kAnalytic].model = "analytic";
  const ReadoutParameters timed = ReadoutParameters::defaults(Readout::kHisPointer, sensor.np);

  std::array<std::array<RmsPercent, kFrames.size()>, kModels> errors;
  for (const double distance : kDistances) {
    const std::vector<BlockErrors> truth = stream_errors(
        frames_at(sensor, distance, kCurveReferenceFrames, seed).at_frame(1), sensor, distance, threads);
    const PhotonSource exact = frames_at(sensor, distance, kFrames.back(), seed);
    const FastPhotonSource fast(exact);
    const std::array drawn = {stream_errors(exact, sensor, distance, threads),
                              stream_errors(fast, sensor, distance, threads),
                              sampler_errors(fast, sensor, distance, threads)};
    for (std::size_t r = 0; r < kReadouts.size(); ++r) {
      const Answer right = answer(truth, r, 0, truth.size(), distance);
      for (std::size_t model = 0; model < drawn.size(); ++model) {
        for (std::size_t n = 0; n < kFrames.size(); ++n) {
          const auto blocks = static_cast<std::size_t>(kFrames[n] / kBlock);
          for (std::size_t begin = 0; begin + blocks <= drawn[model].size(); begin += blocks) {
            errors[model][n].add(answer(drawn[model], r, begin, begin + blocks, distance), right);
          }
        }
      }
      const ReadoutParameters parameters = ReadoutParameters::defaults(kReadouts[r], sensor.np);
      const PredictedErrors predicted = predict_errors(
          code_distribution(sensor, exact.rates(0, 0), parameters), sensor, parameters, distance);
      errors[kAnalytic][0].add({predicted.bias_m / distance, predicted.relative_precision}, right);
    }
  }

  for (std::size_t n = 0; n < kFrames.size(); ++n) {
    // Long runs are steady enough.
    const int repeats = kFrames[n] > 10'000 ? 1 : 3;
    std::array<double, kAnalytic> time{};
    for (const double distance : kDistances) {
      const PhotonSource exact = frames_at(sensor, distance, kFrames[n], seed);
      const FastPhotonSource fast(exact);
      time[kExact] += cpu_ms([&] { (void)run_frame(exact, timed, threads); }, repeats);
      time[kFastStream] += cpu_ms([&] { (void)run_frame(fast, timed, threads); }, repeats);
      time[kFastSampler] += cpu_ms([&] { (void)run_sampled_frame(fast, timed, threads); }, repeats);
    }
    for (std::size_t model = 0; model < time.size(); ++model) {
      curves[model].frames.push_back(kFrames[n]);
      curves[model].cpu_ms.push_back(time[model] / kDistances.size());
      curves[model].error_percent.push_back(errors[model][n].value());
    }
  }
  double analytic_time = 0.0;
  for (const double distance : kDistances) {
    const PixelRates rates = frames_at(sensor, distance, kBlock, seed).rates(0, 0);
    analytic_time += cpu_ms([&] { (void)code_distribution(sensor, rates, timed); }, 3);
  }
  curves[kAnalytic].cpu_ms.push_back(analytic_time / kDistances.size());
  curves[kAnalytic].error_percent.push_back(errors[kAnalytic][0].value());
  return curves;
}

}  // namespace dtof
