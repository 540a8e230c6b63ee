// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/input_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
/// zlib's decompressor of gzip data.
class Inflater {
 public:
  Inflater() {
    constexpr int kGzip = 15 + 16;  // the largest window, and zlib's flag for gzip's header
    if (inflateInit2(&stream, kGzip) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  Inflater(Inflater&&) = delete;
  Inflater& operator=(Inflater&&) = delete;
  ~Inflater() { inflateEnd(&stream); }

  z_stream stream{};
};

constexpr std::string_view kGzipMagic = "\x1f\x8b";

void check_length(const std::filesystem::path& path, std::size_t bytes, std::size_t longest) {
  if (bytes > longest) {
    throw InputError(fmt::format("{}: more than {} MiB to read", path.string(), longest >> 20U));
  }
}

}  // namespace

void fail_in_file(const std::filesystem::path& path, std::string_view reason) {
  throw InputError(fmt::format("{}: {}", path.string(), with_visible_nul(reason)));
}

std::string read_file(const std::filesystem::path& path, std::size_t longest) {
  if (std::error_code error; std::filesystem::is_directory(path, error)) {
    throw InputError(fmt::format("{}: cannot read: it is a directory", path.string()));
  }
  if (std::error_code error; std::filesystem::is_character_file(path, error)) {
    throw InputError(fmt::format("{}: cannot read: it is a device", path.string()));
  }
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rbe"));
  if (!file) {
    throw InputError(
        fmt::format("{}: cannot read: {}", path.string(), std::generic_category().message(errno)));
  }
  std::string contents;
  if (std::error_code error; const auto size = std::filesystem::file_size(path, error)) {
    if (!error) {
      check_length(path, size, longest);
      contents.reserve(size);
    }
  }
  std::array<char, std::size_t{1} << 16U> chunk{};
  while (const std::size_t count = std::fread(chunk.data(), 1, chunk.size(), file.get())) {
    contents.append(chunk.data(), count);
    check_length(path, contents.size(), longest);
  }
  if (std::ferror(file.get()) != 0) {
    throw InputError(
        fmt::format("{}: cannot read: {}", path.string(), std::generic_category().message(errno)));
  }
  if (contents.empty()) {
    throw InputError(fmt::format("{}: the file is empty", path.string()));
  }
  return contents;
}

std::string read_file_or_gzip(const std::filesystem::path& path, std::size_t longest) {
  return unpack_gzip(path, read_file(path, longest), longest);
}

std::string unpack_gzip(const std::filesystem::path& path, std::string contents, std::size_t longest) {
  std::string_view rest(contents);
  if (!rest.starts_with(kGzipMagic)) {
    check_length(path, contents.size(), longest);
    return contents;
  }
  const auto fail = [&](const char* reason) {
    fail_in_file(path, fmt::format("damaged gzip data: {}", reason));
  };
  constexpr std::size_t kMostAtOnce = std::size_t{1} << 30U;  // zlib counts in 32 bits
  std::string unpacked;
  std::array<char, std::size_t{1} << 16U> chunk{};
  // Members may follow each other; what else stands behind the last one is no part of the data.
  while (rest.starts_with(kGzipMagic)) {
    Inflater inflater;
    z_stream& stream = inflater.stream;
    int code = Z_OK;
    while (code != Z_STREAM_END) {
      const std::size_t given = std::min(rest.size(), kMostAtOnce);
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast,cppcoreguidelines-pro-type-reinterpret-cast):
      // zlib's
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest.data()));
      stream.avail_in = static_cast<uInt>(given);
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's type
      stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
      stream.avail_out = static_cast<uInt>(chunk.size());
      code = inflate(&stream, Z_NO_FLUSH);
      rest.remove_prefix(given - stream.avail_in);
      const std::size_t count = chunk.size() - stream.avail_out;
      unpacked.append(chunk.data(), count);
      check_length(path, unpacked.size(), longest);
      if (code == Z_MEM_ERROR) {
        throw std::bad_alloc();
      }
      if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) {
        fail(stream.msg == nullptr ? "it cannot be unpacked" : stream.msg);
      }
      if (code != Z_STREAM_END && rest.empty() && count < chunk.size()) {
        fail("the file ends early");
      }
    }
  }
  return unpacked;
}

}  // namespace dtof
