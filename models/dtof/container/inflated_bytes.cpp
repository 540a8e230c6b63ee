// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/inflated_bytes.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <utility>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kInflatedPiece = std::size_t{1} << 18U;

}  // namespace

/// zlib's decompressor of deflated data without a header.
struct InflatedBytes::Stream {
  Stream() {
    constexpr int kNoHeader = -15;
    if (inflateInit2(&state, kNoHeader) != Z_OK) {
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

InflatedBytes::InflatedBytes(std::filesystem::path label, std::shared_ptr<const ByteSource> archive,
                             std::uint64_t begin, const ZipMember& member)
    : label_(std::move(label)),
      archive_(std::move(archive)),
      packed_at_(begin),
      packed_left_(member.packed_size),
      size_(member.size),
      expected_(member.checksum),
      stream_(std::make_unique<Stream>()) {}

InflatedBytes::~InflatedBytes() = default;

std::size_t InflatedBytes::unpack(std::span<char> bytes) {
  z_stream& stream = stream_->state;
  const std::size_t wanted = std::min(bytes.size(), kInflatedPiece);  // zlib counts in 32 bits
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's type
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(wanted);
  while (stream.avail_out != 0 && !ended_) {
    if (stream.avail_in == 0) {
      packed_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kInflatedPiece, packed_left_)));
      if (packed_.empty() || archive_->read_at(packed_at_, packed_) != packed_.size()) {
        fail_in_file(label_, "damaged: the packed data end early");
      }
      packed_at_ += packed_.size();
      packed_left_ -= packed_.size();
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's type
      stream.next_in = reinterpret_cast<Bytef*>(packed_.data());
      stream.avail_in = static_cast<uInt>(packed_.size());
    }
    const int code = inflate(&stream, Z_NO_FLUSH);
    if (code == Z_MEM_ERROR) {
      throw std::bad_alloc();
    }
    if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) {
      fail_in_file(label_,
                   fmt::format("damaged: {}", stream.msg == nullptr ? "it cannot be unpacked" : stream.msg));
    }
    ended_ = code == Z_STREAM_END;
  }
  return wanted - stream.avail_out;
}

void InflatedBytes::check_end() {
  std::array<char, 1> beyond{};
  if (unpack(beyond) != 0) {
    fail_in_file(label_,
                 fmt::format("damaged: it unpacks to more than the {} bytes that the archive says", size_));
  }
  if (checksum_ != expected_) {
    fail_checksum(label_);
  }
}

void InflatedBytes::next(std::span<char> bytes) {
  while (!bytes.empty()) {
    const std::size_t count = unpack(bytes);
    if (count == 0) {
      fail_in_file(label_, fmt::format("damaged: it unpacks to {} of the {} bytes that the archive says",
                                       done_, size_));
    }
    checksum_ = crc_of(checksum_, bytes.first(count));
    done_ += count;
    bytes = bytes.subspan(count);
    if (done_ == size_) {
      check_end();
    }
  }
}

void InflatedBytes::read_at(std::uint64_t /*offset*/, std::span<char> /*bytes*/) const {
  throw std::logic_error("packed bytes are read from their begin to their end");
}

}  // namespace dtof
