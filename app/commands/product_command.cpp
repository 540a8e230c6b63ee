// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/shell_words.hpp"
#include "commands/commands.hpp"
#include "commands/flow_measurement.hpp"
#include "commands/json_result.hpp"
#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "product/product.hpp"

namespace dtof {
namespace {

struct ProductOptions {
  ReadoutOptions readout;
  std::string sensor = "thesis";
  std::string scene = "room";
  double klux = 14.0;
  std::uint64_t seed = 1;
  std::optional<std::uint32_t> vector_acquisitions;
  double frame_rate = 30.0;
  double clock_mhz = 330.0;
  bool self_test = false;
  bool measure = false;
  int pointer_ports = 2;
  int columns_per_sram = 1;
  std::string out;
  bool json = false;
  std::string command_line;
};

/// The command with the same name for every folder.
std::string command_of(const ProductOptions& options) {
  std::string command = options.command_line;
  const std::string out = shell_word(options.out);
  for (const std::string& option : {std::string("--out "), std::string("--out="), std::string("-o ")}) {
    const std::size_t at = command.rfind(option + out);
    if (at != std::string::npos) {
      return command.replace(at + option.size(), out.size(), "chip");
    }
  }
  return command;
}

/// Throws InputError for acquisitions of the vectors that the sensor does not have.
void check_vector_acquisitions(const ProductOptions& options, const SensorModel& sensor) {
  const std::uint32_t asked = options.vector_acquisitions.value_or(1);
  if (asked < 1 || asked > sensor.acquisitions) {
    throw InputError(
        fmt::format("product: --vector-acquisitions is {}, must be 1 to the sensor's {} acquisitions", asked,
                    sensor.acquisitions));
  }
}

void run_product_command(const ProductOptions& options, JsonResult& result) {
  check_product_folder(options.out);  // before the work
  const DescribedSensor described = find_described_sensor(options.sensor);
  const std::vector<ReadoutParameters> readouts = options.readout.parameters(kRtlReadouts, described.model);
  if (readouts.size() != 1) {
    throw InputError(
        fmt::format("product: --readout names {} read-outs; a product has one", readouts.size()));
  }
  if (!has_rtl(readouts.front().readout)) {
    throw InputError(fmt::format("product: there is no RTL of {}", readout_name(readouts.front().readout)));
  }
  check_vector_acquisitions(options, described.model);
  ProductRequest request{.sensor_text = described.text,
                         .sensor = described.model,
                         .parameters = readouts.front(),
                         .pointer_ports = options.pointer_ports,
                         .columns_per_sram = options.columns_per_sram,
                         .scene = parse_scene(options.scene),
                         .klux = options.klux,
                         .seed = options.seed,
                         .vector_acquisitions = options.vector_acquisitions.value_or(0),
                         .self_test = options.self_test,
                         .budget = {.clock_hz = options.clock_mhz * 1e6, .frames_per_s = options.frame_rate},
                         .command = command_of(options),
                         .measurements = {}};
  request.sensor.np = request.parameters.np;
  request.sensor.slots = request.parameters.slots;
  request.sensor.validate();
  if (options.measure) {
    check_flow("--measure");
    request.measurements = measured_by_flow("--measure", product_array(request), options.clock_mhz);
  }
  const auto files = product_files(request);
  write_product(files, options.out);
  result["readout"] = readout_name(request.parameters.readout);
  result["parameters"] = request.parameters.to_string();
  result.add_folder(options.out);
  fmt::print("{}\n{} files in {}; `make -C {}` runs and checks them.\n", product_fit(request).sentence,
             files.size(), options.out, shell_word(options.out));
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
  add_budget_options(*command, options->frame_rate, options->clock_mhz);
  command
      ->add_option("--pointer-ports", options->pointer_ports,
                   "ports of the pointers' memory: 2, or 1, which is smaller, with SLOTS of at least 2")
      ->capture_default_str();
  command
      ->add_option(
          "--columns-per-sram", options->columns_per_sram,
          "columns of the sensor that share an SRAM, one after the other: fewer, larger SRAMs and longer\n"
          "frames, with the same results; 1 for a pool read-out")
      ->capture_default_str();
  command->add_flag("--self-test", options->self_test,
                    "with the built-in self-test, whose checksum the driver's header and the bench have");
  command->add_flag("--measure", options->measure,
                    "area and timing of the array by the project's synthesis flow, in its folder (minutes)");
  command->add_option("-o,--out", options->out, "folder to make")->required();
  JsonResult::add_to(*command, options->json);
  command->callback([options] {
    JsonResult result(options->json, "product", options->command_line);
    run_product_command(*options, result);
    result.finish();
  });
}

}  // namespace dtof
