// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace dtof {

/// Longest file that is read, and most bytes that gzip data may unpack to. A few kilobytes of gzip can hold
/// terabytes.
inline constexpr std::size_t kLongestFile = std::size_t{1} << (sizeof(std::size_t) > 4 ? 32U : 31U);
inline constexpr std::size_t kLongestUnpacked = std::size_t{1} << 28U;

/// Throws InputError "<path>: <reason>".
[[noreturn]] void fail_in_file(const std::filesystem::path& path, std::string_view reason);

/// Returns the whole contents of a file. The file is read once from beginning to end, so it may be a pipe.
/// Throws InputError "<path>: <reason>" if it is missing, unreadable, a directory, a device, empty or longer
/// than `longest` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t longest = kLongestFile);

/// Reads as `read_file` and unpacks gzip, recognised by its first two bytes. Throws also if the gzip data is
/// damaged, ends early or has other bytes behind its end, or if file or unpacked data exceed `longest` bytes.
std::string read_file_or_gzip(const std::filesystem::path& path, std::size_t longest = kLongestUnpacked);

/// Unpacks `contents` of `path` if they are gzip; other contents are returned unchanged.
std::string unpack_gzip(const std::filesystem::path& path, std::string contents,
                        std::size_t longest = kLongestUnpacked);

/// The text of a file for a message, which a NUL byte would end: "\0" for each.
inline std::string with_visible_nul(std::string_view text) {
  std::string visible;
  for (const char letter : text) {
    visible += letter == '\0' ? "\\0" : std::string(1, letter);
  }
  return visible;
}

/// Text without a leading UTF-8 byte order mark.
constexpr std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

}  // namespace dtof
