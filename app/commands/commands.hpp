// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command_line/command_line.hpp"

namespace CLI {
class App;
}

namespace dtof {

/// The program dtof: reads out frames, videos and recordings.
Program dtof_program();

/// Each function adds a subcommand; `command_line` as in Program.
void add_frame_command(CLI::App& app, const std::string& command_line);
void add_replay_command(CLI::App& app, const std::string& command_line);
void add_convert_command(CLI::App& app, const std::string& command_line);
void add_video_command(CLI::App& app, const std::string& command_line);
void add_sensor_command(CLI::App& app, const std::string& command_line);
void add_design_command(CLI::App& app, const std::string& command_line);
void add_product_command(CLI::App& app, const std::string& command_line);
void add_list_command(CLI::App& app, const std::string& command_line);

}  // namespace dtof
