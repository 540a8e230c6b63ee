// SPDX-License-Identifier: Apache-2.0
#include "command_line/folder_result.hpp"
#include "common/commands.hpp"

namespace dtof {

Program study_program() {
  return {
      .name = "dtof-study",
      .description = "dtof-study: how accurate read-outs are, and what the photon models are worth.",
      .examples =
          "Try:\n"
          "  dtof-study accuracy --klux 14 --distances 0.5 1 2 3 --out build/accuracy\n"
          "  dtof-study scenes --scene room clutter --klux 14 --out build/scenes\n"
          "  dtof-study reproduce --out reports                        the thesis's statements, measured\n",
      .add_commands = [](CLI::App& app, const std::string& command_line) {
        add_accuracy_command(app, command_line);
        add_scenes_command(app, command_line);
        add_pool_command(app, command_line);
        add_pool_search_command(app, command_line);
        add_rivals_command(app, command_line);
        add_claims_command(app, command_line);
        add_measured_command(app, command_line);
        add_reproduce_command(app, command_line);
        add_coverage_command(app, command_line);
        add_walk_command(app, command_line);
        add_sensor_effects_command(app, command_line);
        add_speed_error_command(app, command_line);
        add_fidelity_command(app, command_line);
        add_frames_command(app, command_line);
        add_dynamic_range_command(app, command_line);
        add_hostile_scenes_command(app, command_line);
        add_host_filter_command(app, command_line);
        add_design_judgement_command(app, command_line);
        add_detection_command(app, command_line);
        add_enlarge_command(app, command_line);
        add_page_command(app);
        add_folder_results(app, command_line);
      }};
}

}  // namespace dtof
