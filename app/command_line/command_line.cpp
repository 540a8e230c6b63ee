// SPDX-License-Identifier: Apache-2.0
#include "command_line/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <new>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

#include "command_line/command_table.hpp"
#include "command_line/option_checks.hpp"
#include "command_line/shell_words.hpp"
#include "command_line/standard_streams.hpp"
#include "command_line/version_text.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/suggestion.hpp"
#include "dtof/io/output_error.hpp"
#include "rtl/error.hpp"

namespace dtof {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : subcommands(app)) {
    names.push_back(command->get_name());
  }
  return names;
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

/// The first option that is given more often than it may be; empty if there is none.
std::string repeated_option_error(const CLI::App& command) {
  for (const CLI::Option* option : all_options(command)) {
    const auto most = static_cast<std::size_t>(std::max(option->get_items_expected_max(), 1));
    const std::size_t times = option->count() / most;
    if (option->get_multi_option_policy() == CLI::MultiOptionPolicy::Throw && times > 1) {
      return times == 2 ? fmt::format("{} is given twice", option->get_name())
                        : fmt::format("{} is given {} times", option->get_name(), times);
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
    return fmt::format("{}{} `{} {}--help` lists the options", context, unknown, app.get_name(),
                       parsed.empty() ? "" : command.get_name() + " ");
  }
  if (parsed.empty() && !subcommands(app).empty() &&
      dynamic_cast<const CLI::ValidationError*>(&error) == nullptr) {
    return fmt::format("no command is given; known are {}; `{} --help` explains them",
                       fmt::join(command_names(app), ", "), app.get_name());
  }
  if (const std::string number = bad_number_error(command); !number.empty()) {
    return context + number;
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    if (const std::string repeated = repeated_option_error(command); !repeated.empty()) {
      return context + repeated;
    }
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    const std::string message = error.what();
    constexpr std::string_view kTag = "Could not convert: ";
    return fmt::format("{}{} is beyond what the option can hold", context,
                       message.starts_with(kTag) ? message.substr(kTag.size()) : message);
  }
  return context + error.what();
}

constexpr int kExitInputError = 1;
constexpr int kExitRtlError = 3;
constexpr int kExitFailure = 4;
constexpr int kExitInterrupted = 130;

/// What a program says of itself instead of working: its version, a completion script, a man page.
void add_texts(CLI::App& app, const std::string& name) {
  CLI::Option* version = app.set_version_flag(
      "--version",
      [&app, name] {
        return app["--json"]->count() > 0 ? version_json(name, DTOF_VERSION) : name + " " DTOF_VERSION;
      },
      "the version; with --json also compiler and system, for a report of a problem");
  app.add_flag("--json")->description("with --version: as JSON")->needs(version);
  app.add_option_function<std::string>(
         "--completion",
         [&app](const std::string& /*shell*/) { throw CLI::CallForVersion(bash_completion(app), 0); },
         fmt::format("a completion script for this shell: source <({} --completion bash)", name))
      ->check(CLI::IsMember({"bash"}));
  app.add_flag_callback(
      "--man", [&app] { throw CLI::CallForVersion(man_page(app, DTOF_VERSION), 0); },
      fmt::format("a man page: {} --man | man -l -", name));
}

bool is_interrupted() {
  try {
    check_interruption();
    return false;
  } catch (const Interrupted&) {
    return true;
  }
}

/// A file's name, or what stands in the file, may hold line ends and terminal codes.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char letter) { return letter < ' ' || letter == 0x7F; }, ' ');
  return text;
}

}  // namespace

std::unique_ptr<CLI::App> make_command_line(const Program& program, const std::string& command_line) {
  auto app = std::make_unique<CLI::App>(program.description, program.name);
  add_texts(*app, program.name);
  app->footer(program.examples +
              "Exit codes: 0 done, 1 bad input, 3 RTL misbehaved or differs from its model, 4 failure, 130 "
              "interrupted.");
  program.add_commands(*app, command_line);
  if (!subcommands(*app).empty()) {
    app->require_subcommand(1);
  } else {
    CLI::Option* json = app->get_option("--json");
    json->remove_needs(app->get_option("--version"));
    json->description(
        "the tables as a JSON object on standard output; text for people goes to standard error. With "
        "--version: the version as JSON");
  }
  check_numbers(*app);
  return app;
}

void run_command_line(CLI::App& app, int count, const char* const* arguments) {
  // CLI11 passes over an empty argument, or never returns from one that follows an unknown option; behind
  // "--option=" it takes the next one.
  for (int i = 1; i < count; ++i) {
    const std::string_view text = arguments[i];
    const std::string_view before = i > 1 ? arguments[i - 1] : "";
    if (text.empty() && before.starts_with('-')) {
      throw InputError(fmt::format("the value of {} is empty", before));
    }
    if (text.empty()) {
      throw InputError(fmt::format("argument {} is empty", i));
    }
    if (text.starts_with("--") && text.ends_with('=')) {
      throw InputError(fmt::format("the value of {} is empty", text.substr(0, text.size() - 1)));
    }
  }
  if (count > 1 && !subcommands(app).empty()) {
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

int run_program(const Program& program, int count, const char* const* arguments) {
  open_closed_streams();
  install_interruption_handler();
  let_signals_end_waiting();
  const auto fail = [&](int code, const std::string& reason) {
    print_error_line(fmt::format("{}: error: {}", program.name, reason));
    return code;
  };
  try {
    const std::string command_line = shell_command(
        program.name, std::span(arguments, static_cast<std::size_t>(count)).subspan(count > 0 ? 1 : 0));
    run_command_line(*make_command_line(program, command_line), count, arguments);
    if (const std::string reason = flush_standard_output(); !reason.empty()) {
      return fail(kExitFailure, "standard output: cannot write: " + reason);
    }
    return 0;
  } catch (const OutputError& error) {
    return fail(kExitFailure, in_one_line(error.what()));
  } catch (const InputError& error) {
    return fail(kExitInputError, in_one_line(error.what()));
  } catch (const RtlError& error) {
    return fail(kExitRtlError, error.what());
  } catch (const Interrupted& error) {
    return fail(kExitInterrupted, error.what());
  } catch (const std::system_error& error) {
    if (is_interrupted()) {
      return fail(kExitInterrupted, Interrupted().what());
    }
    // fmt says of a stream that takes no more: "cannot write to file: <reason>".
    return fail(kExitFailure, std::ferror(stdout) != 0
                                  ? "standard output: cannot write: " + error.code().message()
                                  : std::string(error.what()));
  } catch (const std::bad_alloc&) {
    return fail(kExitFailure, "the memory of this machine is not enough");
  } catch (const std::exception& error) {
    return fail(kExitFailure, error.what());
  }
}

}  // namespace dtof
