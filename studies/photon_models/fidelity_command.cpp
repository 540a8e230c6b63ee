// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "photon_models/fidelity_study.hpp"

namespace dtof {
namespace {

struct FidelityOptions {
  std::string sensor = "thesis";
  int frames = 4;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string out = "reports";
  std::string command_line;
};

void run_fidelity_command(const FidelityOptions& options) {
  FidelitySettings settings;
  settings.sensor = find_sensor(options.sensor);
  settings.frames = options.frames;
  settings.seed = options.seed;
  settings.threads = options.threads;
  for (const Readout readout : kThesisReadouts) {
    settings.readouts.push_back(readout);
  }
  for (const Scene scene : kAllScenes) {
    SceneParameters parameters;
    parameters.reflectivity = settings.sensor.default_reflectivity;
    parameters.distance_m = 3.0;
    settings.scenes.emplace_back(scene_name(scene), make_scene(scene, parameters));
  }
  create_output_folder(options.out);
  const FidelityStudy study = run_fidelity_study(settings);
  const std::filesystem::path folder(options.out);
  const PageData page = fidelity_page(study, settings, options.command_line);
  write_file(folder / "fidelity.csv", fidelity_csv(study));
  write_page(folder, "fidelity", "fidelity", page);
  fmt::print("{}\nWritten to {}\n", page_text("fidelity", page), (folder / "fidelity.md").string());
}

}  // namespace

void add_fidelity_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<FidelityOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "fidelity", "What the fast photon model changes of a scene's figures, and what --fidelity auto takes");
  add_sensor_option(*command, options->sensor);
  command->add_option("--frames", options->frames, "frames of each scene and light")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_study_options(*command, options->seed, options->threads, options->out);
  command->callback([options] { run_fidelity_command(*options); });
}

}  // namespace dtof
