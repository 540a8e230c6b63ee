// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace dtof {

/// Output file that appears whole or not at all: written to a temporary file beside the target, which
/// `commit` renames. Without `commit` (an exception) nothing is left behind and an older target stays as it
/// was. A target that is not a regular file (/dev/stdout, a pipe) is written directly. Every failure is an
/// InputError "<path>: cannot write: <reason>".
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  void append(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(const std::string& reason) const;
  void flush();
  void close_and_remove() noexcept;

  std::filesystem::path target_;     ///< as the user gave it, for messages
  std::filesystem::path final_;      ///< symbolic links resolved, so that a link stays a link
  std::filesystem::path temporary_;  ///< empty when the target is written directly
  int descriptor_ = -1;
  std::string buffer_;
};

/// `contents` as one AtomicFile.
void write_file(const std::filesystem::path& target, std::string_view contents);

/// The same as gzip; equal contents give equal files.
void write_gzip_file(const std::filesystem::path& target, std::string_view contents);

}  // namespace dtof
