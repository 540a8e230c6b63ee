// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "common/scene_list.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "host_filter/host_filter_report.hpp"

namespace dtof {
namespace {

struct HostFilterOptions {
  SceneChoice scenes;
  std::vector<std::string> readouts = {"poolpointer",     "poolpointer-lean", "hispointer",
                                       "coarsehistogram", "histogram",        "ezpointer"};
  std::string sensor = "thesis";
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  HostFilterSettings settings;
  bool goal = true;
  std::string out = "build/host_filter";
  std::string command_line;
};

void run_host_filter(HostFilterOptions options) {
  HostFilterSettings& settings = options.settings;
  settings.sensor = find_sensor(options.sensor);
  options.scenes.columns = settings.sensor.columns;
  for (const std::string& name : options.readouts) {
    settings.readouts.push_back(default_parameters(parse_readout(name), settings.sensor));
  }
  settings.scenes = [&options, &settings](std::uint64_t seed) {
    SceneChoice choice = options.scenes;
    choice.seed = seed;
    return make_scenes(choice, settings.sensor).scenes;
  };
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  HostFilterReport report{
      .settings = settings, .lights = {}, .whole = {}, .command_line = options.command_line};
  if (options.goal) {
    HostFilterSettings whole = settings;
    whole.readouts = {default_parameters(Readout::kPoolPointer, settings.sensor)};
    whole.references = false;
    whole.columns = settings.sensor.columns;
    report.whole.push_back(measure_host_filter(whole, kFilterGoalKlux));
  }
  std::ranges::sort(options.klux);
  for (const double klux : options.klux) {
    report.lights.push_back(measure_host_filter(settings, klux));
    fmt::print("\n## {:g} klux\n\n{}", klux, host_filter_table(report.lights.back()).markdown());
  }
  write_file(folder / "host_filter.csv", host_filter_csv(report).csv());
  const std::vector<PlotSeries> curves = host_filter_curves(report);
  if (!curves.empty()) {
    write_plot(folder / "host_filter.svg", curves,
               {.title = fmt::format("Pixels above 3 %, before and after the host filter, sensor {}",
                                     settings.sensor.name),
                .x_label = "background light in klux",
                .y_label = "pixels above 3 %, in %",
                .logarithmic_y = true,
                .logarithmic_x = true});
  }
  write_page(folder, "host_filter", "host_filter", host_filter_page(report));
  fmt::print("\nThe report is {}\n", (folder / "host_filter.md").string());
}

}  // namespace

void add_host_filter_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<HostFilterOptions>();
  options->command_line = command_line;
  options->scenes.scenes = {"room", "planes", "clutter", "poles", "isolated"};  // those of pool but the flats
  CLI::App* command =
      app.add_subcommand("host-filter", "Errors of each read-out's maps before and after the host filter");
  add_sensor_option(*command, options->sensor);
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("--readout", options->readouts, "read-outs from `dtof list`, one or more")
      ->capture_default_str();
  command->add_flag("!--no-references", options->settings.references, "leave out the matched filters");
  command->add_flag("!--no-goal", options->goal, "do not read whole maps by poolPointer at 50 klux");
  add_scene_options(*command, options->scenes);
  command
      ->add_option("--columns", options->settings.columns, "columns in the middle of each map that are read")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--seeds", options->settings.seeds, "seeds, from the first one up")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  add_study_options(*command, options->settings.seed, options->settings.threads, options->out);
  command->callback([options, command] {
    check_scene_options(*command, options->scenes);
    run_host_filter(*options);
  });
}

}  // namespace dtof
