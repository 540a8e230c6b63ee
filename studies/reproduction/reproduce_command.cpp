// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>

#include "common/commands.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"
#include "reproduction/reproduction.hpp"
#include "reproduction/reproduction_report.hpp"

namespace dtof {
namespace {

struct ReproduceOptions {
  ReproductionSettings settings;
  std::string out = "build/reproduce";
  std::string command_line;
};

void run_reproduce_command(const ReproduceOptions& options) {
  const std::filesystem::path folder(options.out);
  const std::filesystem::path pictures = folder / "reproduction";
  create_output_folder(pictures);
  const auto start = std::chrono::steady_clock::now();
  const ReproductionReport report =
      render_reproduction(measure_reproduction(options.settings), options.command_line);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const ReproductionPicture& picture : report.pictures) {
    write_plot(pictures / picture.name, picture.series, picture.layout);
  }
  write_file(pictures / "accuracy.csv", report.accuracy_csv);
  write_file(folder / "reproduction.csv", report.statements_csv);
  write_page(folder, "reproduction", "reproduction", report.page);
  fmt::print("{}\n{:.0f} s. The report is {}\n", front_page(report), seconds,
             (folder / "reproduction.md").string());
}

}  // namespace

void add_reproduce_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ReproduceOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "reproduce", "The thesis's accuracy statements, measured: reproduction.md with tables and plots");
  command->add_option("-n,--frames", options->settings.frames, "frames per point")
      ->check(CLI::Range(40, 1'000'000))
      ->capture_default_str();
  command->add_option("-s,--seed", options->settings.seed, "seed of everything random but the calibration")
      ->capture_default_str();
  command->add_option("-j,--threads", options->settings.threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options] { run_reproduce_command(*options); });
}

}  // namespace dtof
