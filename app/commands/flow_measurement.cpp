// SPDX-License-Identifier: Apache-2.0
#include "commands/flow_measurement.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <sstream>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "on_demand/tool_run.hpp"
#include "rtl/settings.hpp"

namespace dtof {
namespace {

constexpr const char* kFlow = "synth/synth.py";

/// The flow's table without what changes from run to run.
std::string table_of(const std::string& output) {
  std::istringstream lines(output);
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("[") && line.find(" configurations in ") == std::string::npos) {
      table += line + "\n";
    }
  }
  return table;
}

}  // namespace

void check_flow(const std::string& option) {
  if (!std::filesystem::exists(kFlow)) {
    throw InputError(fmt::format("{} needs the project's flow, {}: run the command in the project's folder",
                                 option, kFlow));
  }
}

std::string measured_by_flow(const std::string& option, const RtlConfiguration& configuration,
                             double clock_mhz) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("dtof_flow_{}", getpid());
  std::filesystem::create_directories(folder);
  write_file(folder / "configurations.toml", configuration_toml("product", configuration));
  const std::vector<std::string> command = {kFlow,
                                            "--configurations",
                                            (folder / "configurations.toml").string(),
                                            "run",
                                            "product",
                                            "--csv",
                                            (folder / "areas.csv").string()};
  fmt::print("Measures area and timing of the array: {} run\n", kFlow);
  const std::optional<ToolRun> run = run_tool(command, {});
  std::string text;
  if (run && run->exit_code == 0) {
    text = fmt::format(
        "Area and timing of the array by the flow of `make synth`: generated 40 nm libraries, not sign-off; "
        "without the\n"
        "registers and buffers of the subsystem; for the flow's clock, not {:g} MHz. The mW are those of an "
        "assumed activity: power\n"
        "was not measured.\n\n```\n{}```",
        clock_mhz, table_of(run->output));
  }
  std::filesystem::remove_all(folder);
  if (text.empty()) {
    throw InputError(fmt::format(
        "{}: {} failed: {}", option, kFlow,
        run ? run->output.substr(run->output.rfind('\n', run->output.size() - 2) + 1) : "it does not run"));
  }
  return text;
}

}  // namespace dtof
