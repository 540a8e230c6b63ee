// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dtof {

/// A place in a JSON file that knows its own path, so that every complaint names it.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string where) : value_(&value), where_(std::move(where)) {}

  /// Member of an object, element of an array; InputError where missing.
  [[nodiscard]] JsonNode operator[](const char* key) const;
  [[nodiscard]] JsonNode at(std::size_t index) const;
  /// Member of an object; none where missing or null.
  [[nodiscard]] std::optional<JsonNode> find(const char* key) const;
  /// Elements of an array; InputError when it is none.
  [[nodiscard]] std::size_t size() const;
  /// A finite number, or a string holding one.
  [[nodiscard]] double number() const;
  /// The same, or NaN where the value is null, not a number or infinite.
  [[nodiscard]] double number_or_unknown() const;
  /// 2 and 2.0 are the same integer.
  [[nodiscard]] std::int64_t integer() const;
  /// An array of `size` photon counts, each an integer in 0..2^32-1; 2 and 2.0 are the same.
  [[nodiscard]] std::vector<std::uint32_t> counts(std::size_t size) const;
  /// InputError unless this is an array of `size`.
  void expect_size(std::size_t size) const;
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  const nlohmann::json* value_;
  std::string where_;
};

/// Parses a JSON file, plain or gzip. Throws InputError "<path>: <reason>" with line and column. What JSON
/// does not have and some programs write all the same, NaN and Infinity, is read as null.
nlohmann::json read_json(const std::filesystem::path& path);

/// The same of text that `path` has already given.
nlohmann::json parse_json(const std::filesystem::path& path, std::string_view text);

}  // namespace dtof
