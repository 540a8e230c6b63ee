// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "command_line/command_line.hpp"
#include "command_line/folder_result.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "fault_metrics/metric_report.hpp"
#include "fault_metrics/metric_study.hpp"
#include "fault_metrics/result_store.hpp"

namespace {

struct Options {
  dtof::MetricStudyOptions study;
  std::string netlists = "build/fault_metrics/netlists";
  std::vector<std::string> readouts = {"ezpointer", "hispointer", "poolpointer"};
  std::string reports = "reports";
  std::string out = "build/fault_metrics";
};

/// Results of all netlists. Those that an interrupted run has kept in `kept` are not measured again.
std::vector<dtof::ArrayResult> measure(const Options& options, const std::filesystem::path& kept) {
  std::vector<dtof::ArrayResult> results;
  for (const std::string& readout : options.readouts) {
    for (const std::string& name : {readout, readout + "_parity"}) {
      const std::filesystem::path netlist = std::filesystem::path(options.netlists) / (name + ".json");
      const std::filesystem::path file = kept / (name + ".txt");
      const std::string key = dtof::result_key(options.study, netlist);
      if (auto found = dtof::stored_result(file, key)) {
        results.push_back(*found);
        continue;
      }
      results.push_back(dtof::study_netlist(dtof::read_gate_netlist(netlist), options.study));
      dtof::store_result(file, key, results.back());
    }
  }
  return results;
}

void run(const Options& options, const std::string& command_line) {
  dtof::create_output_folder(options.out);
  const std::filesystem::path folder(options.out);
  const std::filesystem::path kept = folder / "kept";
  dtof::create_output_folder(kept.string());
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<dtof::ArrayResult> results = measure(options, kept);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::map<std::string, dtof::ProtectionCost> costs;
  for (const dtof::ArrayResult& result : results) {
    if (const auto cost = dtof::protection_cost(options.reports, result.readout)) {
      costs[result.readout] = *cost;
    }
  }
  const dtof::MetricReport report = dtof::report_metrics(results, costs, options.study, command_line);
  dtof::write_page(folder, "fault_metrics", "fault_metrics", report.page);
  dtof::write_file(folder / "fault_metrics.csv", report.csv);
  std::filesystem::remove_all(kept);
  fmt::print("Seed {}, {:.0f} s. Written to {}\n", options.study.seed, seconds,
             (folder / "fault_metrics.md").string());
}

void add_options(CLI::App& app, const std::string& command_line) {
  const auto options = std::make_shared<Options>();
  app.add_option("--netlists", options->netlists, "folder with the netlists of scripts/fault_netlists.py")
      ->capture_default_str();
  app.add_option("-r,--readout", options->readouts, "read-outs, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("-n,--faults", options->study.faults,
                 "faults of each life that are drawn for each kind of element of each part, at most")
      ->capture_default_str();
  app.add_option("-a,--acquisitions", options->study.acquisitions, "acquisitions of a frame")
      ->capture_default_str();
  app.add_option("-s,--seed", options->study.seed, "seed of photons and faults")->capture_default_str();
  app.add_option("-t,--threads", options->study.threads, "threads; 0: all processors")->capture_default_str();
  app.add_option("--reports", options->reports, "folder with area.csv and timing.csv")->capture_default_str();
  app.add_option("-o,--out", options->out, "output folder")->capture_default_str();
  dtof::add_folder_results(app, command_line, [options, &command_line] { run(*options, command_line); });
}

}  // namespace

int main(int argc, char** argv) {
  const dtof::Program program = {
      .name = "dtof-fault-metrics",
      .description =
          "dtof-fault-metrics: which single faults of a netlist make results wrong, and which of them "
          "the array detects.",
      .examples = "An interrupted run continues behind the netlists that it has finished.\n",
      .add_commands = add_options};
  return dtof::run_program(program, argc, argv);
}
