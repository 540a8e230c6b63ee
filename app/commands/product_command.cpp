// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "commands/commands.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/sensor/preset.hpp"
#include "on_demand/tool_run.hpp"
#include "product/product.hpp"
#include "rtl/settings.hpp"

namespace dtof {
namespace {

struct ProductOptions {
  ReadoutOptions readout;
  std::string sensor = "thesis";
  std::string scene = "room";
  double klux = 14.0;
  std::uint64_t seed = 1;
  std::uint32_t vector_acquisitions = 0;
  double frame_rate = 30.0;
  double clock_mhz = 330.0;
  bool measure = false;
  std::string out;
  std::string command_line;
};

/// The command with the same name for every folder.
std::string command_of(const ProductOptions& options) {
  std::string command = options.command_line;
  for (const std::string& option : {std::string("--out "), std::string("--out="), std::string("-o ")}) {
    const std::size_t at = command.rfind(option + options.out);
    if (at != std::string::npos) {
      return command.replace(at + option.size(), options.out.size(), "chip");
    }
  }
  return command;
}

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

/// What `synth/synth.py run` says of the array, as text of the report.
std::string measured(const ReadoutParameters& parameters, const SensorModel& sensor, double clock_mhz) {
  const char* flow = "synth/synth.py";
  if (!std::filesystem::exists(flow)) {
    throw InputError(
        "--measure needs the project's flow, synth/synth.py: run the command in the project's folder");
  }
  RtlConfiguration configuration;
  configuration.parameters = parameters;
  configuration.pixels_per_sram = sensor.rows;
  configuration.sram_num = sensor.columns;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("dtof_product_{}", getpid());
  std::filesystem::create_directories(folder);
  write_file(folder / "configurations.toml", configuration_toml("product", configuration));
  const std::vector<std::string> command = {flow,
                                            "--configurations",
                                            (folder / "configurations.toml").string(),
                                            "run",
                                            "product",
                                            "--csv",
                                            (folder / "areas.csv").string()};
  fmt::print("Measures area and timing of the array: {} run\n", flow);
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
        "--measure: {} failed: {}", flow,
        run ? run->output.substr(run->output.rfind('\n', run->output.size() - 2) + 1) : "it does not run"));
  }
  return text;
}

void run_product_command(const ProductOptions& options) {
  const DescribedSensor described = find_described_sensor(options.sensor);
  const std::vector<ReadoutParameters> readouts = options.readout.parameters(kRtlReadouts, described.model);
  if (readouts.size() != 1) {
    throw InputError(
        fmt::format("product: --readout names {} read-outs; a product has one", readouts.size()));
  }
  if (!has_rtl(readouts.front().readout)) {
    throw InputError(fmt::format("product: there is no RTL of {}", readout_name(readouts.front().readout)));
  }
  ProductRequest request{.sensor_text = described.text,
                         .sensor = described.model,
                         .parameters = readouts.front(),
                         .scene = parse_scene(options.scene),
                         .klux = options.klux,
                         .seed = options.seed,
                         .vector_acquisitions = options.vector_acquisitions,
                         .budget = {.clock_hz = options.clock_mhz * 1e6, .frames_per_s = options.frame_rate},
                         .command = command_of(options),
                         .measurements = {}};
  request.sensor.np = request.parameters.np;
  request.sensor.slots = request.parameters.slots;
  request.sensor.validate();
  if (options.measure) {
    request.measurements = measured(request.parameters, request.sensor, options.clock_mhz);
  }
  const auto files = product_files(request);
  write_product(files, options.out);
  fmt::print("{}\n{} files in {}; `make -C {}` runs and checks them.\n",
             frame_fit(request.parameters, request.sensor.rows, request.sensor.columns,
                       request.sensor.acquisitions, request.budget)
                 .sentence,
             files.size(), options.out, options.out);
}

}  // namespace

void add_product_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ProductOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "product",
      "A folder for an integrator: a read-out's RTL for a sensor, file lists, driver, vectors and a bench");
  options->readout.add_to(*command);
  command->get_option("--readout")->required();
  add_sensor_option(*command, options->sensor);
  command->add_option("--scene", options->scene, "scene of the test vectors")->capture_default_str();
  command->add_option("-k,--klux", options->klux, "background light of vectors and table in klux")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("-s,--seed", options->seed, "seed of the photons")->capture_default_str();
  command->add_option(
      "--vector-acquisitions", options->vector_acquisitions,
      "acquisitions of the test vectors (default: as many of the sensor's as fit some megabytes)");
  command->add_option("--frame-rate", options->frame_rate, "frames/s that a frame has to fit")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--clock-mhz", options->clock_mhz, "the clock")
      ->check(above_zero())
      ->capture_default_str();
  command->add_flag("--measure", options->measure,
                    "area and timing of the array by the project's synthesis flow, in its folder (minutes)");
  command->add_option("-o,--out", options->out, "folder to make")->required();
  command->callback([options] { run_product_command(*options); });
}

}  // namespace dtof
