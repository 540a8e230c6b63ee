// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <new>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/output_error.hpp"

namespace dtof {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 20U;

std::string errno_text() { return std::generic_category().message(errno); }

/// mkstemp makes files private; the target gets the permissions a plain open would have given it.
mode_t default_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return static_cast<mode_t>(S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH) & ~mask;
}

/// Where links lead whose last one names no file yet.
std::filesystem::path end_of_links(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as Linux has it
  std::error_code error;
  for (int links = 0; links < kMostLinks && std::filesystem::is_symlink(path, error); ++links) {
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    path = path.parent_path() / next;  // which is `next` if that is absolute
  }
  return path;
}

}  // namespace

struct AtomicFile::Packer {
  Packer() {
    constexpr int kGzip = 15 + 16;  // the largest window, and zlib's flag for gzip's header
    constexpr int kMemory = 8;      // zlib's default
    if (deflateInit2(&state, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;
  Packer(Packer&&) = delete;
  Packer& operator=(Packer&&) = delete;
  ~Packer() { deflateEnd(&state); }

  z_stream state{};
};

AtomicFile::AtomicFile(std::filesystem::path target, Packing packing)
    : target_(std::move(target)),
      final_(target_),
      packer_(packing == Packing::kGzip ? std::make_unique<Packer>() : nullptr) {
  std::error_code error;
  const auto status = std::filesystem::status(target_, error);
  if (error == std::errc::too_many_symbolic_link_levels) {
    fail(error.message());
  }
  if (std::filesystem::is_directory(status)) {
    fail("it is a directory");
  }
  if (std::filesystem::exists(status)) {
    if (!std::filesystem::is_regular_file(status)) {
      descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
      if (descriptor_ < 0) {
        fail(errno_text());
      }
      return;
    }
    if (::access(target_.c_str(), W_OK) != 0) {
      fail(errno_text());
    }
    final_ = std::filesystem::canonical(target_);
  } else {
    final_ = end_of_links(target_);
  }
  std::string name = (final_.parent_path() / fmt::format(".{}.XXXXXX", final_.filename().string())).string();
  descriptor_ = ::mkstemp(name.data());
  if (descriptor_ < 0) {
    fail(errno_text());
  }
  temporary_ = name;
}

AtomicFile::~AtomicFile() { close_and_remove(); }

void AtomicFile::append(std::string_view bytes) {
  if (packer_) {
    pack(bytes, false);
  } else {
    buffer_.append(bytes);
  }
  if (buffer_.size() >= kBufferSize) {
    flush();
  }
}

void AtomicFile::pack(std::string_view bytes, bool last) {
  z_stream& stream = packer_->state;
  std::array<Bytef, std::size_t{1} << 14U> packed{};
  do {
    const std::size_t given = std::min(bytes.size(), kBufferSize);  // zlib counts in 32 bits
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast,cppcoreguidelines-pro-type-reinterpret-cast):
    // zlib's
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(given);
    do {
      stream.next_out = packed.data();
      stream.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH);
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's type
      buffer_.append(reinterpret_cast<const char*>(packed.data()), packed.size() - stream.avail_out);
    } while (stream.avail_out == 0);
    bytes.remove_prefix(given);
  } while (!bytes.empty());
}

void AtomicFile::commit() {
  if (packer_) {
    pack("", true);
  }
  flush();
  if (!temporary_.empty() && ::fchmod(descriptor_, default_mode()) != 0) {
    fail(errno_text());
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    fail(errno_text());
  }
  if (!temporary_.empty()) {
    if (::rename(temporary_.c_str(), final_.c_str()) != 0) {
      fail(errno_text());
    }
    temporary_.clear();
  }
}

void AtomicFile::fail(const std::string& reason) const {
  throw OutputError(fmt::format("{}: cannot write: {}", target_.string(), reason));
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    check_interruption();
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      fail(errno_text());
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AtomicFile::close_and_remove() noexcept {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
  }
}

void write_file(const std::filesystem::path& target, std::string_view contents) {
  AtomicFile file(target);
  file.append(contents);
  file.commit();
}

void write_gzip_file(const std::filesystem::path& target, std::string_view contents) {
  constexpr int kGzip = 15 + 16;  // the largest window, and zlib's flag for gzip's header
  constexpr int kMemory = 8;      // zlib's default
  z_stream stream = {};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw InputError(fmt::format("{}: cannot compress", target.string()));
  }
  std::string compressed(deflateBound(&stream, static_cast<uLong>(contents.size())), '\0');
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast,cppcoreguidelines-pro-type-reinterpret-cast): zlib's
  // types
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(contents.data()));
  stream.avail_in = static_cast<uInt>(contents.size());
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's type
  stream.next_out = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_out = static_cast<uInt>(compressed.size());
  const int outcome = deflate(&stream, Z_FINISH);
  compressed.resize(stream.total_out);
  deflateEnd(&stream);
  if (outcome != Z_STREAM_END) {
    throw InputError(fmt::format("{}: cannot compress", target.string()));
  }
  write_file(target, compressed);
}

}  // namespace dtof
