// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/own_map.hpp"
#include "command_line/shell_words.hpp"
#include "common/commands.hpp"
#include "common/scene_list.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/colour_png.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "small_arrays/enlarge_study.hpp"
#include "small_arrays/models/learned_enlarger.hpp"

namespace dtof {
namespace {

struct EnlargeOptions : SceneChoice {
  std::string sensor = "thesis";
  std::vector<double> klux = {14.0, 50.0};
  std::vector<std::string> arrays = {"100x80", "80x64", "50x40"};
  std::vector<std::string> readouts = {"hispointer", "histogram32", "poolpointer"};
  std::string weights;
  std::string pictured_scene;
  std::string pictured_array = "100x80";
  int seeds = 4;
  int threads = 0;
  std::string out = "build/enlarge";
  std::string command_line;
};

constexpr std::size_t kLongestWeights = 16'000'000;

std::vector<EnlargeScene> all_scenes(const EnlargeOptions& options, const SensorModel& sensor) {
  std::vector<EnlargeScene> scenes;
  for (StudyScene& scene : make_scenes(options, sensor).scenes) {
    scenes.push_back({scene.name, std::move(scene.targets), std::move(scene.guessed)});
  }
  if (scenes.empty()) {
    throw InputError("enlarge: no map is named");
  }
  return scenes;
}

/// Truth, large array and each enlarger's map; below them what each is off.
void write_picture(const std::filesystem::path& file, const std::vector<LabelledMap>& maps,
                   const SensorModel& sensor, const std::string& title, const std::string& caption) {
  constexpr double kLargestError = 0.3;
  const auto image_of = [&](const std::vector<double>& values) {
    return DepthImage{sensor.columns, sensor.rows, {values.begin(), values.end()}};
  };
  std::vector<MapPanel> panels;
  panels.reserve(2 * maps.size());
  for (const LabelledMap& map : maps) {
    panels.push_back({image_of(map.distance_m), map.label, MapKind::kDepth});
  }
  const std::vector<double>& truth = maps.front().distance_m;
  for (const LabelledMap& map : maps) {
    std::vector<double> error;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      error.push_back(truth[i] > 0.0 ? map.distance_m[i] - truth[i] : std::nan(""));
    }
    panels.push_back({image_of(error), map.label + ", error", MapKind::kError});
  }
  write_map_picture(file, panels,
                    {.title = title,
                     .caption = caption,
                     .panels_per_row = static_cast<int>(maps.size()),
                     .pixel_size = 2,
                     .depth_range = depth_range(std::span(panels).first(1)),
                     .largest_error = kLargestError});
}

/// Settings of the study but the light and the pictured map. Throws InputError for arrays or read-outs that
/// the picture lacks.
EnlargeSettings checked_settings(const EnlargeOptions& options, const SensorModel& sensor) {
  EnlargeSettings settings;
  settings.sensor = sensor;
  settings.readouts = options.readouts;
  settings.seed = options.seed;
  settings.seeds = options.seeds;
  settings.threads = options.threads;
  settings.weights =
      options.weights.empty()
          ? trained_weights()
          : parse_enlarger_weights(without_byte_order_mark(read_file(options.weights, kLongestWeights)),
                                   options.weights);
  for (const std::string& text : options.arrays) {
    settings.arrays.push_back(parse_array_size(text));
  }
  check_enlarge_settings(settings);
  settings.pictured_array = parse_array_size(options.pictured_array);
  if (std::ranges::find(settings.arrays, settings.pictured_array) == settings.arrays.end() ||
      std::ranges::find(settings.readouts, settings.large_readout) == settings.readouts.end()) {
    throw InputError(
        "--picture-array: the picture needs this array among --array and poolpointer among --readout");
  }
  return settings;
}

/// Name of the map that is drawn. Throws InputError for an unknown one.
std::string pictured_scene(const EnlargeOptions& options, const std::vector<EnlargeScene>& scenes) {
  std::string name = options.pictured_scene.empty() ? scenes.back().name : options.pictured_scene;
  if (std::ranges::find(scenes, name, &EnlargeScene::name) == scenes.end()) {
    throw InputError(fmt::format("--picture-scene: no map has the name '{}'", name));
  }
  return name;
}

PageData enlarge_page(const EnlargeOptions& options, const SensorModel& sensor,
                      const std::vector<EnlargeScene>& scenes, std::span<const EnlargeLight> lights,
                      const std::string& picture_title, const std::string& picture) {
  std::vector<std::string> names;
  names.reserve(scenes.size());
  for (const EnlargeScene& scene : scenes) {
    names.push_back(scene.name);
  }
  PageData data;
  add_enlarge_results(lights, data);
  data.set("columns", "{}", sensor.columns)
      .set("rows", "{}", sensor.rows)
      .set("sensor", "{}", options.sensor)
      .set("first_seed", "{}", options.seed)
      .set("last_seed", "{}", options.seed + static_cast<std::uint64_t>(options.seeds) - 1)
      .set("no_error", "{}", kNoError)
      .set("maps", "{}", fmt::join(names, ", "))
      .set("nearest_m", "{:g}", options.nearest_m)
      .set("darkest", "{:g}", kDarkestPhotographed)
      .set("picture_title", "{}", picture_title)
      .set("picture", "{}", picture)
      .set("command", "{}", options.command_line);
  return data;
}

void run_enlarge_command(EnlargeOptions options) {
  const SensorModel sensor = find_sensor(options.sensor);
  options.columns = sensor.columns;
  EnlargeSettings settings = checked_settings(options, sensor);
  const std::vector<EnlargeScene> scenes = all_scenes(options, sensor);
  settings.pictured_scene = pictured_scene(options, scenes);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);

  std::vector<EnlargeLight> lights;
  for (const double klux : options.klux) {
    settings.klux = klux;
    lights.push_back({klux, run_enlarge_study(settings, scenes)});
  }
  const std::string picture = fmt::format("enlarge_{:g}klux.png", lights.back().klux);
  const std::string title =
      fmt::format("{}, {:g} klux, sensor {}, poolPointer: large array, and a small one enlarged",
                  settings.pictured_scene, lights.back().klux, options.sensor);
  write_picture(folder / picture, lights.back().study.maps, sensor, title,
                without_threads(options.command_line));
  write_file(folder / "enlarge.csv", enlarge_csv(lights));
  write_page(folder, "enlarge", "enlarge", enlarge_page(options, sensor, scenes, lights, title, picture));
  fmt::print("The report is {}\n", (folder / "enlarge.md").string());
}

}  // namespace

void add_enlarge_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<EnlargeOptions>();
  options->command_line = command_line;
  options->scenes = {"room", "staircase", "planes", "clutter", "poles"};
  CLI::App* command = app.add_subcommand(
      "enlarge", "Small arrays that share the laser, enlarged to the large array's size, beside it");
  command->add_option("--sensor,-p,--preset", options->sensor, "a preset of `dtof list` or a sensor file")
      ->capture_default_str();
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more; the last is drawn")
      ->check(sensible_klux())
      ->capture_default_str();
  add_scene_options(*command, *options);
  command->add_option("--array", options->arrays, "small arrays, COLUMNSxROWS, one or more")
      ->capture_default_str();
  command->add_option("-r,--readout", options->readouts, "read-outs of the small arrays, and rivals")
      ->capture_default_str();
  command->add_option(
      "--weights", options->weights,
      "weights of the enlargers, as `make train-enlarger` writes them (default: those of the\n"
      "project)");
  command->add_option("--picture-scene", options->pictured_scene,
                      "map that is drawn (default: the last one)");
  command->add_option("--picture-array", options->pictured_array, "small array that is drawn")
      ->capture_default_str();
  command->add_option("-s,--seed", options->seed, "first seed of photons, and of random shapes")
      ->capture_default_str();
  command->add_option("--seeds", options->seeds, "seeds, from the first one up")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("-j,--threads", options->threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options, command] {
    check_scene_options(*command, *options);
    run_enlarge_command(*options);
  });
}

}  // namespace dtof
