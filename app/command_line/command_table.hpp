// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace dtof {

/// Texts of an option for help, completion and man page.
struct OptionText {
  std::vector<std::string> names;  ///< "-r", "--readout"; a positional's name has no hyphens
  bool takes_value = false;
  std::string type;                 ///< "TEXT", "FLOAT"; empty for a flag
  std::string initial;              ///< default value, if known
  std::string description;          ///< one line
  std::vector<std::string> values;  ///< accepted values, if they are a list
  /// Read-outs, scenes or presets that are accepted beside other values.
  std::vector<std::string> names_among_values;
};

/// Texts of a command, or of the program itself.
struct CommandText {
  std::string name;
  std::string description;  ///< one line
  std::vector<OptionText> options;
};

/// All commands of a program.
std::vector<const CLI::App*> subcommands(const CLI::App& app);
/// All options of a command and of its option groups.
std::vector<const CLI::Option*> all_options(const CLI::App& command);

/// Texts of the program, then of its commands; completion and man page are made from this table.
std::vector<CommandText> command_table(const CLI::App& app);

/// A completion script for bash. It completes commands, options, and values of options with a list of values;
/// elsewhere file names. zsh reads it through bashcompinit.
std::string bash_completion(const CLI::App& app);

/// A man page for section 1 (troff, macros man): every command with every option.
std::string man_page(const CLI::App& app, const std::string& version);

}  // namespace dtof
