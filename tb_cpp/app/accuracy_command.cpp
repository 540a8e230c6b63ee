// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/plot.hpp"
#include "app/readout_run.hpp"
#include "app/table.hpp"
#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "metrics/cramer_rao.hpp"
#include "metrics/depth.hpp"
#include "metrics/error_statistics.hpp"
#include "photon/photon_source.hpp"
#include "photon/physics.hpp"

namespace dtof {
namespace {

struct AccuracyOptions {
  ReadoutOptions readout;
  RunOptions run;
  SensorOptions sensor;
  std::vector<double> distances_m = {0.2, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0};
  int frames = 1000;
  std::optional<double> reflectivity;
  std::string out = "build/accuracy";
  std::string command_line;
};

// Every pixel of a flat scene is one independent frame: `frames` pixels in equally long columns.
TargetMap independent_frames(int frames, PixelTarget target) {
  constexpr int kMostRows = 160;
  int rows = std::min(frames, kMostRows);
  while (frames % rows != 0) {
    --rows;
  }
  return {frames / rows, rows, target};
}

double cramer_rao_m(const PhotonSource& source, const DepthScale& scale) {
  const PixelRates rates = source.rates(0, 0);
  const SensorModel& sensor = source.model();
  return scale.bin_depth() *
         cramer_rao_bound({.signal_events = rates.signal,
                           .background_events = rates.background,
                           .centre_bins = rates.centre_bins,
                           .sigma_bins = pulse_sigma_s(sensor.pulse_fwhm_s) / sensor.time_resolution_s(),
                           .np = sensor.np,
                           .acquisitions = static_cast<double>(sensor.acquisitions),
                           .kept_events = sensor.slots});
}

void run_accuracy_command(const AccuracyOptions& options) {
  options.run.validate();
  if (options.run.columns != "all" || !options.run.trace.empty()) {
    throw InputError("accuracy: --columns and --trace do not apply, every frame is read out");
  }
  const std::vector<ReadoutParameters> readouts = options.readout.parameters();
  const SensorModel sensor = options.sensor.model(options.readout.np, readouts.front().slots);
  const PixelTarget target{.reflectivity = options.reflectivity.value_or(sensor.default_reflectivity)};
  create_output_folder(options.out);
  Table table({"read-out", "distance m", "relative precision", "bias mm", "std mm", "rmse mm", "above 3 %",
               "above 10 %", "Cramer-Rao mm"});
  Table slopes({"read-out", "slope", "intercept mm"});
  std::vector<PlotSeries> series;
  for (const ReadoutParameters& parameters : readouts) {
    const std::string title(readout_title(parameters.readout));
    const DepthScale scale(sensor.integration_time_s, parameters.np, sensor.pulse_fwhm_s);
    PlotSeries& line = series.emplace_back(PlotSeries{title, {}, {}});
    std::vector<double> truths;
    std::vector<double> means;
    for (const double distance : options.distances_m) {
      PixelTarget at_distance = target;
      at_distance.depth_m = distance;
      const PhotonSource source(sensor, independent_frames(options.frames, at_distance), options.sensor.klux,
                                options.run.seed, static_cast<std::uint32_t>(truths.size()));
      const ReadoutRun run = run_readout(source, parameters, options.run, {}, options.command_line);
      ErrorStatistics statistics;
      for (const PixelResult& result : run.results) {
        statistics.add(distance, scale.depth(code_position(result, parameters.fraction_bits)));
      }
      const ErrorSummary summary = statistics.summary();
      table.add({title, fmt::format("{:g}", distance),
                 fmt::format("{:.2f} %", summary.relative_precision * 100.0),
                 fmt::format("{:.1f}", summary.bias_m * 1e3),
                 fmt::format("{:.1f}", summary.standard_deviation_m * 1e3),
                 fmt::format("{:.1f}", summary.rmse_m * 1e3),
                 fmt::format("{:.1f} %", summary.share_above_3_percent * 100.0),
                 fmt::format("{:.1f} %", summary.share_above_10_percent * 100.0),
                 fmt::format("{:.2f}", cramer_rao_m(source, scale) * 1e3)});
      line.x.push_back(distance);
      line.y.push_back(summary.relative_precision * 100.0);
      truths.push_back(distance);
      means.push_back(distance + summary.bias_m);
    }
    if (truths.size() > 1) {
      const LinearFit fit = fit_line(truths, means);
      slopes.add({title, fmt::format("{:.3f}", fit.slope), fmt::format("{:.0f}", fit.intercept * 1e3)});
    }
  }
  const std::filesystem::path folder(options.out);
  const std::string heading = fmt::format(
      "{} frames a point, {} klux, preset {}, {} acquisitions, engine {}, seed {}; before the host's look-up "
      "table.\n",
      options.frames, options.sensor.klux, options.sensor.preset, sensor.acquisitions, options.run.engine,
      options.run.seed);
  write_file(folder / "accuracy.csv", table.csv());
  write_file(folder / "accuracy.md", fmt::format("{}\n{}\n{}\nCommand: `{}`\n", heading, table.markdown(),
                                                 slopes.markdown(), options.command_line));
  write_plot(folder / "relative_precision.svg", series,
             {.title = fmt::format("Relative precision, {} klux, preset {}", options.sensor.klux,
                                   options.sensor.preset),
              .x_label = "distance, m",
              .y_label = "relative precision, %",
              .logarithmic_y = true,
              .y_limits = {3.0}});
  fmt::print("{}\n{}\n{}\nTables and plot are in {}\n", heading, table.markdown(), slopes.markdown(),
             options.out);
}

}  // namespace

void add_accuracy_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<AccuracyOptions>();
  options->command_line = command_line;
  CLI::App* command =
      app.add_subcommand("accuracy", "Distance sweep: precision, bias and outliers of every read-out");
  command->add_option("-d,--distances", options->distances_m, "distances in m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("-n,--frames", options->frames, "frames a distance")
      ->check(CLI::Range(2, 10'000'000))
      ->capture_default_str();
  command->add_option("--reflectivity", options->reflectivity, "of the target (default: the preset's)");
  options->sensor.add_to(*command);
  options->readout.add_to(*command);
  options->run.add_to(*command);
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options] { run_accuracy_command(*options); });
}

}  // namespace dtof
