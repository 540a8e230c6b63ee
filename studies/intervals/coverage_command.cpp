// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/sensor/preset.hpp"
#include "intervals/coverage_report.hpp"
#include "intervals/coverage_study.hpp"

namespace dtof {
namespace {

struct CoverageOptions {
  CoverageSettings settings;
  ReadoutOptions readout;
  std::string name = "coverage_study";  // of the files
  std::string out = "build/coverage_study";
  std::string command_line;
};

void run_coverage_command(CoverageOptions options) {
  CoverageSettings& settings = options.settings;
  settings.study.sensor = parse_preset("thesis");
  settings.study.distances_m = settings.distances_m;
  settings.study.readouts = options.readout.parameters(kAllReadouts);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  const auto start = std::chrono::steady_clock::now();
  const CoverageStudy study = run_coverage_study(settings);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const PageData page = coverage_page(settings, study, options.command_line);
  write_page(folder, options.name, "coverage_study", page);
  write_file(folder / (options.name + ".csv"), coverage_csv(study).csv());
  fmt::print("{}\n{:.0f} s. The report is {}\n", page_text("coverage_study", page), seconds,
             (folder / (options.name + ".md")).string());
  if (const std::size_t failures = coverage_failures(study); failures > 0) {
    throw std::runtime_error(fmt::format("{} cells of the coverage study fail", failures));
  }
}

}  // namespace

void add_coverage_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<CoverageOptions>();
  options->command_line = command_line;
  CoverageSettings& settings = options->settings;
  settings.klux = {2.0, 14.0, 50.0};
  settings.distances_m = {0.3, 1.0, 4.0};
  CLI::App* command = app.add_subcommand(
      "coverage",
      "Do the confidence intervals hold? Repeats accuracy studies and compares spread and interval");
  command->add_option("-k,--klux", settings.klux, "background light in klux")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("-d,--distances", settings.distances_m, "distances in m")->capture_default_str();
  command->add_option("-n,--frames", settings.frames, "frames per run, ascending; each divides the last")
      ->capture_default_str();
  command->add_option("--seeds", settings.seeds, "number of runs of the most frames")
      ->check(CLI::Range(2, 10'000))
      ->capture_default_str();
  command->add_option("-s,--seed", settings.study.run.seed, "the first seed")->capture_default_str();
  command
      ->add_option("--calibration-seed", settings.study.calibration_seed,
                   "number of the calibration run from which the look-up table comes")
      ->capture_default_str();
  command
      ->add_option("--other-calibrations", settings.other_calibrations,
                   "other calibration runs, for comparison")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_flag("--calibrate-each-seed", settings.calibrate_each_seed,
                    "another look-up table for each seed: the intervals must then fail");
  options->readout.add_to(*command);
  command->add_option("-j,--threads", settings.study.run.threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("--name", options->name, "name of the report's files")->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options] { run_coverage_command(*options); });
}

}  // namespace dtof
