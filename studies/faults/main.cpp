// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command_line/command_line.hpp"
#include "command_line/folder_result.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "faults/fault_report.hpp"
#include "faults/fault_study.hpp"
#include "rtl/error.hpp"

namespace {

struct Options {
  dtof::FaultStudyOptions study;
  std::vector<std::string> readouts = {"all"};
  std::string out = "build/faults";
};

void run(Options options, const std::string& command_line) {
  if (options.readouts != std::vector<std::string>{"all"}) {
    options.study.readouts.clear();
    for (const std::string& name : options.readouts) {
      options.study.readouts.push_back(dtof::parse_readout(name));
    }
  }
  dtof::create_output_folder(options.out);

  const auto begin = std::chrono::steady_clock::now();
  const std::vector<dtof::FaultCaseResult> results = dtof::study_faults(options.study);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const dtof::FaultReport report = dtof::report_faults(results, options.study, command_line);
  const std::filesystem::path folder(options.out);
  dtof::write_page(folder, "faults", "faults", report.page);
  dtof::write_file(folder / "faults.csv", report.csv);
  fmt::print("Seed {}, {:.0f} s. Written to {}\n", options.study.seed, seconds,
             (folder / "faults.md").string());
  if (!dtof::faults_stay_where_they_are(results)) {
    throw dtof::RtlError("a fault went farther than it should: see the report");
  }
}

void add_options(CLI::App& app, const std::string& command_line) {
  const auto options = std::make_shared<Options>();
  app.add_option("-r,--readout", options->readouts, "read-outs, separated by commas, or all")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("-n,--flips", options->study.flips,
                 "flipped bits per kind of SRAM; other faults in proportion")
      ->capture_default_str();
  app.add_option("-a,--acquisitions", options->study.acquisitions, "acquisitions of a frame")
      ->capture_default_str();
  app.add_option("-s,--seed", options->study.seed, "seed of photons and faults")->capture_default_str();
  app.add_option("-t,--threads", options->study.threads, "threads; 0: all processors")->capture_default_str();
  app.add_option("-o,--out", options->out, "output folder")->capture_default_str();
  dtof::add_folder_results(app, command_line, [options, &command_line] { run(*options, command_line); });
}

}  // namespace

int main(int argc, char** argv) {
  const dtof::Program program = {
      .name = "dtof-faults",
      .description =
          "dtof-faults: what flipped bits, stuck columns, hot and dead pixels and resets do to a frame of "
          "the RTL.",
      .examples = "A fault that goes farther than it should ends the program with exit code 3.\n",
      .add_commands = add_options};
  return dtof::run_program(program, argc, argv);
}
