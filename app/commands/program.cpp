// SPDX-License-Identifier: Apache-2.0
#include "commands/commands.hpp"

namespace dtof {

Program dtof_program() {
  return {
      .name = "dtof",
      .description =
          "dtof: read-outs for large SPAD arrays, from photons to depth.\n"
          "Runs the hardware (Verilated RTL) or its bit-exact model on modelled or recorded TDC streams.",
      .examples =
          "Try:\n"
          "  dtof frame --scene room --readout all --out build/room      model every read-out on one scene\n"
          "  dtof frame --readout sifh --engine rtl --verify --columns 0-7 --out build/sifh\n"
          "  dtof replay recording.csv --readout hispointer --engine rtl --out build/replay\n"
          "  dtof convert depth.png cloud.pcd                            a file of one format as one of "
          "another\n"
          "  dtof video --scene room --motion pan --frames 8 --out build/pan\n"
          "  dtof sensor thesis                                          a sensor file to start from\n"
          "  dtof design --sensor mine.toml --max-mm2 1.0 --out build/d   the read-out that suits that "
          "sensor\n"
          "  dtof product --sensor mine.toml --readout sifh --out chip    RTL, driver and bench for that "
          "sensor\n"
          "  dtof list\n"
          "Studies of accuracy and of the photon models: dtof-study --help\n",
      .add_commands = [](CLI::App& app, const std::string& command_line) {
        add_frame_command(app, command_line);
        add_replay_command(app, command_line);
        add_convert_command(app, command_line);
        add_video_command(app, command_line);
        add_sensor_command(app, command_line);
        add_design_command(app, command_line);
        add_product_command(app, command_line);
        add_list_command(app, command_line);
      }};
}

}  // namespace dtof
