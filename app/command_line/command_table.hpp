// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace dtof {

/// An option as help, completion and man page show it.
struct OptionText {
  std::vector<std::string> names;  ///< "-r", "--readout"; of a positional its name without hyphens
  bool takes_value = false;
  std::string type;                             ///< "TEXT", "FLOAT"; empty for a flag
  std::string initial;                          ///< its value where none is given, as far as it is known
  std::string description;                      ///< one line
  std::vector<std::string> values;              ///< those that it takes, where they are a list
  std::vector<std::string> names_among_values;  ///< read-outs, scenes or presets, where it takes others, too
};

/// A command, and the program itself, whose name is then that of the program.
struct CommandText {
  std::string name;
  std::string description;  ///< one line
  std::vector<OptionText> options;
};

/// The commands of a program, as the parser has them.
std::vector<const CLI::App*> subcommands(const CLI::App& app);
/// All options of a command and of its option groups.
std::vector<const CLI::Option*> all_options(const CLI::App& command);

/// The program first, then its commands: the one table behind completion and man page.
std::vector<CommandText> command_table(const CLI::App& app);

/// A completion script for bash: commands, options, and the values of options that take those of a list;
/// elsewhere files. zsh reads it by bashcompinit.
std::string bash_completion(const CLI::App& app);

/// A man page for section 1 (troff, macros man): every command with every option.
std::string man_page(const CLI::App& app, const std::string& version);

}  // namespace dtof
