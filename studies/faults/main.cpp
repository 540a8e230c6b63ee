// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "faults/fault_report.hpp"
#include "faults/fault_study.hpp"
#include "rtl/error.hpp"

namespace {

constexpr int kExitInputError = 1;
constexpr int kExitRtlError = 3;
constexpr int kExitFailure = 4;
constexpr int kExitInterrupted = 130;

void run(int argc, char** argv) {
  CLI::App app{
      "dtof-faults: what flipped bits, stuck columns, hot and dead pixels and resets do to a frame of the "
      "RTL."};
  dtof::FaultStudyOptions options;
  std::vector<std::string> readouts = {"all"};
  std::string out = "build/faults";
  app.add_option("-r,--readout", readouts, "read-outs, separated by commas, or all")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("-n,--flips", options.flips, "flipped bits per kind of SRAM; other faults in proportion")
      ->capture_default_str();
  app.add_option("-a,--acquisitions", options.acquisitions, "acquisitions of a frame")->capture_default_str();
  app.add_option("-s,--seed", options.seed, "seed of photons and faults")->capture_default_str();
  app.add_option("-t,--threads", options.threads, "threads; 0: all processors")->capture_default_str();
  app.add_option("-o,--out", out, "output folder")->capture_default_str();
  app.footer(
      "Exit codes: 0 done, 1 bad input, 3 a fault went farther than it should, 4 failure, 130 interrupted.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app.exit(error);
      return;
    }
    throw dtof::InputError(error.what());
  }
  if (readouts != std::vector<std::string>{"all"}) {
    options.readouts.clear();
    for (const std::string& name : readouts) {
      options.readouts.push_back(dtof::parse_readout(name));
    }
  }
  dtof::create_output_folder(out);

  const auto begin = std::chrono::steady_clock::now();
  const std::vector<dtof::FaultCaseResult> results = dtof::study_faults(options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::string command_line = "dtof-faults";
  for (int i = 1; i < argc; ++i) {
    command_line += fmt::format(" {}", argv[i]);
  }
  const dtof::FaultReport report = dtof::report_faults(results, options, command_line);
  const std::filesystem::path folder(out);
  dtof::write_file(folder / "faults.md", report.markdown);
  dtof::write_file(folder / "faults.csv", report.csv);
  fmt::print("{}Seed {}, {:.0f} s. Written to {}\n", report.conclusions, options.seed, seconds,
             (folder / "faults.md").string());
  if (!dtof::faults_stay_where_they_are(results)) {
    throw dtof::RtlError("a fault went farther than it should: see the report");
  }
}

int fail(int code, const std::exception& error) {
  fmt::print(stderr, "dtof-faults: error: {}\n", error.what());
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  dtof::install_interruption_handler();
  try {
    run(argc, argv);
    return 0;
  } catch (const dtof::InputError& error) {
    return fail(kExitInputError, error);
  } catch (const dtof::RtlError& error) {
    return fail(kExitRtlError, error);
  } catch (const dtof::Interrupted& error) {
    return fail(kExitInterrupted, error);
  } catch (const std::exception& error) {
    return fail(kExitFailure, error);
  }
}
