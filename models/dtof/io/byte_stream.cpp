// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/byte_stream.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18U;

gzFile open_stream(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    fail_in_file(path, "cannot read: it is a directory");
  }
  if (std::filesystem::is_character_file(path, error)) {
    fail_in_file(path, "cannot read: it is a device");
  }
  gzFile file = gzopen(path.c_str(), "rbe");
  if (file == nullptr) {
    fail_in_file(path, fmt::format("cannot read: {}", std::generic_category().message(errno)));
  }
  gzbuffer(file, kPiece);
  return file;
}

int close_nothing(gzFile_s* /*file*/) { return 0; }

}  // namespace

ByteStream::ByteStream(std::filesystem::path path)
    : path_(std::move(path)), file_(open_stream(path_), gzclose_r) {
  if (!refill()) {
    fail_in_file(path_, "the file is empty");
  }
}

ByteStream::ByteStream(std::filesystem::path path, std::string_view bytes)
    : path_(std::move(path)), file_(nullptr, close_nothing), rest_(bytes) {
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
  const int count = gzread(file_.get(), buffer_.data(), static_cast<unsigned>(buffer_.size()));
  int code = Z_OK;
  const char* const reason = gzerror(file_.get(), &code);
  if (count < 0 || (code != Z_OK && code != Z_STREAM_END)) {
    fail_in_file(path_, code == Z_ERRNO
                            ? fmt::format("cannot read: {}", std::generic_category().message(errno))
                        : code == Z_BUF_ERROR ? "damaged gzip data: the file ends early"
                                              : fmt::format("damaged gzip data: {}", reason));
  }
  buffer_.resize(static_cast<std::size_t>(count));
  return count > 0;
}

std::string file_start(const std::filesystem::path& path, std::size_t size) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return "";
  }
  const std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> file(gzopen(path.c_str(), "rbe"), gzclose_r);
  std::string start(size, '\0');
  const int count = file ? gzread(file.get(), start.data(), static_cast<unsigned>(size)) : 0;
  start.resize(static_cast<std::size_t>(std::max(count, 0)));
  return start;
}

}  // namespace dtof
