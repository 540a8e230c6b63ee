// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/unpacked_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include "dtof/core/progress.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPackedPiece = std::size_t{1} << 18U;
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30U;  // zlib counts in 32 bits
constexpr std::string_view kGzipMagic = "\x1f\x8b";

[[noreturn]] void fail_to_read(const std::filesystem::path& path) {
  fail_in_file(path, fmt::format("cannot read: {}", std::generic_category().message(errno)));
}

int open_input(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    fail_in_file(path, "cannot read: it is a directory");
  }
  if (std::filesystem::is_character_file(path, error)) {
    fail_in_file(path, "cannot read: it is a device");
  }
  int descriptor = -1;
  do {
    check_interruption();
    descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);  // waits for the other end of a pipe
  } while (descriptor < 0 && errno == EINTR);
  if (descriptor < 0) {
    fail_to_read(path);
  }
  return descriptor;
}

}  // namespace

struct GzipUnpacker::Stream {
  Stream() {
    constexpr int kGzip = 15 + 16;  // the largest window, and zlib's flag for gzip's header
    if (inflateInit2(&state, kGzip) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  Stream(Stream&&) = delete;
  Stream& operator=(Stream&&) = delete;
  ~Stream() { inflateEnd(&state); }

  z_stream state{};
};

GzipUnpacker::GzipUnpacker(std::filesystem::path path)
    : path_(std::move(path)), stream_(std::make_unique<Stream>()) {}

GzipUnpacker::~GzipUnpacker() = default;

void GzipUnpacker::fail(std::string_view reason) const {
  fail_in_file(path_, fmt::format("damaged gzip data: {}", reason));
}

std::size_t GzipUnpacker::unpack(std::string_view& packed, std::span<char> bytes) {
  z_stream& stream = stream_->state;
  std::size_t done = 0;
  while (done < bytes.size() && (inside_ || !packed.empty())) {
    if (!inside_ && has_member_ && packed.front() != kGzipMagic.front()) {
      fail("other bytes follow");
    }
    const std::size_t given = std::min(packed.size(), kMostAtOnce);
    const std::size_t wanted = std::min(bytes.size() - done, kMostAtOnce);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast,cppcoreguidelines-pro-type-reinterpret-cast):
    // zlib's
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(given);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's type
    stream.next_out = reinterpret_cast<Bytef*>(&bytes[done]);
    stream.avail_out = static_cast<uInt>(wanted);
    const int code = inflate(&stream, Z_NO_FLUSH);
    packed.remove_prefix(given - stream.avail_in);
    done += wanted - stream.avail_out;
    inside_ = true;
    if (code == Z_STREAM_END) {
      inside_ = false;
      has_member_ = true;
      inflateReset(&stream);
    } else if (code == Z_BUF_ERROR) {  // all is taken
      break;
    } else if (code == Z_MEM_ERROR) {
      throw std::bad_alloc();
    } else if (code != Z_OK) {
      const bool in_magic = stream.total_out == 0 && stream.total_in <= kGzipMagic.size();
      fail(has_member_ && in_magic ? "other bytes follow"
           : stream.msg == nullptr ? "it cannot be unpacked"
                                   : stream.msg);
    }
  }
  return done;
}

void GzipUnpacker::finish() const {
  if (inside_ || !has_member_) {
    fail("the file ends early");
  }
}

bool is_gzip(std::string_view start) { return start.starts_with(kGzipMagic); }

InputBytes::InputBytes(std::filesystem::path path) : path_(std::move(path)), descriptor_(open_input(path_)) {}

InputBytes::~InputBytes() { ::close(descriptor_); }

std::size_t InputBytes::read(std::span<char> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {  // a pipe gives fewer bytes than it is asked for
    check_interruption();
    const ssize_t count = ::read(descriptor_, &bytes[done], bytes.size() - done);
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail_to_read(path_);
    }
    if (count == 0) {
      break;
    }
    done += static_cast<std::size_t>(count);
  }
  return done;
}

UnpackedFile::UnpackedFile(std::filesystem::path path) : file_(path) {
  refill();
  if (is_gzip(rest_)) {
    unpacker_ = std::make_unique<GzipUnpacker>(std::move(path));
  }
}

std::size_t UnpackedFile::read(std::span<char> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (unpacker_) {
      done += unpacker_->unpack(rest_, bytes.subspan(done));
    } else {
      const std::size_t count = std::min(bytes.size() - done, rest_.size());
      std::memcpy(&bytes[done], rest_.data(), count);
      rest_.remove_prefix(count);
      done += count;
    }
    if (done < bytes.size()) {
      refill();
      if (rest_.empty()) {
        if (unpacker_) {
          unpacker_->finish();
        }
        break;
      }
    }
  }
  return done;
}

void UnpackedFile::refill() {
  buffer_.resize(kPackedPiece);
  buffer_.resize(file_.read(buffer_));
  rest_ = buffer_;
}

}  // namespace dtof
