// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/table.hpp"
#include "random/check.hpp"
#include "random/draw.hpp"
#include "rtl/settings.hpp"

namespace {

struct Options {
  std::uint64_t seed = 1;
  std::uint32_t first = 0;
  std::uint32_t count = 30;
  std::string out = "build/random_configurations";
};

int run(int argc, char** argv) {
  CLI::App app{
      "dtof-random: arrays of legal parameters that are drawn, each built and compared with its model on "
      "frames of\n"
      "random streams. Writes table.md, and configurations.toml for synth/synth.py --configurations."};
  Options options;
  app.add_option("--seed", options.seed, "seed of everything random")->capture_default_str();
  app.add_option("--first", options.first, "number of the first array")->capture_default_str();
  app.add_option("--count", options.count, "arrays")->capture_default_str();
  app.add_option("--out", options.out, "folder to write to")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  dtof::install_interruption_handler();
  dtof::create_output_folder(options.out);
  dtof::Table table({"array", "parameters", "frames", "results", "clocks", "equal to the model"});
  std::string toml = "# SPDX-License-Identifier: Apache-2.0\n# Written by dtof-random.\n";
  std::string differences;
  std::uint32_t wrong = 0;
  for (std::uint32_t i = options.first; i < options.first + options.count; ++i) {
    const dtof::RtlConfiguration configuration = dtof::drawn_configuration(options.seed, i);
    const std::string reproduce =
        fmt::format("make random-configurations SEED={} FIRST={} N=1", options.seed, i);
    const dtof::ArrayCheck check = dtof::check_array(configuration, options.seed + i, reproduce);
    const bool equal = check.difference.empty();
    table.add({fmt::format("{}", i), configuration.to_string(), fmt::format("{}", check.frames),
               fmt::format("{}", check.results), fmt::format("{}", check.clocks), equal ? "yes" : "NO"});
    toml += "\n" + dtof::configuration_toml(fmt::format("drawn_{}", i), configuration);
    fmt::print(
        "{} {}: {}\n", i, configuration.to_string(),
        equal ? fmt::format("{} results of {} frames equal", check.results, check.frames) : check.difference);
    std::fflush(stdout);  // a log shows how far the program is
    differences += check.difference;
    wrong += equal ? 0 : 1;
  }
  const std::string verdict =
      fmt::format("{} arrays drawn with seed {}, from {} on: {} differ from the model.\n", options.count,
                  options.seed, options.first, wrong == 0 ? "none" : fmt::format("{}", wrong));
  const std::filesystem::path folder(options.out);
  dtof::write_file(folder / "table.md", fmt::format("{}\n{}{}{}", verdict, table.markdown(),
                                                    differences.empty() ? "" : "\n", differences));
  dtof::write_file(folder / "configurations.toml", toml);
  fmt::print("{}Table: {}/table.md\n", verdict, options.out);
  return wrong == 0 ? 0 : 1;
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
