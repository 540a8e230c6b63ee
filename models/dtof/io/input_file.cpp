// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/input_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "dtof/core/error.hpp"
#include "dtof/io/unpacked_file.hpp"

namespace dtof {
namespace {

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
  InputBytes file(path);
  std::string contents;
  if (std::error_code error; const auto size = std::filesystem::file_size(path, error)) {
    if (!error) {
      check_length(path, size, longest);
      contents.reserve(size);
    }
  }
  std::array<char, std::size_t{1} << 16U> chunk{};
  for (std::size_t count = chunk.size(); count == chunk.size();) {
    count = file.read(chunk);
    contents.append(chunk.data(), count);
    check_length(path, contents.size(), longest);
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
