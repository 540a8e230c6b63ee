// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace dtof {

class UnpackedFile;

/// Little-endian number at `offset`. `bytes` must hold the whole number.
template <typename T>
T number_at(std::string_view bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little);
  T number{};
  std::memcpy(&number, &bytes[offset], sizeof number);
  return number;
}

/// A file, plain or gzip, read piece by piece from beginning to end, so it may be larger than memory. Every
/// error is an InputError "<path>: <reason>".
class ByteStream {
 public:
  /// Throws as read_file does: for a missing or unreadable file, a directory, a device or an empty file.
  explicit ByteStream(std::filesystem::path path);
  /// Reads bytes in memory, unpacked, which must outlive the stream. `path` is for error messages.
  ByteStream(std::filesystem::path path, std::string_view bytes);
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  ByteStream(ByteStream&&) = delete;
  ByteStream& operator=(ByteStream&&) = delete;
  ~ByteStream();

  /// Returns the next `size` bytes. Throws "the file ends in <what>" if fewer are left.
  std::string take(std::size_t size, std::string_view what);
  /// Reads the next little-endian number; false at the end of the file. Throws "the file ends in <what>
  /// <index>" if the file ends within the number.
  bool take_number(std::uint32_t& number, std::string_view what, std::uint64_t index);

 private:
  bool refill();

  std::filesystem::path path_;
  std::unique_ptr<UnpackedFile> file_;  ///< none: bytes in memory
  std::string buffer_;
  std::string_view rest_;  ///< bytes in memory that are not in `buffer_` yet
  std::size_t next_ = 0;   ///< next byte in `buffer_`
};

/// First bytes of a file, unpacked, to recognise its format. Returns fewer or no bytes if the file is shorter
/// or cannot be read. Returns none for a pipe, whose bytes would be lost.
std::string file_start(const std::filesystem::path& path, std::size_t size);

}  // namespace dtof
