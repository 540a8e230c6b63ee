// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string_view>
#include <system_error>

#include "dtof/core/error.hpp"
#include "dtof/io/unpacked_file.hpp"

namespace dtof {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

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
  if (!is_gzip(rest)) {
    check_length(path, contents.size(), longest);
    return contents;
  }
  std::string unpacked;
  std::array<char, std::size_t{1} << 16U> chunk{};
  GzipUnpacker unpacker(path);
  for (std::size_t count = chunk.size(); count == chunk.size();) {
    count = unpacker.unpack(rest, chunk);
    unpacked.append(chunk.data(), count);
    check_length(path, unpacked.size(), longest);
  }
  unpacker.finish();
  return unpacked;
}

}  // namespace dtof
