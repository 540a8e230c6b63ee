// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "dtof/container/zip_directory.hpp"
#include "dtof/io/byte_source.hpp"

namespace dtof {

/// A deflated member of a ZIP archive, unpacked by zlib from its begin to its end.
class InflatedBytes final : public ByteSequence {
 public:
  /// The packed bytes lie in `archive` from `begin` on. `label` is for messages.
  InflatedBytes(std::filesystem::path label, std::shared_ptr<const ByteSource> archive, std::uint64_t begin,
                const ZipMember& member);
  ~InflatedBytes() override;
  InflatedBytes(const InflatedBytes&) = delete;
  InflatedBytes& operator=(const InflatedBytes&) = delete;
  InflatedBytes(InflatedBytes&&) = delete;
  InflatedBytes& operator=(InflatedBytes&&) = delete;

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  /// Throws InputError also if the member unpacks to more or fewer bytes than the archive says.
  void next(std::span<char> bytes) override;
  [[nodiscard]] bool any_place() const override { return false; }
  /// Throws std::logic_error.
  void read_at(std::uint64_t offset, std::span<char> bytes) const override;

 private:
  struct Stream;
  /// Unpacks as many bytes as there are, at most `bytes`, and returns their number.
  std::size_t unpack(std::span<char> bytes);
  void check_end();

  std::filesystem::path label_;
  std::shared_ptr<const ByteSource> archive_;
  std::uint64_t packed_at_;
  std::uint64_t packed_left_;
  std::uint64_t size_;
  std::uint32_t expected_;
  std::uint32_t checksum_ = 0;
  std::uint64_t done_ = 0;
  bool ended_ = false;  ///< the packed data have said so
  std::vector<char> packed_;
  std::unique_ptr<Stream> stream_;
};

}  // namespace dtof
