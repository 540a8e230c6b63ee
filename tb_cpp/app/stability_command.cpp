// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analytic/stability.hpp"
#include "app/commands.hpp"
#include "app/output_folder.hpp"
#include "app/table.hpp"
#include "io/atomic_file.hpp"

namespace dtof {
namespace {

struct StabilityOptions {
  std::uint64_t seed = 1;
  std::string out = "reports";
  std::string command_line;
};

void run_stability_command(const StabilityOptions& options) {
  const std::vector<StabilityResult> results = check_stability(options.seed);
  Table table({"what", "cases", "largest error", "accepted", "unit", "inputs", "reference"});
  for (const StabilityResult& result : results) {
    table.add({result.what + (result.passed() ? "" : " **FAILED**"), fmt::format("{}", result.cases),
               fmt::format("{:.2g}", result.error), fmt::format("{:.2g}", result.limit), result.unit,
               result.inputs, result.reference});
  }
  create_output_folder(options.out);
  const std::filesystem::path folder(options.out);
  write_file(folder / "stability.md",
             fmt::format("# Numerical stability\n\nLargest error over extreme inputs against 50-digit "
                         "arithmetic (Boost.Multiprecision), closed forms or exact integers. A NaN counts as "
                         "an infinite error. Command: `{}`, seed {}.\n\n{}",
                         options.command_line, options.seed, table.markdown()));
  fmt::print("{}\nSeed {}. Written to {}\n", table.markdown(), options.seed,
             (folder / "stability.md").string());
  const auto failed = std::ranges::count_if(results, [](const StabilityResult& r) { return !r.passed(); });
  if (failed > 0) {
    throw std::runtime_error(
        fmt::format("{} of {} stability checks exceed their limit", failed, results.size()));
  }
}

}  // namespace

void add_stability_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<StabilityOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "stability", "Largest numerical errors over extreme inputs, against high-precision references");
  command->add_option("-s,--seed", options->seed, "seed of the photon draws")->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options] { run_stability_command(*options); });
}

}  // namespace dtof
