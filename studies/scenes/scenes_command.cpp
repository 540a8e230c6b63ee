// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/own_map.hpp"
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

struct EstimatorResult {
  SceneScore score;
  double error_over_bound;
};

struct SceneResult {
  std::string scene;
  std::vector<EstimatorResult> estimators;
};

constexpr const char* kNoFigure = "-";

/// Scenes down, estimators across; scenes without a figure are left out.
Table matrix(const std::vector<SceneResult>& results, const std::vector<std::string>& estimators,
             const std::function<std::string(const EstimatorResult&)>& cell) {
  std::vector<std::string> header = {"scene"};
  header.insert(header.end(), estimators.begin(), estimators.end());
  Table table(std::move(header));
  for (const SceneResult& result : results) {
    std::vector<std::string> row = {result.scene};
    for (const EstimatorResult& estimator : result.estimators) {
      row.push_back(cell(estimator));
    }
    if (std::any_of(row.begin() + 1, row.end(), [](const std::string& text) { return text != kNoFigure; })) {
      table.add(std::move(row));
    }
  }
  return table;
}

std::string share_pair(const ErrorShares& shares) {
  return shares.pixels == 0 ? kNoFigure
                            : fmt::format("{:.2f} / {:.2f}", shares.above_3_percent * 100.0,
                                          shares.above_10_percent * 100.0);
}

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

bool shows_pooled_gain(const std::string& scene) {
  return is_flat(scene) || scene == "planes" || scene == "held planes";
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

/// hisPointer beside poolPointer on flats and on slanted planes: a pool of pixels must not need a flat
/// wall.
std::string gain_by_pooling(const std::vector<SceneResult>& results,
                            const std::vector<std::string>& estimators) {
  const auto alone = std::ranges::find(estimators, readout_title(Readout::kHisPointer)) - estimators.begin();
  const auto pooled =
      std::ranges::find(estimators, readout_title(Readout::kPoolPointer)) - estimators.begin();
  const auto count = static_cast<std::ptrdiff_t>(estimators.size());
  if (alone == count || pooled == count) {
    return "";
  }
  Table table({"scene", "above 3 %, hisPointer / poolPointer", "above 10 %", "rmse",
               "median error over bound: hisPointer", "poolPointer"});
  const auto ratio = [](double a, double b, double least) {
    return b > 0.0 ? fmt::format("{:.1f}", a / b) : a > 0.0 ? fmt::format(">{:.0f}", a / least) : kNoFigure;
  };
  for (const SceneResult& result : results) {
    if (!shows_pooled_gain(result.scene)) {
      continue;
    }
    const EstimatorResult& a = result.estimators[static_cast<std::size_t>(alone)];
    const EstimatorResult& b = result.estimators[static_cast<std::size_t>(pooled)];
    const double one_pixel = 1.0 / static_cast<double>(std::max<std::uint64_t>(1, a.score.all.pixels));
    table.add({result.scene, ratio(a.score.all.above_3_percent, b.score.all.above_3_percent, one_pixel),
               ratio(a.score.all.above_10_percent, b.score.all.above_10_percent, one_pixel),
               ratio(a.score.all.rmse, b.score.all.rmse, one_pixel),
               fmt::format("{:.2f}", a.error_over_bound), fmt::format("{:.2f}", b.error_over_bound)});
  }
  return fmt::format("\n### Gain by pooling, flats and slanted planes\n\n{}", table.markdown());
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
  std::string report;
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
          estimators, measurements, run.options.command_line);
    }
    results.push_back(std::move(result));
    progress.advance();
  }
  return results;
}

/// The sections of one light. Prints the first table.
std::string light_sections(const ScenesRun& run, const std::vector<SceneResult>& results,
                           const std::vector<std::string>& estimators, const SensorModel& sensor,
                           double klux) {
  const auto part = [&](const std::string& title,
                        const std::function<std::string(const EstimatorResult&)>& cell) {
    return fmt::format("\n### {}\n\n{}", title, matrix(results, estimators, cell).markdown());
  };
  const std::string overview =
      part("All pixels: above 3 % / 10 %", [](const EstimatorResult& r) { return share_pair(r.score.all); });
  fmt::print("\n## {:g} klux, sensor {}\n{}", klux, sensor.name, overview);
  std::string report = fmt::format("\n## {:g} klux, sensor {}\n\n{}\n{}", klux, sensor.name,
                                   table_sentence(run.rule, sensor, run.options.seed), overview);
  report += part("Pixels at depth edges", [](const EstimatorResult& r) { return share_pair(r.score.edges); });
  report += part("Other pixels", [](const EstimatorResult& r) { return share_pair(r.score.rest); });
  report += part("Pixels unlike all their neighbours: above 10 %", [](const EstimatorResult& r) {
    return r.score.singles.pixels == 0 ? kNoFigure
                                       : fmt::format("{:.2f}", r.score.singles.above_10_percent * 100.0);
  });
  report += part("Relative rmse, %",
                 [](const EstimatorResult& r) { return fmt::format("{:.2f}", r.score.all.rmse * 100.0); });
  report += part("Median error over the single pixel's bound", [](const EstimatorResult& r) {
    return std::isnan(r.error_over_bound) ? kNoFigure : fmt::format("{:.2f}", r.error_over_bound);
  });
  report += part("Outliers (above 10 %) removed by dropping the 5 % of lowest confidence, %",
                 [](const EstimatorResult& r) {
                   return std::isnan(r.score.removed[2]) ? kNoFigure
                                                         : fmt::format("{:.0f}", r.score.removed[2] * 100.0);
                 });
  return report + gain_by_pooling(results, estimators);
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
  const std::vector<SceneResult> results = measure_scenes(run, study, of.sensor, klux, scenes, progress);
  run.report += light_sections(run, results, study.estimators(), of.sensor, klux);
  write_confidence_curves(run.folder / fmt::format("confidence_{:g}klux_{}.svg", klux, of.sensor.name),
                          results, study.estimators(), of.sensor.name, klux);
}

void run_scenes_command(const ScenesOptions& options) {
  ScenesRun run{.options = options,
                .rule = parse_table_rule(options.table),
                .folder = options.out,
                .csv = Table(csv_header()),
                .report = {}};
  std::vector<SensorScenes> sensors;
  for (const std::string& name : options.sensors) {
    SensorModel sensor = find_sensor(name);
    std::vector<ReadoutParameters> readouts = parse_readouts(options, sensor);
    SceneList list = make_scenes(options, sensor);
    sensors.push_back({std::move(sensor), std::move(readouts), std::move(list)});
  }
  create_output_folder(run.folder);
  run.report = fmt::format(
      "# Read-outs on scenes\n\nPer cent of pixels with a relative error above 3 % / above 10 %. Seed "
      "{}, at most {} columns of a scene. \"hisPointer pairs\" finds its coarse peak over pairs of "
      "adjacent bins. The matched filter uses the full histogram and the true signal and background. "
      "Edges: pixels with a neighbour that differs by more than 10 %. Bound: Cramer-Rao bound of a "
      "single pixel; the table has the median of |error| / bound, divided by its value for a normal "
      "variable (0.674). Scenes \"held\": no parameter of poolPointer was chosen on them.\n\nCommand: "
      "`{}`\n",
      options.seed, options.columns, options.command_line);
  for (const std::string& note : sensors.front().list.notes) {
    run.report += fmt::format("\n{}\n", note);
    fmt::print("{}\n", note);
  }
  for (const SensorScenes& sensor : sensors) {
    for (const double klux : options.klux) {
      run_light(run, sensor, klux);
    }
  }
  write_file(run.folder / "scenes.csv", run.csv.csv());
  write_file(run.folder / "scenes.md", run.report);
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
      ->take_last()
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
