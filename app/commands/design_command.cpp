// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "commands/commands.hpp"
#include "commands/flow_measurement.hpp"
#include "commands/json_result.hpp"
#include "commands/optional_output.hpp"
#include "design/design_page.hpp"
#include "design/design_picture.hpp"
#include "dtof/core/error.hpp"
#include "dtof/design/design.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/rival/rival.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

struct DesignOptions {
  std::string sensor = "thesis";
  std::optional<double> most_mm2;
  std::optional<double> most_mw;
  std::vector<double> klux = {2.0, 50.0};
  std::vector<std::string> scenes = {"room", "poles"};
  double frame_rate = 30.0;
  double clock_mhz = 330.0;
  int frames = 4;
  std::uint64_t seed = 1;
  int threads = 0;
  bool quick = false;
  bool without_rivals = false;
  bool confirm = false;
  std::string out = "build/design";
  bool json = false;
  std::string command_line;
};

DesignRequest request_of(const DesignOptions& options) {
  DesignRequest request;
  request.bench.sensor = find_sensor(options.sensor);
  request.bench.scenes.clear();
  for (const std::string& scene : options.scenes) {
    request.bench.scenes.push_back(parse_scene(scene));
  }
  request.bench.klux = options.klux;
  request.bench.seed = options.seed;
  request.bench.threads = options.threads;
  request.limits.most_mm2 = options.most_mm2.value_or(request.limits.most_mm2);
  request.limits.most_mw = options.most_mw.value_or(request.limits.most_mw);
  request.limits.budget = {.clock_hz = options.clock_mhz * 1e6, .frames_per_s = options.frame_rate};
  request.frames = options.frames;
  if (!options.without_rivals) {
    request.rivals = all_rivals();
  }
  return options.quick ? quick_design(std::move(request)) : request;
}

void run_design_command(const DesignOptions& options, JsonResult& json) {
  const DesignRequest request = request_of(options);
  if (options.confirm) {
    check_flow("--confirm");
  }
  check_design(request);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);  // before the minutes of work
  const DesignResult result = run_design(request);
  const DesignOption& chosen = result.options[*result.recommendation.chosen];
  const std::string rivals = design_rivals(result);
  fmt::print("{}\n{}{}{}{}\nWhat 10 % more or less would bring:\n{}", design_rows(request, result).markdown(),
             rivals, rivals.empty() ? "" : "\n", design_recommendation(request, result),
             design_more_accurate(result), design_consequences(request, result));
  std::string confirmed;
  if (options.confirm) {
    const ArrayChoice& array = chosen.candidate.array;
    RtlConfiguration configuration;
    configuration.parameters = array.parameters;
    configuration.pixels_per_sram = array.rows;
    configuration.sram_num = array.columns;
    configuration.pointer_ports = array.pointer_ports;
    const CostEstimate& cost = chosen.candidate.cost;
    confirmed =
        measured_by_flow("--confirm", configuration, options.clock_mhz) +
        fmt::format("\nEstimated: {:.3f} mm2{}, fmax {:.0f} MHz in the slow corner.\n",
                    cost.mm2 / array.arrays, array.arrays > 1 ? " for each array" : "", cost.fmax_mhz);
    fmt::print("\n{}", confirmed);
  }
  write_file(folder / "design.md",
             design_page(request, result, options.sensor, options.command_line, confirmed));
  write_file(folder / "design.csv", design_csv(request, result));
  write_optional(folder / "design.svg", plot_obstacle(),
                 [&] { write_design_picture(folder / "design.svg", request, result); });
  json["readout"] = readout_name(chosen.candidate.array.parameters.readout);
  json["parameters"] = chosen.candidate.array.parameters.to_string();
  json["mm2"] = chosen.candidate.cost.mm2;
  json["product"] = design_product(request, result, options.sensor);
  for (const RivalOption* rival : more_accurate_rivals(result)) {
    json["more_accurate_rivals"].push_back(rival->entry->name);
  }
  json.add_folder(folder);
  fmt::print("\nProduct: {}\nPage, picture and table are in {}\n",
             design_product(request, result, options.sensor), options.out);
}

}  // namespace

void add_design_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<DesignOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "design",
      "The read-out for a sensor: parameters searched, accuracy by the models, area and power by estimates");
  add_sensor_option(*command, options->sensor);
  command->add_option("--max-mm2", options->most_mm2, "largest array in mm2 (none: any)")
      ->check(above_zero());
  command->add_option("--max-mw", options->most_mw, "most mW while acquisitions stream in (none: any)")
      ->check(above_zero());
  command->add_option("-k,--klux", options->klux, "background light in klux, one or several")
      ->check(sensible_klux())
      ->capture_default_str();
  command
      ->add_option("--scenes", options->scenes, "scenes of `dtof list`, one or several, scaled to the range")
      ->delimiter(',')
      ->capture_default_str();
  add_budget_options(*command, options->frame_rate, options->clock_mhz);
  command->add_option("--frames", options->frames, "frames that compare the read-outs")
      ->check(within(2, 1000, "1000: an interval needs two"))
      ->capture_default_str();
  command->add_flag("--quick", options->quick,
                    "a twentieth of the pixels, wider intervals, no P_d and P_fa, no rivals");
  command->add_flag("--no-rivals", options->without_rivals,
                    "leaves out the read-outs of others, which have no RTL");
  add_study_options(*command, options->seed, options->threads, options->out);
  command->add_flag("--confirm", options->confirm,
                    "synthesises the recommended array by the project's flow, in its folder (minutes)");
  JsonResult::add_to(*command, options->json);
  command->callback([options] {
    JsonResult result(options->json, "design", options->command_line);
    run_design_command(*options, result);
    result.finish();
  });
}

}  // namespace dtof
