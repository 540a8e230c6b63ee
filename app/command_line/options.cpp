// SPDX-License-Identifier: Apache-2.0
#include "command_line/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "command_line/option_checks.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parameter_entry.hpp"
#include "dtof/frame/empty_frame.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

template <typename T>
void override_with(const std::optional<T>& value, T& parameter) {
  if (value) {
    parameter = *value;
  }
}

/// True if some read-out can choose the parameter.
bool is_choice(std::string_view parameter) {
  return parameter == "NP" || parameter == "SLOTS" || std::ranges::any_of(kAllReadouts, [&](Readout readout) {
           return has_parameter(readout, parameter);
         });
}

/// Names of a list in commas, each of them once.
std::vector<std::string> readout_names(const std::string& list) {
  std::vector<std::string> names = CLI::detail::split(list, ',');
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(names.begin(), name, *name) != name) {
      throw InputError(fmt::format("--readout: {} is named twice", *name));
    }
  }
  return names;
}

/// "--count-width" of COUNT_WIDTH.
std::string option_of(std::string_view parameter) {
  std::string option = "--";
  for (const char letter : parameter) {
    option += letter == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return option;
}

}  // namespace

void ReadoutOptions::add_to(CLI::App& command) {
  auto* group = command.add_option_group("read-out");
  group
      ->add_option(
          "-r,--readout", readouts,
          "read-outs to run: all, thesis (its eight), or names from `dtof list`, separated by commas")
      ->capture_default_str();
  for (const ParameterEntry& entry : parameter_entries()) {
    if (!is_choice(entry.name)) {
      continue;
    }
    const std::string option = option_of(entry.name);
    const std::string help = fmt::format("{}: {}", entry.name, entry.help);
    if (entry.flag) {
      group->add_flag_callback(
          option, [this, name = entry.name] { values[name] = 1; }, help);
    } else {
      group->add_option_function<int>(
          option, [this, name = entry.name](const int& number) { values[name] = number; },
          fmt::format("{}\n({}; default: {})", help, entry.legal, default_source(entry.name)));
    }
  }
  group
      ->add_option("--code-gate", code_gate,
                   "TIME_GATE of the read-out: codes BEGIN <= x < END count (--gate is the sensor's own)")
      ->expected(2);
  group->add_flag(
      "--template", with_template,
      "TEMPLATE of the pool read-outs: decode subtracts the light of the sensor's cover glass and fog");
}

std::optional<int> ReadoutOptions::value(std::string_view parameter) const {
  const auto found = values.find(parameter);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::vector<ReadoutParameters> ReadoutOptions::parameters(std::span<const Readout> all,
                                                          const SensorModel& sensor) const {
  SensorModel asked = sensor;
  override_with(value("NP"), asked.np);
  override_with(value("SLOTS"), asked.slots);
  std::vector<Readout> chosen;
  for (const std::string& name : readout_names(readouts)) {
    if (name == "all") {
      chosen.insert(chosen.end(), all.begin(), all.end());
    } else if (name == "thesis") {
      chosen.insert(chosen.end(), kThesisReadouts.begin(), kThesisReadouts.end());
    } else {
      chosen.push_back(parse_readout(name));
    }
  }
  if (!code_gate.empty() && code_gate[0] >= code_gate[1]) {
    throw InputError(
        fmt::format("--code-gate: no code is at least {} and below {}", code_gate[0], code_gate[1]));
  }
  for (const auto& [name, number] : values) {
    const bool for_all = name == "NP" || name == "SLOTS";
    if (!for_all &&
        std::ranges::none_of(chosen, [&](Readout readout) { return has_parameter(readout, name); })) {
      throw InputError(fmt::format("{} has no effect: {} has no {}", option_of(name), readouts, name));
    }
  }
  if (with_template) {
    if (std::ranges::none_of(chosen, is_pool_readout)) {
      throw InputError(fmt::format("--template has no effect: {} has no TEMPLATE", readouts));
    }
    if (!has_own_light(asked)) {
      throw InputError("--template has no effect: the sensor has neither cover glass nor fog");
    }
  }
  std::vector<ReadoutParameters> sets;
  for (const Readout readout : chosen) {
    ReadoutParameters parameters = default_parameters(readout, asked);
    for (const auto& [name, number] : values) {
      if (has_parameter(readout, name)) {
        find_parameter_entry(name)->set(parameters, number);
      }
    }
    if (!code_gate.empty()) {
      parameters.time_gate = CodeGate{code_gate[0], code_gate[1]};
    }
    parameters.validate();
    if (with_template && is_pool_readout(readout)) {
      parameters.pool.coarse_template = template_of(asked, parameters);
    }
    if (std::find(sets.begin(), sets.end(), parameters) == sets.end()) {
      sets.push_back(parameters);
    }
  }
  return sets;
}

void add_sensor_option(CLI::App& command, std::string& sensor) {
  command
      .add_option("--sensor,-p,--preset", sensor,
                  "a preset of `dtof list`, or a sensor file (TOML, docs/user/sensor_file.md); behind it\n"
                  "conditions of `dtof list`, each after a +: thesis+fog")
      ->capture_default_str();
}

void add_budget_options(CLI::App& command, double& frame_rate, double& clock_mhz) {
  command.add_option("--frame-rate", frame_rate, "frames/s that a frame has to fit")
      ->check(sensible_frame_rate())
      ->capture_default_str();
  command.add_option("--clock-mhz", clock_mhz, "the clock")
      ->check(sensible_clock_mhz())
      ->capture_default_str();
}

void add_study_options(CLI::App& command, std::uint64_t& seed, int& threads, std::string& out) {
  command.add_option("-s,--seed", seed, "seed of everything random")->capture_default_str();
  command.add_option("-j,--threads", threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command.add_option("-o,--out", out, "output folder")->capture_default_str();
}

void add_run_options(CLI::App& command, RunSettings& settings, bool with_subsystem) {
  auto* group = command.add_option_group("run");
  std::vector<std::string> engines = {"model", "rtl"};
  if (with_subsystem) {
    engines.emplace_back("subsystem");
  }
  group
      ->add_option("-e,--engine", settings.engine,
                   with_subsystem
                       ? "model (C++), rtl (the Verilated hardware) or subsystem (the hardware with\n"
                         "registers and streams, run by its C driver; in dtof-full)"
                       : "model (C++) or rtl (the Verilated hardware)")
      ->check(CLI::IsMember(engines))
      ->capture_default_str();
  group->add_flag("--verify", settings.verify,
                  "with an engine that is hardware: compare every pixel with the model");
  group->add_option("--trace", settings.trace,
                    "with --engine rtl and one read-out, in dtof-wave: waveform file (FST)");
  group->add_option("-s,--seed", settings.seed, "seed of everything random")->capture_default_str();
  group->add_option("-j,--threads", settings.threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  group
      ->add_option("--columns", settings.columns,
                   "columns to read out: all, or e.g. 0-9,20; others cost nothing")
      ->capture_default_str();
  group
      ->add_option(
          "--rows", settings.rows,
          "rows to read out: all, or one range, e.g. 40-79: with --columns a region of interest; others\n"
          "are off and cost nothing. poolPointer's array has at least 160 rows unless --own-rows is\n"
          "given; those that are off, and those beyond the sensor's, are dark neighbours")
      ->capture_default_str();
  group->add_flag("--own-rows", settings.own_rows,
                  "poolPointer's array has the sensor's rows alone, as a chip for the sensor would");
}

void check_run_options(const RunSettings& settings) {
  if ((!settings.hardware() && settings.verify) || (!settings.rtl() && !settings.trace.empty())) {
    throw InputError("--verify and --trace need --engine rtl");
  }
}

void SensorOptions::add_to(CLI::App& command) {
  command.add_option("-k,--klux", klux, "background light in klux")
      ->check(sensible_klux())
      ->capture_default_str();
  add_sensor_to(command);
}

void SensorOptions::add_sensor_to(CLI::App& command) {
  auto* group = command.add_option_group("sensor");
  add_sensor_option(*group, sensor);
  group->add_option("-a,--acquisitions", acquisitions, "laser pulses per frame (default: the sensor's)")
      ->check(sensible_acquisitions());
  group->add_option("--dead-time", dead_time_ns, "dead time of a pixel in ns");
  group->add_option("--binning", binning, "B: blocks of B x B pixels share one stream")
      ->capture_default_str();
  group->add_option("--gate", time_gate_ns, "time gate, BEGIN END in ns")->expected(2);
  group->add_option("--coincidence", coincidence_ns, "coincidence window in ns");
  group
      ->add_option(
          "--fidelity", fidelity,
          "photon model: exact (event by event), fast (times from tables), analytic (expected\n"
          "detections, no noise; frame only), auto (the cheapest with noise that keeps --tolerance;\n"
          "streams for the RTL, poolPointer, accuracy and recordings are always drawn exactly)")
      ->check(CLI::IsMember({"exact", "fast", "analytic", "auto"}))
      ->capture_default_str();
  group
      ->add_option("--tolerance", tolerance,
                   "auto: how far the figures may be from those of the exact model in the mean over frames:\n"
                   "rmse and bias of the relative error, shares above 3 % and 10 % (reports/fidelity.md)")
      ->capture_default_str();
}

SensorModel SensorOptions::described() const {
  if (!read_once) {
    read_once = find_sensor(sensor);
  }
  return *read_once;
}

SensorModel SensorOptions::with_options() const {
  SensorModel model = described();
  override_with(acquisitions, model.acquisitions);
  if (dead_time_ns) {
    model.dead_time_s = *dead_time_ns / kNanosecondsPerSecond;
  }
  model.binning = binning;
  if (!time_gate_ns.empty()) {
    model.time_gate =
        TimeGate{time_gate_ns[0] / kNanosecondsPerSecond, time_gate_ns[1] / kNanosecondsPerSecond};
  }
  if (coincidence_ns) {
    model.coincidence_window_s = *coincidence_ns / kNanosecondsPerSecond;
  }
  return model;
}

SensorModel SensorOptions::model(int np, int slots) const {
  SensorModel model = with_options();
  model.np = np;
  model.slots = slots;
  model.validate();
  return model;
}

void SensorOptions::refuse_options_without_effect(const CLI::App& command) const {
  if (fidelity != "auto") {
    refuse_without_effect(command, "--tolerance", "only --fidelity auto has one");
  }
}

void SensorOptions::require_in_range(const SensorModel& sensor, double metres, const std::string& option) {
  if (metres >= sensor_range_m(sensor)) {
    throw InputError(fmt::format("{}: {} m is beyond {}", option, metres, range_phrase(sensor)));
  }
}

Fidelity SensorOptions::photon_model(const PhotonSource& exact, PhotonUse use,
                                     std::span<const Readout> readouts) const {
  return parse_fidelity(fidelity, exact, {.tolerance = tolerance, .use = use, .readouts = readouts});
}

}  // namespace dtof
