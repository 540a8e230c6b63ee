// SPDX-License-Identifier: Apache-2.0
#include "run/reproduction.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace dtof {
namespace {

/// The words of a command, still quoted. In '...' a backslash is a letter, elsewhere it hides the next one.
std::vector<std::string> quoted_words(std::string_view command) {
  enum class Quotes { kNone, kPlain, kEscaped };
  std::vector<std::string> words;
  Quotes quotes = Quotes::kNone;
  bool between = true;
  for (std::size_t at = 0; at < command.size(); ++at) {
    const char letter = command[at];
    if (quotes == Quotes::kNone && letter == ' ') {
      between = true;
      continue;
    }
    if (std::exchange(between, false)) {
      words.emplace_back();
    }
    if (letter == '\'' && quotes != Quotes::kNone) {
      quotes = Quotes::kNone;
    } else if (letter == '\'') {
      quotes = words.back().ends_with('$') ? Quotes::kEscaped : Quotes::kPlain;
    }
    words.back() += letter;
    if (letter == '\\' && quotes != Quotes::kPlain && at + 1 < command.size()) {
      words.back() += command[++at];
    }
  }
  return words;
}

}  // namespace

std::string without_options(std::string_view command, std::span<const std::string_view> names) {
  std::string rest;
  bool value_follows = false;
  for (const std::string& word : quoted_words(command)) {
    if (value_follows) {
      value_follows = false;
      continue;
    }
    value_follows = std::ranges::find(names, word) != names.end();
    const bool holds_value = std::ranges::any_of(names, [&](std::string_view name) {
      const bool is_long = name.starts_with("--");
      return is_long ? word.starts_with(std::string(name) + "=")
                     : word.starts_with(name) && !word.starts_with("--");
    });
    if (!value_follows && !holds_value) {
      rest += (rest.empty() ? "" : " ") + word;
    }
  }
  return rest;
}

}  // namespace dtof
