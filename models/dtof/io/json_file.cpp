// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/json_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {

JsonNode JsonNode::operator[](const char* key) const {
  if (!value_->is_object() || !value_->contains(key)) {
    fail(fmt::format("\"{}\" is missing", key));
  }
  return {(*value_)[key], fmt::format("{}.{}", where_, key)};
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
  double result = std::numeric_limits<double>::quiet_NaN();
  if (value_->is_number()) {
    result = value_->get<double>();
  } else if (value_->is_string()) {
    const auto& text = value_->get_ref<const std::string&>();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(fmt::format("\"{}\" is not a number", text));
    }
  }
  if (!std::isfinite(result)) {
    fail("not a finite number");
  }
  return result;
}

std::int64_t JsonNode::integer() const {
  if (!value_->is_number_integer()) {
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
    if (!element.is_number_unsigned() ||
        element.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
      // An array or object may be nested deeper than the stack.
      at(i).fail(fmt::format("{} is not a photon count (0..2^32-1)",
                             element.is_structured() ? element.type_name() : element.dump()));
    }
    result.push_back(element.get<std::uint32_t>());
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
  const std::string text = read_file_or_gzip(path);
  try {
    return nlohmann::json::parse(text);
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
