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

struct gzFile_s;

namespace dtof {

/// A little-endian number of `bytes` from `offset` on, which they must have.
template <typename T>
T number_at(std::string_view bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little);
  T number{};
  std::memcpy(&number, &bytes[offset], sizeof number);
  return number;
}

/// A file, plain or gzip, that is read piece by piece from its beginning to its end, so that it may be longer
/// than memory. Every refusal is an InputError "<path>: <reason>".
class ByteStream {
 public:
  /// Refuses what read_file refuses: a missing or unreadable file, a directory, a device, an empty file.
  explicit ByteStream(std::filesystem::path path);
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  ByteStream(ByteStream&&) = delete;
  ByteStream& operator=(ByteStream&&) = delete;
  ~ByteStream();

  /// The next `size` bytes; refuses a file that ends before: "the file ends in <what>".
  std::string take(std::size_t size, std::string_view what);
  /// The next little-endian number; false where the file ends. Refuses a file that ends within the number.
  bool take_number(std::uint32_t& number, std::string_view what);

 private:
  bool refill();

  std::filesystem::path path_;
  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> file_;
  std::string buffer_;
  std::size_t next_ = 0;  ///< in `buffer_`
};

/// The first bytes of a file, unpacked, for finding out what it is; fewer, or none, where it does not have so
/// many or cannot be read, and for a pipe, which would lose them.
std::string file_start(const std::filesystem::path& path, std::size_t size);

}  // namespace dtof
