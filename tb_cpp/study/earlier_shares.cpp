// SPDX-License-Identifier: Apache-2.0
#include "study/earlier_shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "core/error.hpp"

namespace dtof {
namespace {

double as_number(const std::string& field, std::string_view column) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) {
    throw InputError(fmt::format("column {}: '{}' is no number", column, field));
  }
  return value;
}

}  // namespace

EarlierShares::EarlierShares(const std::filesystem::path& file)
    : table_(file), klux_(table_.column("klux")), scenes_(table_.texts("scene")) {
  const std::vector<std::string> estimators = table_.texts("estimator");
  estimator_ = estimators.front();
  const auto other =
      std::ranges::find_if(estimators, [&](const std::string& name) { return name != estimator_; });
  if (other != estimators.end()) {
    throw InputError(
        fmt::format("{}: one estimator is expected, not {} and {}", file.string(), estimator_, *other));
  }
}

std::optional<Estimate> EarlierShares::share(double klux, std::string_view scene,
                                             std::string_view column) const {
  for (std::size_t line = 0; line < scenes_.size(); ++line) {
    if (klux_[line] != klux || scenes_[line] != scene) {
      continue;
    }
    const auto field = [&](std::string_view suffix) {
      return table_.texts(fmt::format("{}{}", column, suffix))[line];
    };
    if (field("").empty()) {
      return std::nullopt;
    }
    const auto number = [&](std::string_view suffix) { return as_number(field(suffix), column); };
    return Estimate{.value = number(""), .interval = {number("_low"), number("_high")}};
  }
  return std::nullopt;
}

}  // namespace dtof
