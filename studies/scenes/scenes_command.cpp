// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/own_map.hpp"
#include "command_line/shell_words.hpp"
#include "common/commands.hpp"
#include "common/readout_variant.hpp"
#include "common/scene_list.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/random.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/report/colour_png.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "scenes/scene_study.hpp"
#include "scenes/scenes_report.hpp"

namespace dtof {
namespace {

struct ScenesOptions : SceneChoice {
  std::vector<std::string> sensors = {"thesis", "phone"};
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  std::string readouts =
      "ezpointer,hispointer1,hispointer,sifh,fifh,threesteps,pifh,histogram,coarsehistogram,poolpointer,"
      "poolpointer-lean";
  std::vector<std::string> variants;
  std::string table = "flat";
  int threads = 0;
  std::string out = "build/scenes";
  std::string command_line;
};

void write_error_maps(const std::filesystem::path& path, const std::string& title, const SceneTruth& truth,
                      const std::vector<std::string>& estimators,
                      const std::vector<SceneMeasurement>& measurements, const std::string& caption) {
  std::vector<MapPanel> panels;
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    DepthImage error{truth.columns, truth.rows, {}};
    for (std::size_t i = 0; i < truth.distance_m.size(); ++i) {
      error.metres.push_back(truth.distance_m[i] > 0.0
                                 ? static_cast<float>(measurements[e].distance_m[i] - truth.distance_m[i])
                                 : std::numeric_limits<float>::quiet_NaN());
    }
    panels.push_back({std::move(error), estimators[e], MapKind::kError});
  }
  write_map_picture(path, panels,
                    {.title = title,
                     .caption = caption,
                     .panels_per_row = 4,
                     .pixel_size = truth.columns >= 100 ? 1 : 0,
                     .largest_error = 0.25});
}

/// Share of all outliers of the scenes that dropping pixels removes, weighted by outliers.
PlotSeries confidence_curve(const std::vector<SceneResult>& results, std::size_t estimator,
                            const std::string& label) {
  PlotSeries series{label, {0.0}, {0.0}};
  for (std::size_t d = 0; d < std::size(kDropped); ++d) {
    double removed = 0.0;
    double outliers = 0.0;
    for (const SceneResult& result : results) {
      const SceneScore& score = result.estimators[estimator].score;
      const double here = score.all.above_10_percent * static_cast<double>(score.all.pixels);
      if (here > 0.0) {
        removed += score.removed[d] * here;
        outliers += here;
      }
    }
    series.x.push_back(kDropped[d] * 100.0);
    series.y.push_back(outliers > 0.0 ? removed / outliers * 100.0 : std::nan(""));
  }
  return series;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : values) {
    if (value > 0.0 && std::isfinite(value)) {
      sum += value * value;
      ++count;
    }
  }
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

std::string file_name(std::string text) {
  std::ranges::replace(text, ' ', '_');
  return text;
}

/// The read-outs asked for, and variants such as "hispointer:COUNT_WIDTH=8".
std::vector<ReadoutParameters> parse_readouts(const ScenesOptions& options, const SensorModel& sensor) {
  ReadoutOptions plain;
  plain.readouts = options.readouts;
  std::vector<ReadoutParameters> readouts = plain.parameters(kAllReadouts, sensor);
  for (const std::string& text : options.variants) {
    readouts.push_back(parse_variant(text, sensor));
  }
  return readouts;
}

std::vector<std::string> csv_header() {
  std::vector<std::string> header = {"sensor",
                                     "klux",
                                     "scene",
                                     "estimator",
                                     "pixels",
                                     "above_3_percent",
                                     "above_10_percent",
                                     "relative_rmse",
                                     "edge_pixels",
                                     "edge_above_3_percent",
                                     "edge_above_10_percent",
                                     "rest_above_3_percent",
                                     "rest_above_10_percent",
                                     "single_pixels",
                                     "single_above_10_percent",
                                     "relative_bound",
                                     "median_error_over_bound"};
  for (const double dropped : kDropped) {
    header.push_back(fmt::format("outliers_removed_at_{:g}_percent", dropped * 100.0));
  }
  return header;
}

/// Row of the CSV file. `bounds`: Cramer-Rao bounds of the scene's pixels, or empty.
std::vector<std::string> csv_row(const std::string& sensor, double klux, const std::string& scene,
                                 const std::string& estimator, const EstimatorResult& measured,
                                 const std::vector<double>& bounds) {
  const SceneScore& score = measured.score;
  std::vector<std::string> row = {sensor,
                                  fmt::format("{:g}", klux),
                                  scene,
                                  estimator,
                                  fmt::format("{}", score.all.pixels),
                                  fmt::format("{:.6f}", score.all.above_3_percent),
                                  fmt::format("{:.6f}", score.all.above_10_percent),
                                  fmt::format("{:.6f}", score.all.rmse),
                                  fmt::format("{}", score.edges.pixels),
                                  fmt::format("{:.6f}", score.edges.above_3_percent),
                                  fmt::format("{:.6f}", score.edges.above_10_percent),
                                  fmt::format("{:.6f}", score.rest.above_3_percent),
                                  fmt::format("{:.6f}", score.rest.above_10_percent),
                                  fmt::format("{}", score.singles.pixels),
                                  fmt::format("{:.6f}", score.singles.above_10_percent),
                                  bounds.empty() ? "" : fmt::format("{:.6f}", root_mean_square(bounds)),
                                  bounds.empty() ? "" : fmt::format("{:.4f}", measured.error_over_bound)};
  for (const double removed : score.removed) {
    row.push_back(std::isnan(removed) ? "" : fmt::format("{:.4f}", removed));
  }
  return row;
}

/// What all lights of a run share.
struct ScenesRun {
  const ScenesOptions& options;
  TableRule rule;
  std::filesystem::path folder;
  Table csv;
  ScenesResults results;
};

/// Measures all scenes at one light: error maps, rows of the CSV file, and the results by scene.
std::vector<SceneResult> measure_scenes(ScenesRun& run, const SceneStudy& study, const SensorModel& sensor,
                                        double klux, const std::vector<StudyScene>& scenes,
                                        Progress& progress) {
  const std::vector<std::string>& estimators = study.estimators();
  std::vector<SceneResult> results;
  for (const StudyScene& scene : scenes) {
    const SceneTruth truth = scene_truth(scene);
    const std::vector<SceneMeasurement> measurements = study.measure(scene);
    const std::vector<double> bounds =
        shows_pooled_gain(scene.name) ? study.relative_bounds(scene) : std::vector<double>();
    SceneResult result{scene.name, {}};
    for (std::size_t e = 0; e < estimators.size(); ++e) {
      result.estimators.push_back(
          {score_scene(truth, measurements[e]), median_error_over_bound(truth, bounds, measurements[e])});
      run.csv.add(csv_row(sensor.name, klux, scene.name, estimators[e], result.estimators.back(), bounds));
    }
    if (!is_flat(scene.name)) {
      write_error_maps(
          run.folder / fmt::format("{}_{:g}klux_{}.png", file_name(scene.name), klux, sensor.name),
          fmt::format("Error in m: {}, {:g} klux, sensor {}", scene.name, klux, sensor.name), truth,
          estimators, measurements, without_threads(run.options.command_line));
    }
    results.push_back(std::move(result));
    progress.advance();
  }
  return results;
}

void write_confidence_curves(const std::filesystem::path& path, const std::vector<SceneResult>& results,
                             const std::vector<std::string>& estimators, const std::string& sensor,
                             double klux) {
  std::vector<PlotSeries> curves;
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    curves.push_back(confidence_curve(results, e, estimators[e]));
  }
  write_plot(path, curves,
             {.title = fmt::format("Outliers removed in % by dropping the pixels of lowest confidence: "
                                   "all scenes, {:g} klux, sensor {}",
                                   klux, sensor),
              .x_label = "pixels dropped, %",
              .y_label = "outliers removed, %"});
}

/// A sensor of the run, with its read-outs and scenes.
struct SensorScenes {
  SensorModel sensor;
  std::vector<ReadoutParameters> readouts;
  SceneList list;
};

void run_light(ScenesRun& run, const SensorScenes& of, double klux) {
  const std::vector<StudyScene>& scenes = of.list.scenes;
  Progress progress(fmt::format("{} {:g} klux", of.sensor.name, klux), scenes.size() + 1);
  const SceneStudy study(of.sensor, klux, of.readouts, run.options.seed, run.options.threads, run.rule);
  progress.advance();
  run.results.lights.push_back({klux, of.sensor.name, table_sentence(run.rule, of.sensor, run.options.seed),
                                study.estimators(),
                                measure_scenes(run, study, of.sensor, klux, scenes, progress)});
  const LightResults& light = run.results.lights.back();
  fmt::print("\n## {:g} klux, sensor {}\n\n### All pixels: above 3 % / 10 %\n\n{}", klux, of.sensor.name,
             all_pixels_table(light).markdown());
  write_confidence_curves(run.folder / fmt::format("confidence_{:g}klux_{}.svg", klux, of.sensor.name),
                          light.scenes, light.estimators, of.sensor.name, klux);
}

void run_scenes_command(const ScenesOptions& options) {
  ScenesRun run{.options = options,
                .rule = parse_table_rule(options.table),
                .folder = options.out,
                .csv = Table(csv_header()),
                .results = {}};
  std::vector<SensorScenes> sensors;
  for (const std::string& name : options.sensors) {
    SensorModel sensor = find_sensor(name);
    std::vector<ReadoutParameters> readouts = parse_readouts(options, sensor);
    SceneList list = make_scenes(options, sensor);
    sensors.push_back({std::move(sensor), std::move(readouts), std::move(list)});
  }
  create_output_folder(run.folder);
  run.results = {.seed = options.seed,
                 .columns = options.columns,
                 .notes = sensors.front().list.notes,
                 .lights = {},
                 .command_line = options.command_line};
  for (const std::string& note : run.results.notes) {
    fmt::print("{}\n", note);
  }
  for (const SensorScenes& sensor : sensors) {
    for (const double klux : options.klux) {
      run_light(run, sensor, klux);
    }
  }
  write_file(run.folder / "scenes.csv", run.csv.csv());
  write_page(run.folder, "scenes", "scenes", scenes_page(run.results));
  fmt::print("\nSeed {}. Tables, error maps and confidence curves are in {}\n", options.seed, options.out);
}

}  // namespace

void add_scenes_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ScenesOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "scenes", "Read-outs, their strongest cheap rival and the matched filter compared on scenes");
  command
      ->add_option("--sensor,-p,--preset", options->sensors,
                   "presets of `dtof list` or sensor files (docs/user/sensor_file.md), one or more")
      ->capture_default_str();
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("-r,--readout", options->readouts, "names from `dtof list`, separated by commas")
      ->capture_default_str();
  command->add_option("--variant", options->variants,
                      "also READOUT:PARAMETER=NUMBER,...\nparameters: " + variant_parameters_help());
  add_scene_options(*command, *options);
  command
      ->add_option("--table", options->table,
                   "host look-up table: flat (each read-out's own, fitted on flat targets of the sensor's\n"
                   "reflectivity from other photons) or none (Eq. 3.11 alone)")
      ->check(CLI::IsMember({"none", "flat"}))
      ->capture_default_str();
  command->add_option("--columns", options->columns, "columns read of a scene, evenly spread")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("-s,--seed", options->seed, "seed of photons and random shapes")->capture_default_str();
  command->add_option("-j,--threads", options->threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options, command] {
    check_scene_options(*command, *options);
    run_scenes_command(*options);
  });
}

}  // namespace dtof
