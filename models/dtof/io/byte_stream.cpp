// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/byte_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/unpacked_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18U;

}  // namespace

ByteStream::ByteStream(std::filesystem::path path)
    : path_(std::move(path)), file_(std::make_unique<UnpackedFile>(path_)) {
  if (!refill()) {
    fail_in_file(path_, "the file is empty");
  }
}

ByteStream::ByteStream(std::filesystem::path path, std::string_view bytes)
    : path_(std::move(path)), rest_(bytes) {
  if (!refill()) {
    fail_in_file(path_, "the file is empty");
  }
}

ByteStream::~ByteStream() = default;

std::string ByteStream::take(std::size_t size, std::string_view what) {
  std::string bytes;
  while (bytes.size() < size) {
    if (next_ == buffer_.size() && !refill()) {
      fail_in_file(path_, fmt::format("the file ends in {}", what));
    }
    const std::size_t count = std::min(size - bytes.size(), buffer_.size() - next_);
    bytes.append(buffer_, next_, count);
    next_ += count;
  }
  return bytes;
}

bool ByteStream::take_number(std::uint32_t& number, std::string_view what, std::uint64_t index) {
  if (buffer_.size() - next_ < sizeof number) {
    if (next_ == buffer_.size() && !refill()) {
      return false;
    }
    number = number_at<std::uint32_t>(take(sizeof number, fmt::format("{} {}", what, index)), 0);
    return true;
  }
  number = number_at<std::uint32_t>(buffer_, next_);
  next_ += sizeof number;
  return true;
}

bool ByteStream::refill() {
  if (!file_) {
    buffer_ = rest_.substr(0, kPiece);
    rest_.remove_prefix(buffer_.size());
    next_ = 0;
    return !buffer_.empty();
  }
  buffer_.resize(kPiece);
  next_ = 0;
  buffer_.resize(file_->read(buffer_));
  return !buffer_.empty();
}

std::string file_start(const std::filesystem::path& path, std::size_t size) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return "";
  }
  try {
    UnpackedFile file(path);
    std::string start(size, '\0');
    start.resize(file.read(start));
    return start;
  } catch (const InputError&) {  // whoever reads the file says why
    return "";
  }
}

}  // namespace dtof
