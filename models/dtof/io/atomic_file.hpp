// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace dtof {

/// Output file that appears whole or not at all. Data goes to a temporary file beside the target, which
/// `commit` renames. Without `commit` (e.g. after an exception) the temporary file is deleted and an older
/// target stays unchanged. A target that is not a regular file (/dev/stdout, a pipe) is written directly.
/// What is appended may be packed with gzip on its way. Every failure throws OutputError "<path>: cannot
/// write: <reason>".
class AtomicFile {
 public:
  enum class Packing { kPlain, kGzip };

  explicit AtomicFile(std::filesystem::path target, Packing packing = Packing::kPlain);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  void append(std::string_view bytes);
  void commit();

 private:
  struct Packer;

  [[noreturn]] void fail(const std::string& reason) const;
  void pack(std::string_view bytes, bool last);
  void flush();
  void close_and_remove() noexcept;

  std::filesystem::path target_;     ///< as the user gave it, for error messages
  std::filesystem::path final_;      ///< symbolic links resolved, so that a link stays a link
  std::filesystem::path temporary_;  ///< empty if the target is written directly
  int descriptor_ = -1;
  std::string buffer_;
  std::unique_ptr<Packer> packer_;  ///< none: plain
};

/// Writes `contents` as an AtomicFile.
void write_file(const std::filesystem::path& target, std::string_view contents);

/// Writes `contents` as a gzip AtomicFile; equal contents give equal files.
void write_gzip_file(const std::filesystem::path& target, std::string_view contents);

}  // namespace dtof
