// SPDX-License-Identifier: Apache-2.0
// Writes ZIP archives byte by byte, also wrong ones and long ones with holes.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace dtof::test {

template <typename T>
std::string bytes_of(T number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// An NPY file of format 1.0 without its elements.
inline std::string npy_begin(const std::string& dtype, const std::string& shape, bool fortran = false) {
  const std::string text = "{'descr': '" + dtype + "', 'fortran_order': " + (fortran ? "True" : "False") +
                           ", 'shape': " + shape + ", }\n";
  return "\x93NUMPY" + std::string("\x01\x00", 2) + bytes_of(static_cast<std::uint16_t>(text.size())) + text;
}

inline std::uint32_t crc_of_text(std::string_view text, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

/// CRC-32 of so many zeros.
inline std::uint32_t crc_of_zeros(std::uint64_t count) {
  std::uint32_t all = 0;
  std::uint32_t some = crc_of_text(std::string_view("\0", 1));
  for (std::uint64_t length = 1; length <= count; length *= 2) {
    if ((count & length) != 0) {
      all = static_cast<std::uint32_t>(::crc32_combine(all, some, static_cast<z_off_t>(length)));
    }
    some = static_cast<std::uint32_t>(::crc32_combine(some, some, static_cast<z_off_t>(length)));
  }
  return all;
}

/// `text` as ZIP deflates it.
inline std::string deflated(std::string_view text) {
  z_stream stream{};
  ::deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
  std::string packed(::deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  ::deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  ::deflateEnd(&stream);
  return packed;
}

struct ZipPart {
  std::string name;
  std::string begin;        ///< bytes in the archive
  std::uint64_t zeros = 0;  ///< a hole behind them
  std::string end = {};
  std::uint32_t crc = 0;
  std::uint64_t size = 0;  ///< unpacked
  std::uint16_t method = 0;
  std::uint16_t flags = 0;
};

/// A stored member with its checksum.
inline ZipPart stored_part(const std::string& name, const std::string& begin, std::uint64_t zeros = 0,
                           const std::string& end = "") {
  const auto crc = static_cast<std::uint32_t>(
      ::crc32_combine(crc_of_text(begin), crc_of_zeros(zeros), static_cast<z_off_t>(zeros)));
  return {.name = name,
          .begin = begin,
          .zeros = zeros,
          .end = end,
          .crc = crc_of_text(end, crc),
          .size = begin.size() + zeros + end.size()};
}

inline ZipPart deflated_part(const std::string& name, const std::string& contents) {
  return {.name = name,
          .begin = deflated(contents),
          .crc = crc_of_text(contents),
          .size = contents.size(),
          .method = 8};
}

/// Writes the archive. With `zip64` all sizes and places have 64 bits, else they must have room in 32.
inline void write_zip(const std::filesystem::path& path, const std::vector<ZipPart>& parts, bool zip64) {
  std::ofstream file(path, std::ios::binary);
  const auto small = [&](std::uint64_t number) {
    return bytes_of(zip64 ? 0xFFFF'FFFFU : static_cast<std::uint32_t>(number));
  };
  std::string directory;
  std::uint64_t at = 0;
  for (const ZipPart& part : parts) {
    const std::uint64_t packed = part.begin.size() + part.zeros + part.end.size();
    const std::string sizes = bytes_of(part.size) + bytes_of(packed);
    const auto extra = [&](const std::string& numbers) {
      return zip64
                 ? bytes_of(std::uint16_t{1}) + bytes_of(static_cast<std::uint16_t>(numbers.size())) + numbers
                 : "";
    };
    const std::string middle = bytes_of(std::uint16_t{45}) + bytes_of(part.flags) + bytes_of(part.method) +
                               bytes_of(std::uint32_t{0x21'0000}) + bytes_of(part.crc) + small(packed) +
                               small(part.size) + bytes_of(static_cast<std::uint16_t>(part.name.size()));
    const std::string local = "PK\x03\x04" + middle +
                              bytes_of(static_cast<std::uint16_t>(extra(sizes).size())) + part.name +
                              extra(sizes);
    const std::string all = extra(sizes + bytes_of(at));
    directory += "PK\x01\x02" + bytes_of(std::uint16_t{45}) + middle +
                 bytes_of(static_cast<std::uint16_t>(all.size())) + std::string(10, '\0') + small(at) +
                 part.name + all;
    file.seekp(static_cast<std::streamoff>(at));
    file << local << part.begin;
    file.seekp(static_cast<std::streamoff>(part.zeros), std::ios::cur);
    file << part.end;
    at += local.size() + packed;
  }
  file.seekp(static_cast<std::streamoff>(at));
  file << directory;
  const std::uint64_t count = parts.size();
  if (zip64) {
    file << "PK\x06\x06" << bytes_of(std::uint64_t{44}) << bytes_of(std::uint32_t{0x2d002d})
         << bytes_of(std::uint64_t{0}) << bytes_of(count) << bytes_of(count)
         << bytes_of(std::uint64_t{directory.size()}) << bytes_of(at);
    file << "PK\x06\x07" << bytes_of(std::uint32_t{0}) << bytes_of(at + directory.size())
         << bytes_of(std::uint32_t{1});
  }
  const std::string number = bytes_of(zip64 ? std::uint16_t{0xFFFF} : static_cast<std::uint16_t>(count));
  file << "PK\x05\x06" << bytes_of(std::uint32_t{0}) << number << number << small(directory.size())
       << small(at) << bytes_of(std::uint16_t{0});
}

}  // namespace dtof::test
