// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

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

#include "app/commands.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/plot.hpp"
#include "app/scene_study.hpp"
#include "app/table.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/random.hpp"
#include "io/atomic_file.hpp"
#include "io/colour_png.hpp"
#include "io/depth_image.hpp"
#include "scene/scene.hpp"

namespace dtof {
namespace {

struct ScenesOptions {
  std::vector<std::string> presets = {"thesis", "phone"};
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  std::string readouts =
      "ezpointer,hispointer1,hispointer,sifh,fifh,threesteps,pifh,histogram,poolpointer,poolpointer-lean";
  std::vector<std::string> scenes = {"flat", "room", "planes", "clutter", "poles", "isolated"};
  std::string disparity_file;
  double nearest_m = 1.0;
  int columns = 200;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string out = "build/scenes";
  std::string command_line;
};

constexpr std::array kFlatDistances = {0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0};
constexpr int kFlatColumns = 10;
constexpr int kArrayColumns = 200;
constexpr int kArrayRows = 160;

/// Surfaces have no reflectivity in a depth map: each block of 20 x 20 pixels gets its own.
void vary_reflectivity(TargetMap& targets, double reflectivity, std::uint64_t seed) {
  constexpr int kBlock = 20;
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      const auto block = static_cast<std::uint32_t>(column / kBlock + (row / kBlock << 8));
      CounterRandom random(seed, static_cast<std::uint32_t>(RandomPurpose::kScene), 0, block);
      targets.at(column, row).reflectivity = reflectivity * std::lerp(0.1, 0.9, random.uniform());
    }
  }
}

StudyScene disparity_scene(const ScenesOptions& options, double reflectivity) {
  DepthImage image = read_disparity_png(options.disparity_file, 1.0);
  float nearest = std::numeric_limits<float>::infinity();
  for (const float metres : image.metres) {
    nearest = metres > 0.0F ? std::min(nearest, metres) : nearest;
  }
  if (!std::isfinite(nearest)) {
    throw InputError(fmt::format("{}: no known disparity", options.disparity_file));
  }
  for (float& metres : image.metres) {
    metres *= static_cast<float>(options.nearest_m) / nearest;
  }
  TargetMap targets =
      scene_from_depth_image(image.width, image.height, image.metres, kArrayColumns, kArrayRows);
  vary_reflectivity(targets, reflectivity, options.seed);
  return {"disparity map", std::move(targets), std::min(options.columns, kArrayColumns)};
}

std::vector<StudyScene> make_scenes(const ScenesOptions& options, double reflectivity) {
  std::vector<StudyScene> scenes;
  for (const std::string& name : options.scenes) {
    const Scene scene = parse_scene(name);
    SceneParameters parameters;
    parameters.reflectivity = reflectivity;
    parameters.seed = options.seed;
    if (scene == Scene::kFlat) {
      parameters.columns = kFlatColumns;
      for (const double distance : kFlatDistances) {
        parameters.distance_m = distance;
        scenes.push_back({fmt::format("flat {:g} m", distance), make_scene(scene, parameters), kFlatColumns});
      }
    } else {
      scenes.push_back({name, make_scene(scene, parameters), std::min(options.columns, kArrayColumns)});
    }
  }
  if (!options.disparity_file.empty()) {
    scenes.push_back(disparity_scene(options, reflectivity));
  }
  return scenes;
}

struct SceneResult {
  std::string scene;
  std::vector<SceneScore> scores;  // of each estimator
};

/// Scenes down, estimators across.
Table matrix(const std::vector<SceneResult>& results, const std::vector<std::string>& estimators,
             const std::function<std::string(const SceneScore&)>& cell) {
  std::vector<std::string> header = {"scene"};
  header.insert(header.end(), estimators.begin(), estimators.end());
  Table table(std::move(header));
  for (const SceneResult& result : results) {
    std::vector<std::string> row = {result.scene};
    for (const SceneScore& score : result.scores) {
      row.push_back(cell(score));
    }
    table.add(std::move(row));
  }
  return table;
}

std::string share_pair(const ErrorShares& shares) {
  return shares.pixels == 0 ? "-"
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
      const SceneScore& score = result.scores[estimator];
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

std::string file_name(std::string text) {
  std::ranges::replace(text, ' ', '_');
  return text;
}

void run_scenes_command(const ScenesOptions& options) {
  ReadoutOptions readout_options;
  readout_options.readouts = options.readouts;
  const std::vector<ReadoutParameters> readouts = readout_options.parameters();
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  std::vector<std::string> header = {"preset",
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
                                     "rest_above_10_percent"};
  for (const double dropped : kDropped) {
    header.push_back(fmt::format("outliers_removed_at_{:g}_percent", dropped * 100.0));
  }
  Table csv(header);
  std::string report = fmt::format(
      "# Read-outs on scenes\n\nPer cent of pixels with a relative error above 3 % / above 10 %, after a "
      "look-up "
      "table fitted on flat targets. Seed {}, at most {} columns of a scene.\n\"hisPointer pairs\" takes its "
      "coarse "
      "peak over pairs of adjacent bins; the matched filter has the full histogram and knows signal and "
      "background.\n\nCommand: `{}`\n",
      options.seed, options.columns, options.command_line);
  for (const std::string& preset : options.presets) {
    const SensorModel sensor = parse_preset(preset);
    const std::vector<StudyScene> scenes = make_scenes(options, sensor.default_reflectivity);
    for (const double klux : options.klux) {
      Progress progress(fmt::format("{} {:g} klux", preset, klux), scenes.size() + 1);
      const SceneStudy study(sensor, klux, readouts, options.seed, options.threads);
      progress.advance();
      const std::vector<std::string>& estimators = study.estimators();
      std::vector<SceneResult> results;
      for (const StudyScene& scene : scenes) {
        const SceneTruth truth = scene_truth(scene);
        const std::vector<SceneMeasurement> measurements = study.measure(scene);
        SceneResult result{scene.name, {}};
        for (std::size_t e = 0; e < estimators.size(); ++e) {
          result.scores.push_back(score_scene(truth, measurements[e]));
          const SceneScore& score = result.scores.back();
          std::vector<std::string> row = {preset,
                                          fmt::format("{:g}", klux),
                                          scene.name,
                                          estimators[e],
                                          fmt::format("{}", score.all.pixels),
                                          fmt::format("{:.6f}", score.all.above_3_percent),
                                          fmt::format("{:.6f}", score.all.above_10_percent),
                                          fmt::format("{:.6f}", score.all.rmse),
                                          fmt::format("{}", score.edges.pixels),
                                          fmt::format("{:.6f}", score.edges.above_3_percent),
                                          fmt::format("{:.6f}", score.edges.above_10_percent),
                                          fmt::format("{:.6f}", score.rest.above_3_percent),
                                          fmt::format("{:.6f}", score.rest.above_10_percent)};
          for (const double removed : score.removed) {
            row.push_back(std::isnan(removed) ? "" : fmt::format("{:.4f}", removed));
          }
          csv.add(std::move(row));
        }
        if (!scene.name.starts_with("flat")) {
          const std::string title = fmt::format("{}, {:g} klux, preset {}: error", scene.name, klux, preset);
          write_error_maps(folder / fmt::format("{}_{:g}klux_{}.png", file_name(scene.name), klux, preset),
                           title, truth, estimators, measurements, options.command_line);
        }
        results.push_back(std::move(result));
        progress.advance();
      }
      const auto part = [&](const std::string& title,
                            const std::function<std::string(const SceneScore&)>& cell) {
        return fmt::format("\n### {}\n\n{}", title, matrix(results, estimators, cell).markdown());
      };
      const std::string overview =
          part("All pixels: above 3 % / 10 %", [](const SceneScore& s) { return share_pair(s.all); });
      fmt::print("\n## {:g} klux, preset {}\n{}", klux, preset, overview);
      report +=
          fmt::format("\n## {:g} klux, preset {}\n{}{}{}{}{}", klux, preset, overview,
                      part("Pixels at depth edges", [](const SceneScore& s) { return share_pair(s.edges); }),
                      part("Other pixels", [](const SceneScore& s) { return share_pair(s.rest); }),
                      part("Relative rmse, %",
                           [](const SceneScore& s) { return fmt::format("{:.2f}", s.all.rmse * 100.0); }),
                      part("Outliers (above 10 %) removed by dropping the 5 % of lowest confidence, %",
                           [](const SceneScore& s) {
                             return std::isnan(s.removed[2]) ? std::string("-")
                                                             : fmt::format("{:.0f}", s.removed[2] * 100.0);
                           }));
      std::vector<PlotSeries> curves;
      for (std::size_t e = 0; e < estimators.size(); ++e) {
        curves.push_back(confidence_curve(results, e, estimators[e]));
      }
      write_plot(folder / fmt::format("confidence_{:g}klux_{}.svg", klux, preset), curves,
                 {.title = fmt::format("Confidence, {:g} klux, preset {}, all scenes", klux, preset),
                  .x_label = "pixels dropped, %",
                  .y_label = "outliers removed, %"});
    }
  }
  write_file(folder / "scenes.csv", csv.csv());
  write_file(folder / "scenes.md", report);
  fmt::print("\nTables, error maps and confidence curves are in {}\n", options.out);
}

}  // namespace

void add_scenes_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ScenesOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "scenes", "Read-outs, their strongest cheap rival and the matched filter compared on scenes");
  command->add_option("-p,--preset", options->presets, "presets, one or more")->capture_default_str();
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("-r,--readout", options->readouts, "names from `dtof list`, separated by commas")
      ->take_last()
      ->capture_default_str();
  command->add_option("--scene", options->scenes, "scenes from `dtof list`, one or more")
      ->capture_default_str();
  command->add_option("--disparity", options->disparity_file,
                      "also a disparity map (8-bit PNG, 0 = unknown), its reflectivity varied in blocks");
  command->add_option("--nearest", options->nearest_m, "distance of the disparity map's nearest point, m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--columns", options->columns, "columns read of a scene, evenly spread")
      ->check(CLI::Range(1, kArrayColumns))
      ->capture_default_str();
  command->add_option("-s,--seed", options->seed, "seed of photons and random shapes")->capture_default_str();
  command->add_option("-j,--threads", options->threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options] { run_scenes_command(*options); });
}

}  // namespace dtof
