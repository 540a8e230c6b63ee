// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <string>

#include "app/commands.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "rtl/error.hpp"

namespace {

constexpr int kExitInputError = 1;
constexpr int kExitRtlError = 3;
constexpr int kExitFailure = 4;
constexpr int kExitInterrupted = 130;

std::string join_arguments(int count, char** arguments) {
  std::string line = "dtof";
  for (int i = 1; i < count; ++i) {
    line += ' ';
    line += arguments[i];
  }
  return line;
}

int run(int argc, char** argv) {
  CLI::App app{
      "dtof: read-outs for large SPAD arrays, from photons to depth.\n"
      "Runs the hardware (Verilated RTL) or its bit-exact model on modelled or recorded TDC streams."};
  app.require_subcommand(1);
  app.footer(
      "Try:\n"
      "  dtof frame --scene room --readout all --out build/frame     model every read-out on one scene\n"
      "  dtof frame --readout sifh --engine rtl --verify --columns 0-7 --out build/sifh\n"
      "  dtof replay recording.csv --readout hispointer --engine rtl --out build/replay\n"
      "  dtof accuracy --klux 14 --distances 0.5 1 2 3 --out build/accuracy\n"
      "  dtof reproduce --out reports                                the thesis's statements, measured\n"
      "  dtof list\n"
      "Exit codes: 0 done, 1 bad input, 3 RTL misbehaved or differs from its model, 4 failure, 130 "
      "interrupted.");
  const std::string command_line = join_arguments(argc, argv);
  dtof::add_frame_command(app, command_line);
  dtof::add_replay_command(app, command_line);
  dtof::add_accuracy_command(app, command_line);
  dtof::add_reproduce_command(app, command_line);
  dtof::add_speed_error_command(app, command_line);
  dtof::add_stability_command(app, command_line);
  dtof::add_scenes_command(app, command_line);
  dtof::add_measured_command(app, command_line);
  dtof::add_list_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app.exit(error);
    }
    throw dtof::InputError(error.what());
  }
  return 0;
}

int fail(int code, const std::exception& error) {
  fmt::print(stderr, "dtof: error: {}\n", error.what());
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  dtof::install_interruption_handler();
  try {
    return run(argc, argv);
  } catch (const dtof::InputError& error) {
    return fail(kExitInputError, error);
  } catch (const dtof::RtlError& error) {
    return fail(kExitRtlError, error);
  } catch (const dtof::Interrupted& error) {
    return fail(kExitInterrupted, error);
  } catch (const std::exception& error) {
    return fail(kExitFailure, error);
  }
}
