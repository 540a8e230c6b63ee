// SPDX-License-Identifier: Apache-2.0
#include "app/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "app/commands.hpp"
#include "app/option_checks.hpp"
#include "core/error.hpp"
#include "core/suggestion.hpp"

namespace dtof {
namespace {

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : subcommands(app)) {
    names.push_back(command->get_name());
  }
  return names;
}

void add_options(const CLI::App& app, std::vector<const CLI::Option*>& options) {
  const auto own = app.get_options();
  options.insert(options.end(), own.begin(), own.end());
  for (const CLI::App* group : subcommands(app)) {
    if (group->get_name().empty()) {
      add_options(*group, options);
    }
  }
}

/// Of a command and its option groups.
std::vector<const CLI::Option*> all_options(const CLI::App& command) {
  std::vector<const CLI::Option*> options;
  add_options(command, options);
  return options;
}

void check_command_name(const CLI::App& app, std::string_view name) {
  const std::vector<std::string> names = command_names(app);
  if (!name.starts_with('-') && std::ranges::find(names, name) == names.end()) {
    throw InputError(
        unknown_name("command", name, std::vector<std::string_view>(names.begin(), names.end())));
  }
}

/// What the parser could not place, to be followed by where to look; empty if there is nothing.
std::string unknown_option_error(const CLI::App& command) {
  const std::vector<std::string> rest = command.remaining();
  if (rest.empty()) {
    return "";
  }
  const auto found =
      std::ranges::find_if(rest, [](const std::string& text) { return text.starts_with('-'); });
  if (found == rest.end()) {
    return fmt::format("unexpected argument '{}';", rest.front());
  }
  const std::string option = found->substr(0, found->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : all_options(command)) {
    for (const std::string& name : known->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  const std::string_view nearest =
      nearest_name(option, std::vector<std::string_view>(names.begin(), names.end()));
  return fmt::format("unknown option '{}'{}", option,
                     nearest.empty() ? ";" : fmt::format("; did you mean '{}'?", nearest));
}

/// The first value that is no number where one belongs; empty if there is none.
std::string bad_number_error(const CLI::App& command) {
  for (const CLI::Option* option : all_options(command)) {
    for (const std::string& value : option->results()) {
      if (const std::string error = number_error(value, option->get_type_name()); !error.empty()) {
        return fmt::format("{}: {}", option->get_name(), error);
      }
    }
  }
  return "";
}

/// The parser's complaint, in the program's own words where it knows more.
std::string sentence(const CLI::App& app, const CLI::ParseError& error) {
  const auto parsed = app.get_subcommands();
  const CLI::App& command = parsed.empty() ? app : *parsed.front();
  const std::string context = parsed.empty() ? "" : command.get_name() + ": ";
  if (const std::string unknown = unknown_option_error(command); !unknown.empty()) {
    return fmt::format("{}{} `dtof {}--help` lists the options", context, unknown,
                       parsed.empty() ? "" : command.get_name() + " ");
  }
  if (parsed.empty()) {
    return fmt::format("no command is given; known are {}; `dtof --help` explains them",
                       fmt::join(command_names(app), ", "));
  }
  if (const std::string number = bad_number_error(command); !number.empty()) {
    return context + number;
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    const std::string message = error.what();
    constexpr std::string_view kTag = "Could not convert: ";
    return fmt::format("{}{} is beyond what the option can hold", context,
                       message.starts_with(kTag) ? message.substr(kTag.size()) : message);
  }
  return context + error.what();
}

}  // namespace

std::unique_ptr<CLI::App> make_command_line(const std::string& command_line) {
  auto app = std::make_unique<CLI::App>(
      "dtof: read-outs for large SPAD arrays, from photons to depth.\n"
      "Runs the hardware (Verilated RTL) or its bit-exact model on modelled or recorded TDC streams.");
  app->require_subcommand(1);
  app->set_version_flag("--version", "dtof " DTOF_VERSION);
  app->footer(
      "Try:\n"
      "  dtof frame --scene room --readout all --out build/frame     model every read-out on one scene\n"
      "  dtof frame --readout sifh --engine rtl --verify --columns 0-7 --out build/sifh\n"
      "  dtof replay recording.csv --readout hispointer --engine rtl --out build/replay\n"
      "  dtof accuracy --klux 14 --distances 0.5 1 2 3 --out build/accuracy\n"
      "  dtof reproduce --out reports                                the thesis's statements, measured\n"
      "  dtof sensor thesis                                          a sensor file to start from\n"
      "  dtof list\n"
      "Exit codes: 0 done, 1 bad input, 3 RTL misbehaved or differs from its model, 4 failure, 130 "
      "interrupted.");
  add_frame_command(*app, command_line);
  add_replay_command(*app, command_line);
  add_accuracy_command(*app, command_line);
  add_coverage_command(*app, command_line);
  add_reproduce_command(*app, command_line);
  add_speed_error_command(*app, command_line);
  add_fidelity_command(*app, command_line);
  add_stability_command(*app, command_line);
  add_scenes_command(*app, command_line);
  add_measured_command(*app, command_line);
  add_walk_command(*app, command_line);
  add_sensor_effects_command(*app, command_line);
  add_sensor_command(*app);
  add_list_command(*app);
  check_numbers(*app);
  return app;
}

void run_command_line(CLI::App& app, int count, const char* const* arguments) {
  if (count > 1) {
    check_command_name(app, arguments[1]);
  }
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      throw InputError(sentence(app, error));
    }
    app.exit(error);
  }
}

}  // namespace dtof
