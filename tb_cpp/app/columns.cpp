// SPDX-License-Identifier: Apache-2.0
#include "app/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.hpp"

namespace dtof {
namespace {

int parse_column(std::string_view text, std::string_view list) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < 0) {
    throw InputError(fmt::format("--columns '{}': '{}' is not a column number", list, text));
  }
  return value;
}

}  // namespace

std::vector<int> parse_columns(std::string_view text, int columns) {
  std::vector<int> chosen;
  if (text == "all") {
    return chosen;
  }
  std::vector<bool> taken(static_cast<std::size_t>(columns), false);
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    const std::string_view part = rest.substr(0, comma);
    const std::size_t dash = part.find('-');
    const int first = parse_column(part.substr(0, dash), text);
    const int last = dash == std::string_view::npos ? first : parse_column(part.substr(dash + 1), text);
    if (last < first) {
      throw InputError(fmt::format("--columns '{}': range '{}' runs backwards", text, part));
    }
    if (last >= columns) {
      throw InputError(fmt::format("--columns '{}': column {} is outside 0 to {}", text, last, columns - 1));
    }
    for (int column = first; column <= last; ++column) {
      if (taken[static_cast<std::size_t>(column)]) {
        throw InputError(fmt::format("--columns '{}': column {} is named twice", text, column));
      }
      taken[static_cast<std::size_t>(column)] = true;
      chosen.push_back(column);
    }
    more = comma != std::string_view::npos;
    rest.remove_prefix(more ? comma + 1 : 0);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace dtof
