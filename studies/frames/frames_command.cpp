// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/sensor/preset.hpp"
#include "frames/standard_frames.hpp"

namespace dtof {
namespace {

struct FramesOptions {
  StandardFramesSettings settings;
  std::vector<std::string> sensors = {"thesis", "thesis_1mhz", "thesis_full"};
  std::string readouts = "all";
  std::string scene = "room";
  std::string rtl;  // the read-out that RTL reads, too
  std::string out = "build/frames";
  std::string command_line;
};

void run_frames_command(FramesOptions options) {
  StandardFramesSettings& settings = options.settings;
  for (const std::string& sensor : options.sensors) {
    settings.sensors.push_back(find_sensor(sensor));
  }
  ReadoutOptions readouts;
  readouts.readouts = options.readouts;
  for (const ReadoutParameters& parameters : readouts.parameters(kAllReadouts)) {
    settings.readouts.push_back(parameters.readout);
  }
  settings.scene = parse_scene(options.scene);
  std::vector<CheckedFrame> checked;
  if (!options.rtl.empty()) {
    checked = check_standard_frames(settings, parse_readout(options.rtl));
  }
  const std::vector<StandardFrame> frames = run_standard_frames(settings);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  const PageData page = standard_frames_page(settings, frames, checked, options.command_line);
  write_file(folder / "frames.csv", standard_frames_csv(frames).csv());
  write_page(folder, "frames", "frames", page);
  fmt::print("{}\nThe report is {}\n", page_text("frames", page), (folder / "frames.md").string());
}

}  // namespace

void add_frames_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<FramesOptions>();
  options->command_line = command_line;
  StandardFramesSettings& settings = options->settings;
  CLI::App* command = app.add_subcommand(
      "frames", "One scene through every read-out, with several sensors beside each other");
  command->add_option("--sensors", options->sensors, "presets (dtof list) or sensor files, one or more")
      ->capture_default_str();
  command->add_option("-r,--readout", options->readouts, "read-outs separated by commas, or all")
      ->capture_default_str();
  command->add_option("--scene", options->scene, "scene from `dtof list`")->capture_default_str();
  command->add_option("-k,--klux", settings.klux, "background light in klux")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("-n,--frames", settings.frames, "frames with photons of their own, for the intervals")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("--rtl", options->rtl,
                      "also reads the first engine of this read-out in RTL with every sensor; a pixel that\n"
                      "differs from the model is an error");
  add_study_options(*command, settings.seed, settings.threads, options->out);
  command->callback([options] { run_frames_command(*options); });
}

}  // namespace dtof
