// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/npy_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

/// Elements that are decoded at once.
constexpr std::size_t kElementsAtOnce = std::size_t{1} << 16U;

}  // namespace

/// What the constructor reads before its members are there.
struct NpyReader::Opened {
  std::unique_ptr<ByteSequence> bytes;
  NpyHeader header;

  static Opened open(const std::filesystem::path& label, std::unique_ptr<ByteSequence> bytes) {
    const auto add = [&](std::string& begin, std::uint64_t size) {
      const std::size_t old = begin.size();
      begin.resize(static_cast<std::size_t>(std::min(size, bytes->size())));
      bytes->next(std::span(begin).subspan(old));
    };
    std::string begin;
    add(begin, NpyHeader::kPreamble);
    const std::uint64_t length = NpyHeader::length(label, begin);
    if (length > bytes->size()) {
      fail_in_file(label, "the NPY header ends early");
    }
    if (length > NpyHeader::kLongest) {
      fail_in_file(label, fmt::format("the NPY header has more than {} MiB", NpyHeader::kLongest >> 20U));
    }
    if (length > begin.size()) {  // else it holds no text that could be read
      add(begin, length);
    }
    NpyHeader header(label, begin, bytes->size());
    return {.bytes = std::move(bytes), .header = std::move(header)};
  }
};

NpyReader::NpyReader(std::filesystem::path label, std::unique_ptr<ByteSequence> bytes)
    : NpyReader(label, Opened::open(label, std::move(bytes))) {}

NpyReader::NpyReader(std::filesystem::path label, Opened opened)
    : ArrayReader(opened.header.shape()),
      label_(std::move(label)),
      bytes_(std::move(opened.bytes)),
      header_(std::move(opened.header)) {}

void NpyReader::hold_reordered() {
  if (count() > kMostHeldElements) {
    fail_in_file(label_, fmt::format("shape ({}) in Fortran order holds more than 2^27 elements; "
                                     "numpy.ascontiguousarray makes C order of it, which has no limit",
                                     fmt::join(shape(), ", ")));
  }
  std::vector<double> values(count());
  // Beyond 2^53 the message names the place in C order, which only the reordered elements have.
  raw_.resize(kElementsAtOnce * header_.element_bytes());
  for (std::size_t done = 0; done < values.size();) {
    const std::size_t now = std::min(kElementsAtOnce, values.size() - done);
    const std::span<char> raw = std::span(raw_).first(now * header_.element_bytes());
    bytes_->next(raw);
    header_.decode_unchecked({raw.data(), raw.size()}, std::span(values).subspan(done, now));
    done += now;
  }
  std::vector<double> ordered = c_order_of_reversed(values, shape());
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    header_.check(label_, ordered[i], i);
  }
  reordered_ = std::make_unique<HeldArray>(NpyArray{.shape = shape(), .values = std::move(ordered)});
}

void NpyReader::next(std::span<double> values) {
  if (!header_.in_c_order()) {
    if (!reordered_) {
      hold_reordered();
    }
    reordered_->next(values);
    return;
  }
  while (!values.empty()) {
    const std::size_t now = std::min(kElementsAtOnce, values.size());
    raw_.resize(now * header_.element_bytes());
    bytes_->next(raw_);
    header_.decode(label_, {raw_.data(), raw_.size()}, next_, values.first(now));
    next_ += now;
    values = values.subspan(now);
  }
}

bool NpyReader::any_place() const { return header_.in_c_order() && bytes_->any_place(); }

void NpyReader::read_at(std::size_t first, std::span<double> values) const {
  std::vector<char> raw;
  while (!values.empty()) {
    const std::size_t now = std::min(kElementsAtOnce, values.size());
    raw.resize(now * header_.element_bytes());
    bytes_->read_at(header_.data_begin() + std::uint64_t{first} * header_.element_bytes(), raw);
    header_.decode(label_, {raw.data(), raw.size()}, first, values.first(now));
    first += now;
    values = values.subspan(now);
  }
}

std::unique_ptr<ArrayReader> open_npy(const std::filesystem::path& path) {
  auto file = std::make_shared<const FileBytes>(path);
  const std::uint64_t size = file->size();
  return std::make_unique<NpyReader>(
      path, std::make_unique<PlainBytes>(path, std::move(file), 0, size, std::nullopt));
}

}  // namespace dtof
