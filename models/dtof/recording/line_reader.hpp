// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace dtof {

class UnpackedFile;

/// Longest line that is read, in bytes.
inline constexpr std::size_t kLongestLine = std::size_t{1} << 20U;

/// Lines of a text, read piece by piece, so the text may be larger than memory. A leading byte order mark is
/// skipped. Every error is an InputError.
class LineReader {
 public:
  /// Reads a file, plain or gzip. Throws "<path>: <reason>" for a file that is missing, unreadable, a
  /// directory or a device.
  explicit LineReader(std::filesystem::path path);
  /// Reads text in memory, which must outlive the reader. `path` is for error messages.
  LineReader(std::filesystem::path path, std::string_view text);
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;
  LineReader(LineReader&&) = delete;
  LineReader& operator=(LineReader&&) = delete;
  ~LineReader();

  /// Reads the next line, without its end (LF or CRLF); false at the end of the text. The line is valid until
  /// the next call. Throws for a line above kLongestLine, and for damaged gzip data.
  bool next(std::string_view& line);
  /// True if the last line has no end: the text may stop within the line.
  [[nodiscard]] bool cut() const { return cut_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Throws InputError "<path>:<number of the last line>: <reason>".
  [[noreturn]] void fail(std::string_view reason) const;

 private:
  bool refill();

  std::filesystem::path path_;
  std::unique_ptr<UnpackedFile> file_;  ///< none: text in memory
  std::string buffer_;
  std::string_view rest_;  ///< unread part of `buffer_`, or of the text in memory
  std::size_t number_ = 0;
  bool cut_ = false;
};

}  // namespace dtof
