// SPDX-License-Identifier: Apache-2.0
#include "command_line/shell_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "dtof/report/utf8.hpp"

namespace dtof {
namespace {

bool is_plain(unsigned char letter) {
  return std::isalnum(letter) != 0 ||
         std::string_view("-_./,:=+@%^").find(static_cast<char>(letter)) != std::string_view::npos;
}

/// Up to the first blank that shell_word did not quote.
std::size_t first_word_length(std::string_view command) {
  bool quoted = false;
  bool escapes = false;  ///< inside $'...'
  std::size_t at = 0;
  for (; at < command.size() && (quoted || command[at] != ' '); ++at) {
    if (command[at] == '\\' && (!quoted || escapes)) {
      ++at;
    } else if (command[at] == '\'') {
      escapes = !quoted && at > 0 && command[at - 1] == '$';
      quoted = !quoted;
    }
  }
  return std::min(at, command.size());
}

}  // namespace

std::string shell_word(std::string_view word) {
  if (!word.empty() && std::ranges::all_of(word, is_plain)) {
    return std::string(word);
  }
  const auto is_control = [](unsigned char letter) { return letter < ' ' || letter == 0x7F; };
  const bool shown = std::ranges::none_of(word, is_control) && as_utf8(word) == word;
  std::string result = shown ? "'" : "$'";
  for (const char letter : word) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == '\'') {
      result += shown ? R"('\'')" : R"(\')";
    } else if (!shown && letter == '\\') {
      result += R"(\\)";
    } else if (!shown && (is_control(byte) || byte >= 0x80)) {
      result += fmt::format("\\{:03o}", byte);
    } else {
      result += letter;
    }
  }
  return result + "'";
}

std::string shell_command(std::string_view program, std::span<const char* const> arguments) {
  std::string command(program);
  for (const char* argument : arguments) {
    command += " " + shell_word(argument);
  }
  return command;
}

std::string without_threads(std::string_view command) {
  std::string kept;
  bool value_follows = false;
  while (!command.empty()) {
    const std::size_t length = first_word_length(command);
    const std::string_view word = command.substr(0, length);
    command.remove_prefix(std::min(length + 1, command.size()));
    const bool alone = word == "--threads" || word == "-j";
    if (!alone && !value_follows && !word.starts_with("--threads=") && !word.starts_with("-j")) {
      kept += (kept.empty() ? "" : " ") + std::string(word);
    }
    value_follows = alone && !value_follows;
  }
  return kept;
}

}  // namespace dtof
