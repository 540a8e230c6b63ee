// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command_line/command_line.hpp"

namespace CLI {
class App;
}

namespace dtof {

/// The program dtof-study: evaluates read-outs and photon models.
Program study_program();

/// Each function adds a subcommand; `command_line` as in Program.
void add_accuracy_command(CLI::App& app, const std::string& command_line);
void add_scenes_command(CLI::App& app, const std::string& command_line);
void add_pool_command(CLI::App& app, const std::string& command_line);
void add_pool_search_command(CLI::App& app, const std::string& command_line);
void add_rivals_command(CLI::App& app, const std::string& command_line);
void add_claims_command(CLI::App& app, const std::string& command_line);
void add_measured_command(CLI::App& app, const std::string& command_line);
void add_reproduce_command(CLI::App& app, const std::string& command_line);
void add_coverage_command(CLI::App& app, const std::string& command_line);
void add_walk_command(CLI::App& app, const std::string& command_line);
void add_sensor_effects_command(CLI::App& app, const std::string& command_line);
void add_speed_error_command(CLI::App& app, const std::string& command_line);
void add_fidelity_command(CLI::App& app, const std::string& command_line);
void add_frames_command(CLI::App& app, const std::string& command_line);
void add_dynamic_range_command(CLI::App& app, const std::string& command_line);
void add_detection_command(CLI::App& app, const std::string& command_line);
void add_hostile_scenes_command(CLI::App& app, const std::string& command_line);
void add_host_filter_command(CLI::App& app, const std::string& command_line);
void add_design_judgement_command(CLI::App& app, const std::string& command_line);
void add_enlarge_command(CLI::App& app, const std::string& command_line);
void add_page_command(CLI::App& app);

}  // namespace dtof
