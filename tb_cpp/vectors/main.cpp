// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "command_line/command_line.hpp"
#include "command_line/folder_result.hpp"
#include "vectors/rtl_parameters.hpp"
#include "vectors/stimulus.hpp"

namespace {

struct Options {
  std::string readout;
  std::string folder;
  std::uint64_t seed = 1;
  std::vector<std::uint32_t> frames;
  std::vector<std::string> settings;
  std::string scene;
  double klux = 14.0;
};

void run(const Options& options) {
  const dtof::ArrayParameters array =
      dtof::parse_rtl_parameters(dtof::parse_readout(options.readout), options.settings);
  if (options.scene.empty()) {
    dtof::write_vectors(array, options.frames, options.seed, options.folder);
  } else {
    dtof::write_scene_vectors(array, dtof::parse_scene(options.scene), options.klux, options.frames,
                              options.seed, options.folder);
  }
}

void add_options(CLI::App& app, const std::string& command_line) {
  const auto options = std::make_shared<Options>();
  app.add_option("--readout", options->readout, "read-out, as `dtof list` names it")->required();
  app.add_option("--out", options->folder, "folder to write to")->required();
  app.add_option("--seed", options->seed, "seed of everything random")->capture_default_str();
  app.add_option("--acquisitions", options->frames, "acquisitions of each frame")->required();
  app.add_option("--parameters", options->settings, "RTL parameters of the top, NAME=value")->required();
  CLI::Option* scene =
      app.add_option("--scene", options->scene, "photons of this scene instead of random streams");
  app.add_option("--klux", options->klux, "background light of the scene")
      ->capture_default_str()
      ->needs(scene);
  dtof::add_folder_results(app, command_line, [options] { run(*options); });
}

}  // namespace

int main(int argc, char** argv) {
  const dtof::Program program = {
      .name = "dtof-vectors",
      .description =
          "dtof-vectors: frames for an RTL test bench, random or of a scene, and the results that the model "
          "expects.\nWrites frames.txt, timestamps.hex and results.hex (docs/reference/formats.md).",
      .examples =
          "Example:\n  dtof-vectors --readout sifh --acquisitions 20 30 --parameters PIXELS_PER_SRAM=4 "
          "SRAM_NUM=2 --out build/vectors\n",
      .add_commands = add_options};
  return dtof::run_program(program, argc, argv);
}
