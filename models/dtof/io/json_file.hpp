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

/// A node of a JSON file. It stores its own path, which every error text names.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string where) : value_(&value), where_(std::move(where)) {}

  /// Member of an object, or element of an array. Throws InputError if missing.
  [[nodiscard]] JsonNode operator[](const char* key) const;
  [[nodiscard]] JsonNode at(std::size_t index) const;
  /// Member of an object; none if missing or null.
  [[nodiscard]] std::optional<JsonNode> find(const char* key) const;
  /// Number of elements. Throws InputError if the node is no array.
  [[nodiscard]] std::size_t size() const;
  /// A finite number, or a string that holds one. Throws InputError otherwise.
  [[nodiscard]] double number() const;
  /// As number(), but NaN if the value is null, not a number or infinite.
  [[nodiscard]] double number_or_unknown() const;
  /// An integer; 2.0 counts as 2. Throws InputError otherwise.
  [[nodiscard]] std::int64_t integer() const;
  /// An array of `size` photon counts, each an integer in 0 .. 2^32-1; 2.0 counts as 2. Throws InputError
  /// otherwise.
  [[nodiscard]] std::vector<std::uint32_t> counts(std::size_t size) const;
  /// Throws InputError unless the node is an array of `size` elements.
  void expect_size(std::size_t size) const;
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  const nlohmann::json* value_;
  std::string where_;
};

/// Parses a JSON file, plain or gzip. NaN and Infinity, which are not JSON but occur, are read as null.
/// Throws InputError "<path>: <reason>" with line and column.
nlohmann::json read_json(const std::filesystem::path& path);

/// Parses text that was read from `path`, as read_json does.
nlohmann::json parse_json(const std::filesystem::path& path, std::string_view text);

}  // namespace dtof
