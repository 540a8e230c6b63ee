// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/byte_source.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPlainPiece = std::size_t{1} << 18U;

[[noreturn]] void fail_read(const std::filesystem::path& path) {
  fail_in_file(path, fmt::format("cannot read: {}", std::generic_category().message(errno)));
}

static_assert(sizeof(off_t) == 8, "offsets beyond 4 GiB");

}  // namespace

std::size_t HeldBytes::read_at(std::uint64_t offset, std::span<char> bytes) const {
  if (offset >= bytes_.size()) {
    return 0;
  }
  const std::string_view found = bytes_.substr(static_cast<std::size_t>(offset), bytes.size());
  std::ranges::copy(found, bytes.begin());
  return found.size();
}

FileBytes::FileBytes(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    fail_read(path_);
  }
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) {
    const int error = errno;
    ::close(descriptor_);
    errno = error;
    fail_read(path_);
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() { ::close(descriptor_); }

std::size_t FileBytes::read_at(std::uint64_t offset, std::span<char> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pread(descriptor_, &bytes[done], bytes.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail_read(path_);
    }
    if (count == 0) {
      break;
    }
    done += static_cast<std::size_t>(count);
  }
  return done;
}

PlainBytes::PlainBytes(std::filesystem::path label, std::shared_ptr<const ByteSource> source,
                       std::uint64_t begin, std::uint64_t size, std::optional<std::uint32_t> checksum)
    : label_(std::move(label)), source_(std::move(source)), begin_(begin), size_(size), expected_(checksum) {}

void PlainBytes::refill() {
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kPlainPiece, size_ - fetched_)));
  place_ = 0;
  read_at(fetched_, buffer_);
  fetched_ += buffer_.size();
  if (!expected_) {
    return;
  }
  checksum_ = crc_of(checksum_, buffer_);
  if (fetched_ == size_ && checksum_ != *expected_) {
    fail_checksum(label_);
  }
}

void PlainBytes::next(std::span<char> bytes) {
  while (!bytes.empty()) {
    if (place_ == buffer_.size()) {
      refill();
    }
    const std::size_t count = std::min(bytes.size(), buffer_.size() - place_);
    std::memcpy(bytes.data(), &buffer_[place_], count);
    place_ += count;
    bytes = bytes.subspan(count);
  }
}

void PlainBytes::read_at(std::uint64_t offset, std::span<char> bytes) const {
  if (source_->read_at(begin_ + offset, bytes) != bytes.size()) {
    fail_in_file(label_, "the file ends early");
  }
}

std::uint32_t crc_of(std::uint32_t crc, std::span<const char> bytes) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's type
  return static_cast<std::uint32_t>(
      ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void fail_checksum(const std::filesystem::path& label) {
  fail_in_file(label, "damaged: the checksum (CRC-32) is not that of the archive");
}

}  // namespace dtof
