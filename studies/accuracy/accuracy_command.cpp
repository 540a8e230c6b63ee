// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "accuracy/accuracy_page.hpp"
#include "accuracy/accuracy_study.hpp"
#include "accuracy/accuracy_tables.hpp"
#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/own_cube.hpp"
#include "command_line/own_map.hpp"
#include "common/commands.hpp"
#include "common/map_accuracy.hpp"
#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/error.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

struct AccuracyOptions {
  ReadoutOptions readout;
  RunSettings run;
  SensorOptions sensor;
  std::vector<double> klux = {14.0};
  std::vector<double> distances_m = {0.2, 0.5, 0.8, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0};
  int frames = 1000;
  std::optional<double> precision_percent;
  double rare_outliers_percent = 0.1;
  std::uint64_t calibration_seed = 1;
  int calibration_frames = 200;
  int most_frames = 100'000;
  std::optional<double> reject_percent;
  std::optional<double> reflectivity;
  MapFiles maps;
  MapScales map_scales;
  CubeOptions cube;
  std::string out = "build/accuracy";
  std::string command_line;
};

/// The photon model for a source's scene, whose streams all read-outs share; one with noise.
Fidelity noisy_model(const SensorOptions& options, const PhotonSource& exact) {
  const Fidelity fidelity = options.photon_model(exact, PhotonUse::kStream, {});
  if (fidelity == Fidelity::kAnalytic) {
    throw InputError(
        "accuracy: the analytic photon model has no noise to measure; choose exact, fast or auto");
  }
  return fidelity;
}

SourceFactory source_factory(const SensorOptions& options) {
  return [options](const SensorModel& sensor, const TargetMap& targets, double klux, std::uint64_t seed,
                   std::uint32_t frame) {
    const PhotonSource exact(sensor, targets, klux, seed, frame);
    return make_source(noisy_model(options, exact), exact);
  };
}

StudySettings settings_of(const AccuracyOptions& options) {
  StudySettings settings;
  settings.readouts = options.readout.parameters(kAllReadouts, options.sensor.described());
  settings.sensor = options.sensor.model(settings.readouts.front().np, settings.readouts.front().slots);
  settings.reflectivity = options.reflectivity.value_or(settings.sensor.default_reflectivity);
  settings.distances_m = options.distances_m;
  for (const double distance_m : settings.distances_m) {
    SensorOptions::require_in_range(settings.sensor, distance_m, "--distances");
  }
  settings.frames = options.frames;
  if (options.precision_percent) {
    settings.precision = *options.precision_percent / 100.0;
  }
  settings.rare_outliers = options.rare_outliers_percent / 100.0;
  settings.calibration_seed = options.calibration_seed;
  settings.calibration_frames = options.calibration_frames;
  settings.most_frames = std::max(options.most_frames, options.frames);
  if (options.reject_percent) {
    settings.rejection = *options.reject_percent / 100.0;
  }
  settings.make_source = source_factory(options.sensor);
  settings.run = options.run;
  settings.command = options.command_line;
  return settings;
}

struct Picture {
  const char* name;
  const char* y_label;
  double (*value)(const AccuracyPoint&);
  std::vector<double> limits;
  bool logarithmic;
};

const std::vector<Picture>& pictures() {
  static const std::vector<Picture> all = {
      {"relative_precision",
       "relative precision, %",
       [](const AccuracyPoint& p) { return p.relative_precision.value * 100.0; },
       {3.0},
       true},
      {"rmse",
       "rmse after the look-up table, % of distance",
       [](const AccuracyPoint& p) { return p.rmse_m.value / p.distance_m * 100.0; },
       {3.0},
       true},
      {"outliers",
       "errors above 10 %, %",
       [](const AccuracyPoint& p) { return p.outlier_rate.value * 100.0; },
       {},
       false},
      {"mean_distance",
       "mean measured distance before the look-up table, m",
       [](const AccuracyPoint& p) { return p.distance_m + p.bias_m.value; },
       {},
       false},
      {"efficiency",
       "Cramer-Rao bound / rmse",
       [](const AccuracyPoint& p) { return p.efficiency.value; },
       {1.0},
       false}};
  return all;
}

void run_accuracy_command(const AccuracyOptions& options) {
  StudySettings settings = settings_of(options);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  std::vector<AccuracyPoint> all;
  std::vector<LightAccuracy> lights;
  for (const double klux : options.klux) {
    settings.klux = klux;
    lights.push_back({klux, run_accuracy_study(settings)});
    const AccuracyStudy& study = lights.back().study;
    all.insert(all.end(), study.points.begin(), study.points.end());
    for (const Picture& picture : pictures()) {
      write_plot(folder / fmt::format("{}_{:g}klux.svg", picture.name, klux),
                 accuracy_series(study.points, picture.value),
                 {.title = fmt::format("{}: flat target, {:g} klux, sensor {}", picture.y_label, klux,
                                       settings.sensor.name),
                  .x_label = "distance, m",
                  .y_label = picture.y_label,
                  .logarithmic_y = picture.logarithmic,
                  .y_limits = picture.limits});
    }
  }
  write_file(folder / "accuracy.csv", accuracy_csv(all).csv());
  const PageData page = accuracy_page(settings, options.sensor.fidelity, lights);
  write_page(folder, "accuracy", "accuracy", page);
  fmt::print("{}\nTables with confidence intervals and plots are in {}\n", page_text("accuracy", page),
             options.out);
}

Table band_csv(const std::vector<BandAccuracy>& rows) {
  std::vector<std::string> header = {"klux", "readout", "from_m", "to_m", "pixels", "frames"};
  for (const char* name : {"bias_m", "rmse_m", "above_3_percent", "above_10_percent"}) {
    header.insert(header.end(), {name, fmt::format("{}_low", name), fmt::format("{}_high", name)});
  }
  Table table(std::move(header));
  for (const BandAccuracy& row : rows) {
    std::vector<std::string> cells = {fmt::format("{:g}", row.klux),     row.readout,
                                      fmt::format("{:.4f}", row.from_m), fmt::format("{:.4f}", row.to_m),
                                      fmt::format("{}", row.pixels),     fmt::format("{}", row.frames)};
    for (const Estimate& e : {row.bias_m, row.rmse_m, row.above_3_percent, row.above_10_percent}) {
      for (const double value : {e.value, e.interval.low, e.interval.high}) {
        cells.push_back(fmt::format("{:.6g}", value));
      }
    }
    table.add(std::move(cells));
  }
  return table;
}

/// The user's map or transient cube.
OwnMap read_own_scene(const AccuracyOptions& options, const StudySettings& sweep) {
  const SensorModel& sensor = sweep.sensor;
  if (options.cube.file.empty()) {
    OwnMap map =
        read_own_map(options.maps, options.map_scales, sensor.columns, sensor.rows, sweep.reflectivity);
    require_reachable(map.targets, sensor, options.maps.depth, true);
    return map;
  }
  OwnMap cube = read_own_cube(options.cube, sensor, sensor.columns, sensor.rows, sweep.reflectivity);
  require_reachable(cube.targets, sensor, options.cube.file);
  return cube;
}

/// With --depth or --cube: errors by distance band over the user's scene. `command` tells which options were
/// given.
void run_over_map(const AccuracyOptions& options, const CLI::App& command) {
  for (const char* option : {"--precision", "--rare-outliers", "--max-frames", "--reject",
                             "--calibration-seed", "--calibration-frames"}) {
    if (command.count(option) > 0) {
      throw InputError(
          fmt::format("accuracy: {} does not apply to a scene of your own (--depth, --cube)", option));
    }
  }
  if (!options.maps.reflectivity.empty() && options.reflectivity) {
    throw InputError("--reflectivity and --reflectivity-map contradict each other: choose one");
  }
  AccuracyOptions without_distances = options;
  without_distances.distances_m.clear();  // the map has its own
  const StudySettings sweep = settings_of(without_distances);
  OwnMap map = read_own_scene(options, sweep);
  MapAccuracySettings settings;
  settings.sensor = sweep.sensor;
  settings.targets = std::move(map.targets);
  settings.readouts = sweep.readouts;
  settings.band_edges_m =
      command.count("--distances") > 0 ? options.distances_m : equal_bands(settings.targets);
  if (command.count("--frames") > 0) {
    settings.frames = options.frames;
  }
  settings.make_source = sweep.make_source;
  settings.run = options.run;
  settings.run.streams_only = true;  // the photon model was chosen for streams
  settings.command = options.command_line;
  std::vector<BandAccuracy> all;
  std::vector<LightBands> lights;
  for (const double klux : options.klux) {
    settings.klux = klux;
    lights.push_back({klux, run_map_accuracy(settings)});
    all.insert(all.end(), lights.back().bands.begin(), lights.back().bands.end());
  }
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  write_file(folder / "accuracy.csv", band_csv(all).csv());
  const PageData page = map_accuracy_page(settings, {map.description, !options.cube.file.empty()},
                                          options.sensor.fidelity, lights);
  write_page(folder, "accuracy", "accuracy_over_a_map", page);
  fmt::print("{}\nTables are in {}\n", page_text("accuracy_over_a_map", page), options.out);
}

/// Checks the options and measures the sweep, the map or the cube that they name.
void run_command(const AccuracyOptions& options, const CLI::App& command) {
  if (!options.precision_percent) {
    refuse_without_effect(command, "--max-frames", "it limits the frames of --precision");
    refuse_without_effect(command, "--rare-outliers", "it limits what --precision waits for");
  }
  options.sensor.refuse_options_without_effect(command);
  check_run_options(options.run);
  if (options.run.columns != "all" || options.run.rows != "all" || !options.run.trace.empty()) {
    throw InputError("accuracy: --columns, --rows and --trace do not apply, every frame is read out");
  }
  if (!options.maps.depth.empty() && !options.cube.file.empty()) {
    throw InputError("--depth and --cube contradict each other: choose one");
  }
  options.cube.check();
  if (!options.maps.depth.empty()) {
    run_over_map(options, command);
  } else if (!options.maps.reflectivity.empty() || options.map_scales.metres_per_unit ||
             options.map_scales.reflectivity_per_unit) {
    throw InputError("accuracy: --reflectivity-map, --depth-scale and --reflectivity-scale need --depth");
  } else if (!options.cube.file.empty()) {
    refuse_without_effect(command, "--reflectivity", "a transient cube has its own light");
    run_over_map(options, command);
  } else {
    run_accuracy_command(options);
  }
}

}  // namespace

void add_accuracy_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<AccuracyOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "accuracy", "Distance sweep: precision, bias, slope, outliers and efficiency of every read-out");
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(sensible_klux())
      ->capture_default_str();
  command
      ->add_option("-d,--distances", options->distances_m,
                   "distances in m; with --depth or --cube the edges of the bands (default: ten equal ones)")
      ->capture_default_str();
  command
      ->add_option("-n,--frames", options->frames,
                   "frames per distance (with --precision: at least), or of a map (default: 8)")
      ->check(CLI::Range(4, 10'000'000))
      ->capture_default_str();
  command
      ->add_option("--precision", options->precision_percent,
                   "more frames until the 95 % intervals of relative precision and rmse are within this many "
                   "per cent of their value")
      ->check(above_zero());
  command
      ->add_option("--rare-outliers", options->rare_outliers_percent,
                   "--precision does not wait for outliers rarer than this many per cent")
      ->check(CLI::Range(1e-4, 50.0))
      ->capture_default_str();
  command
      ->add_option("--calibration-seed", options->calibration_seed,
                   "calibration run of the look-up table; --seed does not change it")
      ->capture_default_str();
  command->add_option("--calibration-frames", options->calibration_frames, "frames per distance of this run")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--max-frames", options->most_frames, "where --precision gives up")
      ->check(CLI::Range(4, 10'000'000))
      ->capture_default_str();
  command
      ->add_option(
          "--reject", options->reject_percent,
          "reject measurements of low confidence, so that of the calibration's accepted ones at most "
          "this many per cent are more than 10 % off")
      ->check(CLI::Range(0.0, 100.0));
  command->add_option("--reflectivity", options->reflectivity, "the target's (default: the sensor's)")
      ->check(sensible_reflectivity());
  auto* map = command->add_option_group("map");
  map->add_option(
      "--depth", options->maps.depth,
      "instead of a sweep: errors by distance band over your own depth map (PNG of 8 or 16 bits,\n"
      "PFM or NPY), resampled to the sensor's pixels by nearest neighbour");
  map->add_option("--reflectivity-map", options->maps.reflectivity, "PNG, PFM or NPY of --depth");
  options->map_scales.add_to(*map);
  options->cube.add_to(*map);
  options->sensor.add_sensor_to(*command);
  options->readout.add_to(*command);
  add_run_options(*command, options->run);
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options, command] { run_command(*options, *command); });
}

}  // namespace dtof
