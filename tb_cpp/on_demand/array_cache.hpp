// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace dtof {

/// Cache of files that take long to make, in a folder that programs share. An entry appears whole or not at
/// all: it is made under a lock in a folder of its own, and then renamed. An entry whose bytes changed since
/// they were written is made again.
class ArrayCache {
 public:
  /// Function that makes the file `kFile` in `folder`.
  using Make = std::function<void(const std::filesystem::path& folder)>;
  /// Function that shows a line to the user.
  using Say = std::function<void(const std::string& line)>;

  static constexpr const char* kFile = "array.so";

  explicit ArrayCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Cache of the user: ${XDG_CACHE_HOME:-~/.cache}/dtof, or the folder in DTOF_CACHE; none if DTOF_CACHE is
  /// "off".
  static std::optional<ArrayCache> of_user();

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path entry(std::string_view key) const;

  /// File of `key`, which must name everything that the file depends on. It is made if it is missing or
  /// damaged, or with `again`. Waits if another program is making it. Exceptions of `make` are rethrown and
  /// leave no entry. Throws InputError if the folder cannot be used.
  [[nodiscard]] std::filesystem::path get(const std::string& key, const Make& make, const Say& say,
                                          bool again = false) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace dtof
