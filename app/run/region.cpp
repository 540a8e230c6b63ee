// SPDX-License-Identifier: Apache-2.0
#include "run/region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <numeric>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

/// An option that names columns or rows, for its error messages.
struct Naming {
  std::string_view unit;  ///< column, row
  std::string_view text;  ///< what the user wrote
  int size = 0;           ///< legal are 0 .. size - 1

  [[nodiscard]] InputError error(std::string_view reason) const {
    return InputError{fmt::format("--{}s '{}': {}", unit, text, reason)};
  }
};

struct Interval {
  int first;
  int last;
};

int parse_number(std::string_view part, const Naming& naming) {
  int value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc{} || end != part.data() + part.size() || value < 0) {
    throw naming.error(fmt::format("'{}' is not a {} number", part, naming.unit));
  }
  return value;
}

/// "7" or "3-9".
Interval parse_interval(std::string_view part, const Naming& naming) {
  const std::size_t dash = part.find('-');
  const int first = parse_number(part.substr(0, dash), naming);
  const int last = dash == std::string_view::npos ? first : parse_number(part.substr(dash + 1), naming);
  if (last < first) {
    throw naming.error(fmt::format("range '{}' runs backwards", part));
  }
  if (last >= naming.size) {
    throw naming.error(fmt::format("{} {} is outside 0 to {}", naming.unit, last, naming.size - 1));
  }
  return {first, last};
}

}  // namespace

std::vector<int> parse_columns(std::string_view text, int columns) {
  std::vector<int> chosen;
  if (text == "all") {
    chosen.resize(static_cast<std::size_t>(columns));
    std::iota(chosen.begin(), chosen.end(), 0);
    return chosen;
  }
  const Naming naming{.unit = "column", .text = text, .size = columns};
  std::vector<bool> taken(static_cast<std::size_t>(columns), false);
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    const Interval interval = parse_interval(rest.substr(0, comma), naming);
    for (int column = interval.first; column <= interval.last; ++column) {
      if (taken[static_cast<std::size_t>(column)]) {
        throw naming.error(fmt::format("column {} is named twice", column));
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

RowRange parse_rows(std::string_view text, int rows) {
  if (text == "all") {
    return {.first = 0, .count = rows};
  }
  const Naming naming{.unit = "row", .text = text, .size = rows};
  if (text.find(',') != std::string_view::npos) {
    throw naming.error("rows are one range, such as 40-79");
  }
  const Interval interval = parse_interval(text, naming);
  return {.first = interval.first, .count = interval.last - interval.first + 1};
}

std::vector<ResultRecord> result_records(std::span<const PixelResult> results, const Region& region) {
  const std::size_t width = region.columns.size();
  std::vector<ResultRecord> records;
  records.reserve(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    records.push_back(
        {region.columns[i % width], region.rows.first + static_cast<int>(i / width), results[i]});
  }
  return records;
}

}  // namespace dtof
