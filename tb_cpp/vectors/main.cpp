// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "vectors/rtl_parameters.hpp"
#include "vectors/stimulus.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app{
      "dtof-vectors: frames for an RTL test bench, random or of a scene, and the results that the model "
      "expects."};
  std::string readout;
  std::string folder;
  std::uint64_t seed = 1;
  std::vector<std::uint32_t> frames;
  std::vector<std::string> settings;
  std::string scene;
  double klux = 14.0;
  app.add_option("--readout", readout, "read-out, as `dtof list` names it")->required();
  app.add_option("--out", folder, "folder to write to")->required();
  app.add_option("--seed", seed, "seed of the random frames");
  app.add_option("--acquisitions", frames, "acquisitions of each frame")->required();
  app.add_option("--parameters", settings, "RTL parameters of the top, NAME=value")->required();
  CLI::Option* scene_option =
      app.add_option("--scene", scene, "photons of this scene instead of random streams");
  app.add_option("--klux", klux, "background light of the scene")->needs(scene_option);
  CLI11_PARSE(app, argc, argv);
  const dtof::ArrayParameters array = dtof::parse_rtl_parameters(dtof::parse_readout(readout), settings);
  if (scene.empty()) {
    dtof::write_vectors(array, frames, seed, folder);
  } else {
    dtof::write_scene_vectors(array, dtof::parse_scene(scene), klux, frames, seed, folder);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
}
