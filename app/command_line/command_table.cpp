// SPDX-License-Identifier: Apache-2.0
#include "command_line/command_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>

#include "dtof/core/parameters.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

void add_options(const CLI::App& app, std::vector<const CLI::Option*>& options) {
  const auto own = app.get_options();
  options.insert(options.end(), own.begin(), own.end());
  for (const CLI::App* group : subcommands(app)) {
    if (!group->get_name().empty()) {
      continue;
    }
    std::vector<const CLI::Option*> of_group;
    add_options(*group, of_group);
    // Each group has a help flag of its own beside the command's.
    std::ranges::copy_if(of_group, std::back_inserter(options),
                         [](const CLI::Option* option) { return !option->check_lname("help"); });
  }
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

template <typename Names, typename Name>
std::vector<std::string> names_of(const Names& all, const Name& name) {
  std::vector<std::string> names;
  for (const auto& one : all) {
    names.emplace_back(name(one));
  }
  return names;
}

/// Names that an option takes beside others: files, or several of them.
std::vector<std::string> known_names(const CLI::Option& option) {
  if (option.check_lname("readout")) {
    return names_of(kAllReadouts, readout_name);
  }
  if (option.check_lname("scene")) {
    return names_of(kAllScenes, scene_name);
  }
  if (option.check_lname("sensor")) {
    return names_of(preset_names(), [](std::string_view name) { return name; });
  }
  return {};
}

/// The values of a list, from what the parser's check says of itself: "TEXT:{none,flat}".
std::vector<std::string> listed_values(const std::string& type) {
  const std::size_t begin = type.find('{');
  const std::size_t end = type.rfind('}');
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    return {};
  }
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

OptionText option_text(const CLI::Option& option) {
  OptionText text;
  const std::string type = option.get_type_name();
  text.takes_value = option.get_items_expected_max() > 0;
  text.type = text.takes_value ? type.substr(0, type.find(':')) : "";
  text.initial = text.takes_value ? option.get_default_str() : "";
  text.description = one_line(option.get_description());
  text.values = text.takes_value ? listed_values(type) : std::vector<std::string>();
  text.names_among_values = known_names(option);
  for (const std::string& name : option.get_snames()) {
    text.names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    text.names.push_back("--" + name);
  }
  if (text.names.empty()) {
    text.names.push_back(option.get_name());
  }
  return text;
}

CommandText command_text(const CLI::App& command) {
  CommandText text{
      .name = command.get_name(), .description = one_line(command.get_description()), .options = {}};
  for (const CLI::Option* option : all_options(command)) {
    text.options.push_back(option_text(*option));
  }
  return text;
}

/// A name that a function of the shell may have.
std::string function_name(std::string name) {
  std::ranges::replace(name, '-', '_');
  return "_" + name;
}

/// The words after which a case of the shell stands: its options of one command that take values of a list.
std::string value_cases(const CommandText& command) {
  std::string cases;
  for (const OptionText& option : command.options) {
    const std::vector<std::string>& words = option.values.empty() ? option.names_among_values : option.values;
    if (!words.empty()) {
      cases += fmt::format("    {}) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return ;;\n",
                           fmt::join(option.names, "|"), fmt::join(words, " "));
    }
  }
  return cases;
}

std::vector<std::string> option_names(const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    for (const std::string& name : option.names) {
      if (name.starts_with('-')) {
        names.push_back(name);
      }
    }
  }
  return names;
}

/// Text of a man page: a hyphen is one that can be copied, a line never begins with a command of troff's.
std::string troff(std::string_view text) {
  std::string escaped;
  bool begins_line = true;
  for (const char letter : text) {
    if (begins_line && (letter == '.' || letter == '\'')) {
      escaped += "\\&";
    }
    if (letter == '\\') {
      escaped += "\\e";
    } else if (letter == '-') {
      escaped += "\\-";
    } else {
      escaped += letter;
    }
    begins_line = letter == '\n';
  }
  return escaped;
}

std::string man_options(const CommandText& command) {
  std::string text;
  for (const OptionText& option : command.options) {
    text += fmt::format(".TP\n\\fB{}\\fR{}\n{}", troff(fmt::format("{}", fmt::join(option.names, ", "))),
                        option.type.empty() ? "" : fmt::format(" \\fI{}\\fR", troff(option.type)),
                        troff(option.description.empty() ? option.names.back() : option.description));
    if (!option.values.empty()) {
      text += troff(fmt::format("; one of {}", fmt::join(option.values, ", ")));
    }
    if (!option.initial.empty()) {
      text += troff(fmt::format(" (default: {})", option.initial));
    }
    text += "\n";
  }
  return text;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::toupper(letter); });
  return text;
}

}  // namespace

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> all_options(const CLI::App& command) {
  std::vector<const CLI::Option*> options;
  add_options(command, options);
  return options;
}

std::vector<CommandText> command_table(const CLI::App& app) {
  std::vector<CommandText> table = {command_text(app)};
  for (const CLI::App* command : subcommands(app)) {
    table.push_back(command_text(*command));
  }
  return table;
}

std::string bash_completion(const CLI::App& app) {
  const std::vector<CommandText> table = command_table(app);
  std::vector<std::string> commands;
  std::string options;
  std::string values;
  for (std::size_t i = 1; i < table.size(); ++i) {
    const CommandText& command = table[i];
    commands.push_back(command.name);
    options += fmt::format("  {}) options=\"{}\" ;;\n", command.name, fmt::join(option_names(command), " "));
    if (const std::string cases = value_cases(command); !cases.empty()) {
      values += fmt::format("  {}) case \"$before\" in\n{}    esac ;;\n", command.name, cases);
    }
  }
  if (table.size() == 1) {  // a program without commands: its own options, behind any first word
    if (const std::string cases = value_cases(table.front()); !cases.empty()) {
      values = fmt::format("  *) case \"$before\" in\n{}    esac ;;\n", cases);
    }
  }
  const std::string& program = table.front().name;
  return fmt::format(
      "# Completion of {0} for bash, by `{0} --completion bash`; zsh reads it after\n"
      "# `autoload -U bashcompinit && bashcompinit`.\n"
      "{1}() {{\n"
      "  local word=\"${{COMP_WORDS[COMP_CWORD]}}\" before=\"${{COMP_WORDS[COMP_CWORD-1]}}\" options\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W \"{2} {3}\" -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case \"${{COMP_WORDS[1]}}\" in\n{4}  *) options=\"{3}\" ;;\n  esac\n"
      "  case \"${{COMP_WORDS[1]}}\" in\n{5}  esac\n"
      "  case \"$word\" in\n"
      "  -*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")) ;;\n"
      "  esac\n"
      "}}\n"
      "complete -o default -F {1} {0}\n",
      program, function_name(program), fmt::join(commands, " "), fmt::join(option_names(table.front()), " "),
      options, values);
}

std::string man_page(const CLI::App& app, const std::string& version) {
  const std::vector<CommandText> table = command_table(app);
  const CommandText& program = table.front();
  std::string_view description = program.description;
  if (const std::string name = program.name + ": "; description.starts_with(name)) {
    description.remove_prefix(name.size());  // NAME has it already
  }
  std::string page = fmt::format(
      ".TH {} 1 \"\" \"{} {}\" \"User commands\"\n.ad l\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n\\fB{}\\fR "
      "{}[\\fIOPTIONS\\fR]\n.SH OPTIONS\n{}",
      upper(program.name), program.name, version, troff(program.name), troff(description),
      troff(program.name), table.size() > 1 ? "\\fICOMMAND\\fR " : "", man_options(program));
  page += table.size() > 1 ? ".SH COMMANDS\n" : "";
  for (std::size_t i = 1; i < table.size(); ++i) {
    page += fmt::format(".SS {} {}\n{}\n{}", troff(program.name), troff(table[i].name),
                        troff(table[i].description), man_options(table[i]));
  }
  return page + fmt::format(".SH NOTES\n.nf\n{}\n.fi\n", troff(app.get_footer()));
}

}  // namespace dtof
