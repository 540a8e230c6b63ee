// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/analytic/code_distribution.hpp"
#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "photon_models/speed_error_curves.hpp"
#include "photon_models/speed_error_report.hpp"

namespace dtof {
namespace {

struct SpeedErrorOptions {
  RunSettings run;
  std::string sensor = "thesis";
  int frames = 20000;
  std::string out = "reports";
  std::string command_line;
};

constexpr std::array kReadouts = {Readout::kEzPointer, Readout::kHisPointer, Readout::kSifh, Readout::kFifh,
                                  Readout::kThreeSteps};
constexpr std::array kKlux = {2.0, 14.0, 50.0};
constexpr std::array kDistances = {0.5, 1.0, 2.0, 3.0, 5.0};
constexpr int kRows = 100;

/// What is compared with the exact model.
enum class PhotonRoute { kExactAgain, kFastStream, kFastSampler, kAnalytic };
constexpr std::array kRivals = {PhotonRoute::kExactAgain, PhotonRoute::kFastStream, PhotonRoute::kFastSampler,
                                PhotonRoute::kAnalytic};

std::string rival_title(PhotonRoute rival) {
  switch (rival) {
    case PhotonRoute::kExactAgain:
      return "exact";
    case PhotonRoute::kFastStream:
      return "fast stream";
    case PhotonRoute::kFastSampler:
      return "fast sampler";
    case PhotonRoute::kAnalytic:
      return "analytic";
  }
  throw std::logic_error("unknown photon model");
}

/// Pixels of one scene: detections by code, pixels by number of detections, results by read-out and code.
struct Sample {
  std::vector<std::uint64_t> codes;
  std::vector<std::uint64_t> numbers;
  std::vector<std::vector<std::uint64_t>> results;

  explicit Sample(const SensorModel& sensor)
      : codes(std::size_t{1} << static_cast<unsigned>(sensor.np)),
        numbers(static_cast<std::size_t>(sensor.slots) * sensor.acquisitions + 1),
        results(kReadouts.size(), std::vector<std::uint64_t>(codes.size())) {}
};

Sample sample_streams(const StreamSource& source, const SensorModel& sensor, int threads) {
  std::vector<ColumnStream> columns(static_cast<std::size_t>(source.columns()));
  std::vector<std::array<std::vector<PixelResult>, kReadouts.size()>> results(columns.size());
  parallel_for(columns.size(), threads, [&](std::size_t i) {
    columns[i] = source.column(static_cast<int>(i));
    for (std::size_t r = 0; r < kReadouts.size(); ++r) {
      results[i][r] = make_readout_model(default_parameters(kReadouts[r], sensor))
                          ->run_column(columns[i], source.acquisitions());
    }
  });
  Sample sample(sensor);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (int row = 0; row < columns[i].rows(); ++row) {
      ++sample.numbers.at(columns[i].row(row).size());
      for (const Detection& detection : columns[i].row(row)) {
        ++sample.codes.at(detection.timestamp);
      }
    }
    for (std::size_t r = 0; r < kReadouts.size(); ++r) {
      for (const PixelResult& result : results[i][r]) {
        ++sample.results[r].at(result.code);
      }
    }
  }
  return sample;
}

Sample sample_sampler(const SampledSource& source, const SensorModel& sensor, int threads) {
  Sample sample(sensor);
  const auto sampler = source.pixel_sampler();
  for (int column = 0; column < source.columns(); ++column) {
    for (int row = 0; row < source.rows(); ++row) {
      sampler->start_pixel(column, row);
      const auto codes = sampler->draw(source.acquisitions(), 0, 1 << sensor.np);
      ++sample.numbers.at(codes.size());
      for (const Timestamp code : codes) {
        ++sample.codes.at(code);
      }
    }
  }
  for (std::size_t r = 0; r < kReadouts.size(); ++r) {
    for (const PixelResult& result :
         run_sampled_frame(source, default_parameters(kReadouts[r], sensor), threads)) {
      ++sample.results[r].at(result.code);
    }
  }
  return sample;
}

/// p-value of two sets of counts having one distribution. Neighbouring classes are joined until each has at
/// least 20 counts of both sets together.
double two_sample_p(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b, double scale) {
  double chi_square = 0.0;
  double classes = 0.0;
  double in_a = 0.0;
  double in_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    in_a += static_cast<double>(a[i]);
    in_b += static_cast<double>(b[i]) * scale;
    if (in_a + in_b >= 20.0) {
      chi_square += (in_a - in_b) * (in_a - in_b) / (in_a + in_b);
      classes += 1.0;
      in_a = in_b = 0.0;
    }
  }
  if (classes < 2.0) {
    return 1.0;
  }
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared_distribution<double>(classes - 1.0), chi_square));
}

/// p-value of counts being those of independent trials with these probabilities (any positive sum).
double one_sample_p(const std::vector<std::uint64_t>& counts, const std::vector<double>& weights) {
  double trials = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    trials += static_cast<double>(counts[i]);
    weight += weights[i];
  }
  double chi_square = 0.0;
  double classes = 0.0;
  double observed = 0.0;
  double expected = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    observed += static_cast<double>(counts[i]);
    expected += trials * weights[i] / weight;
    if (expected >= 10.0) {
      chi_square += (observed - expected) * (observed - expected) / expected;
      classes += 1.0;
      observed = expected = 0.0;
    }
  }
  if (classes < 2.0) {
    return 1.0;
  }
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared_distribution<double>(classes - 1.0), chi_square));
}

std::vector<double> as_distribution(const std::vector<std::uint64_t>& counts) {
  return {counts.begin(), counts.end()};
}

/// The worst that was seen of one rival.
struct SpeedVerdict {
  double bias = 0.0;       // relative to the distance
  double precision = 0.0;  // change of the relative precision
  double outliers = 0.0;   // change of the share
  double codes_p = 1.0;
  double numbers_p = 1.0;
  double results_p = 1.0;
  double seconds = 0.0;  // processor time of a frame
  double wall_seconds = 0.0;
};

struct Stopwatch {
  std::clock_t processor = std::clock();
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();

  [[nodiscard]] double processor_seconds() const {
    return static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  }
  [[nodiscard]] double wall_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  }
};

/// Least of three runs: what other programs take away is not the model's.
void time_frame(const std::function<void()>& run, SpeedVerdict& verdict) {
  constexpr int kRuns = 3;
  for (int i = 0; i < kRuns; ++i) {
    const Stopwatch watch;
    run();
    const double seconds = watch.processor_seconds();
    const double wall = watch.wall_seconds();
    verdict.seconds = i == 0 ? seconds : std::min(verdict.seconds, seconds);
    verdict.wall_seconds = i == 0 ? wall : std::min(verdict.wall_seconds, wall);
  }
}

class SpeedErrorReport {
 public:
  explicit SpeedErrorReport(const SpeedErrorOptions& options)
      : options_(options), sensor_(find_sensor(options.sensor)), verdicts_(kRivals.size()) {}

  void run() {
    for (const double klux : kKlux) {
      for (const double distance : kDistances) {
        compare(klux, distance);
      }
    }
    time_rivals();
    write();
  }

 private:
  void compare(double klux, double distance) {
    const int columns = (options_.frames + kRows - 1) / kRows;
    const PhotonSource exact(
        sensor_,
        TargetMap(columns, kRows, {.depth_m = distance, .reflectivity = sensor_.default_reflectivity}), klux,
        options_.run.seed);
    const FastPhotonSource fast(exact);
    const PixelRates rates = exact.rates(0, 0);
    const Sample reference = sample_streams(exact, sensor_, options_.run.threads);
    for (std::size_t i = 0; i < kRivals.size(); ++i) {
      if (kRivals[i] == PhotonRoute::kAnalytic) {
        compare_analytic(klux, distance, rates, reference, verdicts_[i]);
        continue;
      }
      const Sample sample = kRivals[i] == PhotonRoute::kExactAgain
                                ? sample_streams(exact.at_frame(1), sensor_, options_.run.threads)
                                : (kRivals[i] == PhotonRoute::kFastStream
                                       ? sample_streams(fast, sensor_, options_.run.threads)
                                       : sample_sampler(fast, sensor_, options_.run.threads));
      SpeedVerdict& verdict = verdicts_[i];
      const double total_ratio = as_ratio(reference.codes, sample.codes);
      verdict.codes_p = std::min(verdict.codes_p, two_sample_p(reference.codes, sample.codes, total_ratio));
      verdict.numbers_p = std::min(verdict.numbers_p, two_sample_p(reference.numbers, sample.numbers, 1.0));
      for (std::size_t r = 0; r < kReadouts.size(); ++r) {
        verdict.results_p =
            std::min(verdict.results_p, two_sample_p(reference.results[r], sample.results[r], 1.0));
        add_point(kRivals[i], kReadouts[r], klux, distance, as_distribution(reference.results[r]),
                  as_distribution(sample.results[r]), verdict);
      }
    }
  }

  void compare_analytic(double klux, double distance, const PixelRates& rates, const Sample& reference,
                        SpeedVerdict& verdict) {
    verdict.codes_p =
        std::min(verdict.codes_p, one_sample_p(reference.codes, expected_detections(sensor_, rates)));
    for (std::size_t r = 0; r < kReadouts.size(); ++r) {
      const std::vector<double> predicted =
          code_distribution(sensor_, rates, default_parameters(kReadouts[r], sensor_));
      verdict.results_p = std::min(verdict.results_p, one_sample_p(reference.results[r], predicted));
      add_point(PhotonRoute::kAnalytic, kReadouts[r], klux, distance, as_distribution(reference.results[r]),
                predicted, verdict);
    }
    verdict.numbers_p = std::nan("");  // it has no numbers
  }

  static double as_ratio(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
    double in_a = 0.0;
    double in_b = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      in_a += static_cast<double>(a[i]);
      in_b += static_cast<double>(b[i]);
    }
    return in_a / in_b;
  }

  void add_point(PhotonRoute rival, Readout readout, double klux, double distance,
                 const std::vector<double>& reference, const std::vector<double>& other,
                 SpeedVerdict& verdict) {
    const ReadoutParameters parameters = default_parameters(readout, sensor_);
    const PredictedErrors a = predict_errors(reference, sensor_, parameters, distance);
    const PredictedErrors b = predict_errors(other, sensor_, parameters, distance);
    const double bias = std::abs(b.bias_m - a.bias_m) / distance;
    const double precision = std::abs(b.relative_precision - a.relative_precision);
    const double outliers = std::abs(b.share_above_10_percent - a.share_above_10_percent);
    verdict.bias = std::max(verdict.bias, bias);
    verdict.precision = std::max(verdict.precision, precision);
    verdict.outliers = std::max(verdict.outliers, outliers);
    points_.add({rival_title(rival), std::string(readout_name(readout)), fmt::format("{}", klux),
                 fmt::format("{}", distance), fmt::format("{:.6f}", a.relative_precision),
                 fmt::format("{:.6f}", b.relative_precision), fmt::format("{:.6f}", a.bias_m),
                 fmt::format("{:.6f}", b.bias_m), fmt::format("{:.5f}", a.share_above_10_percent),
                 fmt::format("{:.5f}", b.share_above_10_percent)});
  }

  void time_rivals() {
    constexpr double kFrameKlux = 14.0;
    const PhotonSource exact(sensor_,
                             make_scene(Scene::kPlane, {.reflectivity = sensor_.default_reflectivity}),
                             kFrameKlux, options_.run.seed);
    const FastPhotonSource fast(exact);
    const auto mean = make_source(Fidelity::kAnalytic, exact);
    const ReadoutParameters parameters = default_parameters(Readout::kHisPointer, sensor_);
    const int threads = options_.run.threads;
    for (int column = 0; column < exact.columns(); ++column) {
      detections_ += exact.column(column).detection_count();
    }
    const std::array<std::function<void()>, kRivals.size()> runs = {
        [&] { (void)run_frame(exact, parameters, threads); },
        [&] { (void)run_frame(fast, parameters, threads); },
        [&] { (void)run_sampled_frame(fast, parameters, threads); },
        [&] { (void)run_sampled_frame(dynamic_cast<const SampledSource&>(*mean), parameters, threads); }};
    for (std::size_t i = 0; i < kRivals.size(); ++i) {
      time_frame(runs[i], verdicts_[i]);
    }
    // A point of a distance sweep: 1,000 frames against one distribution.
    const PhotonSource sweep(
        sensor_, TargetMap(10, kRows, {.depth_m = 3.0, .reflectivity = sensor_.default_reflectivity}),
        kFrameKlux, options_.run.seed);
    const FastPhotonSource fast_sweep(sweep);
    const std::array<std::function<void()>, kRivals.size()> points = {
        [&] { (void)run_frame(sweep, parameters, threads); },
        [&] { (void)run_frame(fast_sweep, parameters, threads); },
        [&] { (void)run_sampled_frame(fast_sweep, parameters, threads); },
        [&] { (void)code_distribution(sensor_, sweep.rates(0, 0), parameters); }};
    for (std::size_t i = 0; i < kRivals.size(); ++i) {
      time_frame(points[i], point_times_[i]);
    }
  }

  [[nodiscard]] ModelCosts costs() const {
    return {.exact_stream_ms = verdicts_[0].seconds * 1e3,
            .fast_stream_ms = verdicts_[1].seconds * 1e3,
            .fast_sampler_ms = verdicts_[2].seconds * 1e3};
  }

  /// Time, largest changes and p-values of each model.
  [[nodiscard]] Table model_table() const {
    const auto percent = [](double share) { return fmt::format("{:.3f}", share * 100.0); };
    const auto p_value = [](double p) { return std::isnan(p) ? std::string("-") : fmt::format("{:.1e}", p); };
    Table table({"model", "frame, CPU ms", "frame, wall ms", "times exact", "1,000 frames, CPU ms", "bias, %",
                 "precision, %", "outliers, %", "p times", "p numbers", "p results"});
    for (std::size_t i = 0; i < kRivals.size(); ++i) {
      const SpeedVerdict& verdict = verdicts_[i];
      table.add({rival_title(kRivals[i]), fmt::format("{:.0f}", verdict.seconds * 1e3),
                 fmt::format("{:.0f}", verdict.wall_seconds * 1e3),
                 fmt::format("{:.1f}", verdicts_.front().seconds / verdict.seconds),
                 fmt::format("{:.1f}", point_times_[i].seconds * 1e3), percent(verdict.bias),
                 percent(verdict.precision), percent(verdict.outliers), p_value(verdict.codes_p),
                 p_value(verdict.numbers_p), p_value(verdict.results_p)});
    }
    return table;
  }

  void write() const {
    create_output_folder(options_.out);
    const std::filesystem::path folder(options_.out);
    write_file(folder / "speed_error.csv", points_.csv());
    const ErrorCurveSettings curve_settings;
    const std::vector<ErrorCurve> curves =
        speed_error_curves(sensor_, curve_settings, options_.run.seed, options_.run.threads);
    std::vector<PlotSeries> series;
    series.reserve(curves.size());
    for (const ErrorCurve& curve : curves) {
      series.push_back({curve.model, curve.cpu_ms, curve.error_percent});
    }
    write_plot(folder / "speed_error.svg", series,
               {.title = fmt::format(
                    "Error in % against CPU time in ms, 100 to 100,000 frames of a pixel: flat targets "
                    "at 0.5 to 3 m, 14 klux, sensor {}",
                    sensor_.name),
                .x_label = "CPU time, ms",
                .y_label = "rms error of bias and relative precision, % of the distance",
                .logarithmic_y = true,
                .logarithmic_x = true});
    const Table models = model_table();
    write_page(
        folder, "speed_error", "speed_error",
        speed_error_page({.sensor = sensor_.name,
                          .seed = options_.run.seed,
                          .frames = options_.frames,
                          .scenes = kKlux.size() * kDistances.size(),
                          .readouts = kReadouts.size(),
                          .acquisitions = sensor_.acquisitions,
                          .detections = detections_,
                          .threads = options_.run.threads == 0 ? hardware_threads() : options_.run.threads,
                          .models = models,
                          .costs = costs(),
                          .curves = curves,
                          .reference_frames = curve_settings.reference_frames,
                          .command_line = options_.command_line}));
    fmt::print("{}\nSeed {}. Written to {}\n", models.markdown(), options_.run.seed,
               (folder / "speed_error.md").string());
  }

  const SpeedErrorOptions& options_;
  SensorModel sensor_;
  std::vector<SpeedVerdict> verdicts_;
  std::array<SpeedVerdict, kRivals.size()> point_times_;
  Table points_{{"model", "read-out", "klux", "distance m", "precision exact", "precision", "bias exact m",
                 "bias m", "outliers exact", "outliers"}};
  std::uint64_t detections_ = 0;
};

}  // namespace

void add_speed_error_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<SpeedErrorOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "speed-error", "Speed of the photon models against their error, measured against the exact one");
  add_sensor_option(*command, options->sensor);
  command->add_option("--frames", options->frames, "frames a scene and model")
      ->check(CLI::Range(200, 10'000'000))
      ->capture_default_str();
  add_study_options(*command, options->run.seed, options->run.threads, options->out);
  command->callback([options] { SpeedErrorReport(*options).run(); });
}

}  // namespace dtof
