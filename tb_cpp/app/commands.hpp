// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace dtof {

/// Each adds its subcommand, which runs when the command line is parsed. `command_line` is the whole command
/// line as typed, for reports; it must outlive the parsing.
void add_frame_command(CLI::App& app, const std::string& command_line);
void add_replay_command(CLI::App& app, const std::string& command_line);
void add_accuracy_command(CLI::App& app, const std::string& command_line);
void add_coverage_command(CLI::App& app, const std::string& command_line);
void add_reproduce_command(CLI::App& app, const std::string& command_line);
void add_speed_error_command(CLI::App& app, const std::string& command_line);
void add_fidelity_command(CLI::App& app, const std::string& command_line);
void add_stability_command(CLI::App& app, const std::string& command_line);
void add_scenes_command(CLI::App& app, const std::string& command_line);
void add_walk_command(CLI::App& app, const std::string& command_line);
void add_measured_command(CLI::App& app, const std::string& command_line);
void add_sensor_effects_command(CLI::App& app, const std::string& command_line);
void add_sensor_command(CLI::App& app);
void add_list_command(CLI::App& app);

}  // namespace dtof
