// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/json_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

/// Whether a number without a fraction, which may be written with one (2.0).
bool is_integer(const nlohmann::json& value) {
  constexpr double kLargest = 0x1.0p53;
  if (!value.is_number_float()) {
    return value.is_number_integer();
  }
  const auto number = value.get<double>();
  return number == std::floor(number) && std::abs(number) <= kLargest;
}

/// Python's json and others write NaN, Infinity and -Infinity, which JSON does not have: null takes their
/// place. Text without them stays as it is.
std::string with_null_for_no_number(std::string_view text) {
  constexpr std::array<std::string_view, 3> kNoNumbers = {"NaN", "-Infinity", "Infinity"};
  std::string result;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size();) {
    if (!quoted && (text[i] == 'N' || text[i] == 'I' || text[i] == '-')) {
      const auto found = std::ranges::find_if(
          kNoNumbers, [&](std::string_view word) { return text.substr(i).starts_with(word); });
      if (found != kNoNumbers.end()) {
        result += "null";
        i += found->size();
        continue;
      }
    }
    if (quoted && text[i] == '\\' && i + 1 < text.size()) {
      result += text[i++];
    } else if (text[i] == '"') {
      quoted = !quoted;
    }
    result += text[i++];
  }
  return result;
}

}  // namespace

JsonNode JsonNode::operator[](const char* key) const {
  if (!value_->is_object() || !value_->contains(key)) {
    fail(fmt::format("\"{}\" is missing", key));
  }
  return {(*value_)[key], fmt::format("{}.{}", where_, key)};
}

std::optional<JsonNode> JsonNode::find(const char* key) const {
  if (!value_->is_object() || !value_->contains(key) || (*value_)[key].is_null()) {
    return std::nullopt;
  }
  return (*this)[key];
}

JsonNode JsonNode::at(std::size_t index) const {
  if (index >= size()) {
    fail(fmt::format("element {} is missing", index));
  }
  return {(*value_)[index], fmt::format("{}[{}]", where_, index)};
}

std::size_t JsonNode::size() const {
  if (!value_->is_array()) {
    fail("not an array");
  }
  return value_->size();
}

double JsonNode::number() const {
  const double result = value_->is_null() ? std::numeric_limits<double>::quiet_NaN() : number_or_unknown();
  if (!std::isfinite(result)) {
    fail("not a finite number");
  }
  return result;
}

double JsonNode::number_or_unknown() const {
  double result = std::numeric_limits<double>::quiet_NaN();
  if (value_->is_number()) {
    result = value_->get<double>();
  } else if (value_->is_string()) {
    const auto& text = value_->get_ref<const std::string&>();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(fmt::format("\"{}\" is not a number", text));
    }
  } else if (!value_->is_null()) {
    fail("not a number");
  }
  return std::isfinite(result) ? result : std::numeric_limits<double>::quiet_NaN();
}

std::int64_t JsonNode::integer() const {
  if (!is_integer(*value_)) {
    fail("not an integer");
  }
  return value_->get<std::int64_t>();
}

std::vector<std::uint32_t> JsonNode::counts(std::size_t size) const {
  expect_size(size);
  std::vector<std::uint32_t> result;
  result.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    const nlohmann::json& element = (*value_)[i];
    // Every integer up to 2^53 is a double.
    const double count = is_integer(element) ? element.get<double>() : -1.0;
    if (count < 0.0 || count > std::numeric_limits<std::uint32_t>::max()) {
      // An array or object may be nested deeper than the stack.
      at(i).fail(fmt::format("{} is not a photon count (0..2^32-1)",
                             element.is_structured() ? element.type_name() : element.dump()));
    }
    result.push_back(static_cast<std::uint32_t>(count));
  }
  return result;
}

void JsonNode::expect_size(std::size_t size_wanted) const {
  if (size() != size_wanted) {
    fail(fmt::format("{} elements instead of {}", size(), size_wanted));
  }
}

void JsonNode::fail(const std::string& reason) const {
  throw InputError(fmt::format("{}: {}", where_, reason));
}

nlohmann::json read_json(const std::filesystem::path& path) {
  return parse_json(path, read_file_or_gzip(path));
}

nlohmann::json parse_json(const std::filesystem::path& path, std::string_view text) {
  text = without_byte_order_mark(text);
  std::string replaced;
  if (text.find("NaN") != std::string_view::npos || text.find("Infinity") != std::string_view::npos) {
    replaced = with_null_for_no_number(text);
    text = replaced;
  }
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::exception& error) {  // malformed, or a number beyond a double
    // "[json.exception.parse_error.101] parse error at line 1, column 3: ...": the tag says nothing to a
    // user.
    const std::string message = error.what();
    const std::size_t tag_end = message.find("] ");
    throw InputError(fmt::format("{}: {}", path.string(),
                                 tag_end == std::string::npos ? message : message.substr(tag_end + 2)));
  }
}

}  // namespace dtof
