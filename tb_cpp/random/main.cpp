// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "command_line/command_line.hpp"
#include "command_line/folder_result.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/table.hpp"
#include "random/check.hpp"
#include "random/draw.hpp"
#include "rtl/error.hpp"
#include "rtl/settings.hpp"

namespace {

struct Options {
  std::uint64_t seed = 1;
  std::uint32_t first = 0;
  std::uint32_t count = 30;
  std::string out = "build/random_configurations";
};

void run(const Options& options) {
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
    const dtof::RtlConfiguration netlist = dtof::netlist_configuration(configuration);
    toml += "\n" + dtof::configuration_toml(fmt::format("drawn_{}", i), netlist);
    if (netlist.signalled_clear != configuration.signalled_clear) {
      fmt::print("{}: its netlist has SIGNALLED_CLEAR = 0: a column would have more than {} status bits\n", i,
                 dtof::kMostStatusBits);
    }
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
  dtof::write_file(folder / "table.csv", table.csv());
  dtof::write_file(folder / "configurations.toml", toml);
  fmt::print("{}Table: {}/table.md\n", verdict, options.out);
  if (wrong != 0) {
    throw dtof::RtlError("arrays differ from their models: see the table");
  }
}

void add_options(CLI::App& app, const std::string& command_line) {
  const auto options = std::make_shared<Options>();
  app.add_option("--seed", options->seed, "seed of everything random")->capture_default_str();
  app.add_option("--first", options->first, "number of the first array")->capture_default_str();
  app.add_option("--count", options->count, "arrays")->capture_default_str();
  app.add_option("--out", options->out, "folder to write to")->capture_default_str();
  dtof::add_folder_results(app, command_line, [options] { run(*options); });
}

}  // namespace

int main(int argc, char** argv) {
  const dtof::Program program = {
      .name = "dtof-random",
      .description =
          "dtof-random: arrays of legal parameters that are drawn, each built and compared with its model on "
          "frames of\nrandom streams. Writes table.md, table.csv, and configurations.toml for synth/synth.py "
          "--configurations.",
      .examples = "An array that differs from its model ends the program with exit code 3.\n",
      .add_commands = add_options};
  return dtof::run_program(program, argc, argv);
}
