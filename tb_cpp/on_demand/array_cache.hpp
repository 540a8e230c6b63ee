// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace dtof {

/// Files that took long to make, kept in a folder that programs share. An entry appears whole or not at all:
/// it is made in a folder of its own under a lock, and renamed. An entry whose bytes are not those that were
/// written is made anew.
class ArrayCache {
 public:
  /// Makes the file `kFile` in `folder`.
  using Make = std::function<void(const std::filesystem::path& folder)>;
  /// Says something to the user, a line.
  using Say = std::function<void(const std::string& line)>;

  static constexpr const char* kFile = "array.so";

  explicit ArrayCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// ${XDG_CACHE_HOME:-~/.cache}/dtof, or what DTOF_CACHE says; nothing if that is "off".
  static std::optional<ArrayCache> of_user();

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path entry(std::string_view key) const;

  /// The file of `key`, which names everything that it depends on; made if it is not there, is damaged, or
  /// `again`. Another program that makes the same entry is waited for. What `make` throws goes on, and
  /// nothing is left of the entry. Throws InputError if the folder cannot be used.
  [[nodiscard]] std::filesystem::path get(const std::string& key, const Make& make, const Say& say,
                                          bool again = false) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace dtof
