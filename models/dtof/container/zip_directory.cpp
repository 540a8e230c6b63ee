// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/zip_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "dtof/container/inflated_bytes.hpp"
#include "dtof/io/byte_stream.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

/// An archive of tiny members would take long to list.
constexpr std::uint64_t kMostMembers = 65536;
constexpr std::uint64_t kLongestDirectory = std::uint64_t{1} << 26U;
constexpr std::uint32_t kIn64Bits = 0xFFFF'FFFF;  // the number is in the ZIP64 record
constexpr std::uint16_t kIn64BitsToo = 0xFFFF;

[[noreturn]] void fail_damaged(const std::filesystem::path& path) {
  fail_in_file(path, "the NPZ archive is damaged or encrypted");
}

std::string bytes_at(const std::filesystem::path& path, const ByteSource& archive, std::uint64_t offset,
                     std::uint64_t size) {
  if (offset > archive.size() || size > archive.size() - offset) {
    fail_damaged(path);
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (archive.read_at(offset, bytes) != bytes.size()) {
    fail_damaged(path);
  }
  return bytes;
}

/// Where the central directory lies.
struct DirectoryPlace {
  std::uint64_t members = 0;
  std::uint64_t size = 0;
  std::uint64_t begin = 0;
};

/// The ZIP64 record, which an archive has whose numbers need 64 bits; none without.
std::optional<DirectoryPlace> place_in_64_bits(const std::filesystem::path& path, const ByteSource& archive,
                                               std::uint64_t end_record_at) {
  constexpr std::uint64_t kLocatorSize = 20;
  constexpr std::uint64_t kRecordSize = 56;
  if (end_record_at < kLocatorSize) {
    return std::nullopt;
  }
  const std::string locator = bytes_at(path, archive, end_record_at - kLocatorSize, kLocatorSize);
  if (!locator.starts_with("PK\x06\x07")) {
    return std::nullopt;
  }
  const std::string record = bytes_at(path, archive, number_at<std::uint64_t>(locator, 8), kRecordSize);
  if (!record.starts_with("PK\x06\x06")) {
    fail_damaged(path);
  }
  return DirectoryPlace{.members = number_at<std::uint64_t>(record, 32),
                        .size = number_at<std::uint64_t>(record, 40),
                        .begin = number_at<std::uint64_t>(record, 48)};
}

DirectoryPlace find_directory(const std::filesystem::path& path, const ByteSource& archive) {
  constexpr std::uint64_t kRecordSize = 22;
  constexpr std::uint64_t kLongestComment = 65535;
  const std::uint64_t tail_size = std::min(archive.size(), kRecordSize + kLongestComment);
  const std::uint64_t tail_at = archive.size() - tail_size;
  const std::string tail = bytes_at(path, archive, tail_at, tail_size);
  for (std::size_t at = tail.rfind("PK\x05\x06"); at != std::string::npos;
       at = at == 0 ? std::string::npos : tail.rfind("PK\x05\x06", at - 1)) {
    if (tail.size() - at < kRecordSize ||
        tail.size() - at - kRecordSize < number_at<std::uint16_t>(tail, at + 20)) {
      continue;  // such bytes within the comment
    }
    DirectoryPlace place{.members = number_at<std::uint16_t>(tail, at + 10),
                         .size = number_at<std::uint32_t>(tail, at + 12),
                         .begin = number_at<std::uint32_t>(tail, at + 16)};
    if (place.members == kIn64BitsToo || place.size == kIn64Bits || place.begin == kIn64Bits) {
      place = place_in_64_bits(path, archive, tail_at + at).value_or(place);
    }
    if (place.members > kMostMembers || place.size > kLongestDirectory) {
      fail_damaged(path);
    }
    return place;
  }
  fail_damaged(path);
}

/// Takes from the ZIP64 field the numbers that have no room in the entry; they stand in this order.
void take_64_bits(const std::filesystem::path& path, std::string_view extra, ZipMember& member) {
  constexpr std::uint16_t kZip64 = 1;
  constexpr std::size_t kFieldHeader = 4;
  while (extra.size() >= kFieldHeader) {
    const auto id = number_at<std::uint16_t>(extra, 0);
    const std::size_t size = number_at<std::uint16_t>(extra, 2);
    extra.remove_prefix(kFieldHeader);
    if (size > extra.size()) {
      break;
    }
    std::string_view field = extra.substr(0, size);
    extra.remove_prefix(size);
    if (id != kZip64) {
      continue;
    }
    for (std::uint64_t* const number : {&member.size, &member.packed_size, &member.local_header_at}) {
      if (*number != kIn64Bits) {
        continue;
      }
      if (field.size() < sizeof *number) {
        fail_damaged(path);
      }
      *number = number_at<std::uint64_t>(field, 0);
      field.remove_prefix(sizeof *number);
    }
    return;
  }
}

/// Takes the next entry of the directory from `entries`.
ZipMember take_member(const std::filesystem::path& path, std::string_view& entries) {
  constexpr std::size_t kEntrySize = 46;
  if (entries.size() < kEntrySize || !entries.starts_with("PK\x01\x02")) {
    fail_damaged(path);
  }
  const std::size_t name = number_at<std::uint16_t>(entries, 28);
  const std::size_t extra = number_at<std::uint16_t>(entries, 30);
  const std::size_t comment = number_at<std::uint16_t>(entries, 32);
  if (entries.size() - kEntrySize < name + extra + comment) {
    fail_damaged(path);
  }
  ZipMember member{.name = std::string(entries.substr(kEntrySize, name)),
                   .method = number_at<std::uint16_t>(entries, 10),
                   .encrypted = (number_at<std::uint16_t>(entries, 8) & 1U) != 0,
                   .checksum = number_at<std::uint32_t>(entries, 16),
                   .packed_size = number_at<std::uint32_t>(entries, 20),
                   .size = number_at<std::uint32_t>(entries, 24),
                   .local_header_at = number_at<std::uint32_t>(entries, 42)};
  take_64_bits(path, entries.substr(kEntrySize + name, extra), member);
  entries.remove_prefix(kEntrySize + name + extra + comment);
  return member;
}

/// The place of the member's bytes.
std::uint64_t data_begin(const std::filesystem::path& label, const ByteSource& archive,
                         const ZipMember& member) {
  constexpr std::uint64_t kLocalHeader = 30;
  const std::string header = bytes_at(label, archive, member.local_header_at, kLocalHeader);
  if (!header.starts_with("PK\x03\x04")) {
    fail_damaged(label);
  }
  const std::uint64_t begin = member.local_header_at + kLocalHeader + number_at<std::uint16_t>(header, 26) +
                              number_at<std::uint16_t>(header, 28);
  if (begin > archive.size() || member.packed_size > archive.size() - begin) {
    fail_in_file(label, fmt::format("{} bytes are more than the archive holds", member.packed_size));
  }
  return begin;
}

}  // namespace

std::vector<ZipMember> read_zip_directory(const std::filesystem::path& path, const ByteSource& archive) {
  const DirectoryPlace place = find_directory(path, archive);
  const std::string directory = bytes_at(path, archive, place.begin, place.size);
  std::vector<ZipMember> members;
  std::string_view entries(directory);
  for (std::uint64_t i = 0; i < place.members; ++i) {
    ZipMember member = take_member(path, entries);
    if (!member.name.ends_with('/')) {
      members.push_back(std::move(member));
    }
  }
  std::ranges::stable_sort(members, {}, &ZipMember::local_header_at);
  return members;
}

std::unique_ptr<ByteSequence> open_zip_member(const std::filesystem::path& label,
                                              std::shared_ptr<const ByteSource> archive,
                                              const ZipMember& member) {
  constexpr std::uint16_t kStored = 0;
  constexpr std::uint16_t kDeflated = 8;
  if (member.encrypted) {
    fail_damaged(label);
  }
  if (member.method != kStored && member.method != kDeflated) {
    fail_in_file(
        label, fmt::format("packed by ZIP's method {}, which is neither stored nor deflated", member.method));
  }
  const std::uint64_t begin = data_begin(label, *archive, member);
  if (member.method == kDeflated) {
    return std::make_unique<InflatedBytes>(label, std::move(archive), begin, member);
  }
  if (member.size != member.packed_size) {
    fail_in_file(label, fmt::format("stored, but of {} bytes in the archive and {} outside",
                                    member.packed_size, member.size));
  }
  return std::make_unique<PlainBytes>(label, std::move(archive), begin, member.size, member.checksum);
}

}  // namespace dtof
