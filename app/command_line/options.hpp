// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "run/run_settings.hpp"

namespace dtof {

/// --readout and the options that override read-out parameters.
struct ReadoutOptions {
  std::string readouts = "all";  ///< names, separated by commas
  /// Values of --np, --nb, ..., by the parameter's name. Each parameter that a read-out can choose has an
  /// option.
  std::map<std::string_view, int> values;
  std::vector<int> code_gate;
  bool with_template = false;

  void add_to(CLI::App& command);
  /// Value of an option; none if the option was not given.
  [[nodiscard]] std::optional<int> value(std::string_view parameter) const;
  /// True if the user asked for "all" read-outs and no others.
  [[nodiscard]] bool all() const { return readouts == "all"; }
  /// Parameters of each requested read-out. "all" stands for `all`, "thesis" for kThesisReadouts. Parameters
  /// without an option have the values of default_parameters (sensor/default_parameters.hpp). The template is
  /// measured with `sensor`, --np and --slots. Throws InputError, also for an override that none of the
  /// read-outs has.
  [[nodiscard]] std::vector<ReadoutParameters> parameters(std::span<const Readout> all,
                                                          const SensorModel& sensor = {}) const;
};

/// Adds --sensor and its synonyms: a preset's name or a sensor file.
void add_sensor_option(CLI::App& command, std::string& sensor);
/// Adds --frame-rate and --clock-mhz, which limit the clocks of a frame.
void add_budget_options(CLI::App& command, double& frame_rate, double& clock_mhz);

/// Adds the options of every study: --seed for everything random, --threads and --out.
void add_study_options(CLI::App& command, std::uint64_t& seed, int& threads, std::string& out);

/// Adds --engine, --verify, --trace, --seed, --threads, --columns and --rows.
void add_run_options(CLI::App& command, RunSettings& settings, bool with_subsystem = false);
/// Throws InputError for contradictory options.
void check_run_options(const RunSettings& settings);

/// Options of light and sensor, and of the improvement methods of thesis section 2.2.4.
struct SensorOptions {
  std::string sensor = "thesis";  ///< a preset or a sensor file
  double klux = 14.0;
  std::optional<std::uint32_t> acquisitions;
  std::optional<double> dead_time_ns;
  int binning = 1;
  std::vector<double> time_gate_ns;
  std::optional<double> coincidence_ns;
  std::string fidelity = "exact";
  double tolerance = 0.01;
  mutable std::optional<SensorModel> read_once =
      std::nullopt;  ///< `sensor` after the first read, since it may be a pipe

  void add_to(CLI::App& command);
  /// Adds all options but --klux, for commands with several light levels.
  void add_sensor_to(CLI::App& command);
  /// Sensor as its file describes it. Throws InputError.
  [[nodiscard]] SensorModel described() const;
  /// Sensor with the overrides. Throws InputError.
  [[nodiscard]] SensorModel with_options() const;
  /// Sensor with the overrides and with NP and SLOTS of the read-outs. Throws InputError, also for an
  /// impossible sensor.
  [[nodiscard]] SensorModel model(int np, int slots) const;
  /// Throws InputError for a given option of `command` that has no effect.
  void refuse_options_without_effect(const CLI::App& command) const;
  /// Throws InputError unless a target at `metres` (the value of `option`) is within the sensor's range.
  static void require_in_range(const SensorModel& sensor, double metres, const std::string& option);
  /// Photon model by --fidelity and --tolerance (analytic/fidelity.hpp). Throws InputError.
  [[nodiscard]] Fidelity photon_model(const PhotonSource& exact, PhotonUse use,
                                      std::span<const Readout> readouts) const;
};

}  // namespace dtof
