// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace dtof {

/// Unpacks gzip data that come in pieces. Members may follow each other; other bytes behind a member are
/// refused. Every error is an InputError "<path>: damaged gzip data: <reason>".
class GzipUnpacker {
 public:
  explicit GzipUnpacker(std::filesystem::path path);
  GzipUnpacker(const GzipUnpacker&) = delete;
  GzipUnpacker& operator=(const GzipUnpacker&) = delete;
  GzipUnpacker(GzipUnpacker&&) = delete;
  GzipUnpacker& operator=(GzipUnpacker&&) = delete;
  ~GzipUnpacker();

  /// Unpacks from `packed`, which loses the bytes that are taken. Returns how many bytes came out: fewer than
  /// `bytes` has only if all of `packed` is taken.
  std::size_t unpack(std::string_view& packed, std::span<char> bytes);
  /// Throws if the data end within a member.
  void finish() const;

 private:
  struct Stream;

  [[noreturn]] void fail(std::string_view reason) const;

  std::filesystem::path path_;
  std::unique_ptr<Stream> stream_;
  bool inside_ = false;      ///< of a member
  bool has_member_ = false;  ///< a whole one
};

/// True for data that begin as gzip does.
bool is_gzip(std::string_view start);

/// The bytes of a file, read once from beginning to end, so it may be a pipe. Throws InputError
/// "<path>: cannot read: <reason>" for a file that is missing, unreadable, a directory or a device, and
/// Interrupted for a signal, also while it waits.
class InputBytes {
 public:
  explicit InputBytes(std::filesystem::path path);
  InputBytes(const InputBytes&) = delete;
  InputBytes& operator=(const InputBytes&) = delete;
  InputBytes(InputBytes&&) = delete;
  InputBytes& operator=(InputBytes&&) = delete;
  ~InputBytes();

  /// Returns the number of bytes that it read: fewer than `bytes` has only at the end of the file.
  std::size_t read(std::span<char> bytes);

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// A file, plain or gzip, read once from beginning to end, so it may be larger than memory or a pipe. Throws
/// as InputBytes, and InputError for damaged gzip data.
class UnpackedFile {
 public:
  explicit UnpackedFile(std::filesystem::path path);
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;
  UnpackedFile(UnpackedFile&&) = delete;
  UnpackedFile& operator=(UnpackedFile&&) = delete;
  ~UnpackedFile() = default;

  /// Returns the number of bytes that it read: fewer than `bytes` has only at the end of the file.
  std::size_t read(std::span<char> bytes);

 private:
  /// `rest_` is empty.
  void refill();

  InputBytes file_;
  std::string buffer_;
  std::string_view rest_;  ///< of `buffer_`
  std::unique_ptr<GzipUnpacker> unpacker_;
};

}  // namespace dtof
