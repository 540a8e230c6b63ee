// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace dtof {

/// Longest file that is read, and most that gzip data may unpack to: a few kilobytes of it can hold
/// terabytes.
inline constexpr std::size_t kLongestFile = std::size_t{1} << (sizeof(std::size_t) > 4 ? 32U : 31U);
inline constexpr std::size_t kLongestUnpacked = std::size_t{1} << 28U;

/// Throws InputError "<path>: <reason>".
[[noreturn]] void fail_in_file(const std::filesystem::path& path, std::string_view reason);

/// Whole contents of a file, which is read once from its beginning to its end, so that a pipe may take its
/// place. Throws InputError "<path>: <reason>" when it is missing, unreadable, a directory, a device, empty
/// or longer than `longest` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t longest = kLongestFile);

/// As `read_file`, and unpacks gzip (recognised by its first two bytes). Throws also when the gzip data is
/// damaged or ends early, or when file or unpacked data are longer than `longest` bytes.
std::string read_file_or_gzip(const std::filesystem::path& path, std::size_t longest = kLongestUnpacked);

/// The same of contents that `path` has already given; others than gzip stay as they are.
std::string unpack_gzip(const std::filesystem::path& path, std::string contents,
                        std::size_t longest = kLongestUnpacked);

/// Text without the byte order mark of UTF-8 in front of it, which some editors write.
constexpr std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

}  // namespace dtof
