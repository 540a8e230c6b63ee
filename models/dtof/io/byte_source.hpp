// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace dtof {

/// Bytes that can be read at any place, and by several threads at the same time.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  ByteSource(ByteSource&&) = delete;
  ByteSource& operator=(ByteSource&&) = delete;
  virtual ~ByteSource() = default;

  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Reads the bytes from `offset` on and returns their number: fewer than asked for only where the source
  /// ends.
  virtual std::size_t read_at(std::uint64_t offset, std::span<char> bytes) const = 0;
};

/// Bytes in memory, which must outlive the object.
class HeldBytes final : public ByteSource {
 public:
  explicit HeldBytes(std::string_view bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  std::size_t read_at(std::uint64_t offset, std::span<char> bytes) const override;

 private:
  std::string_view bytes_;
};

/// A file of any length, read where it lies. Throws InputError "<path>: cannot read: <reason>".
class FileBytes final : public ByteSource {
 public:
  explicit FileBytes(std::filesystem::path path);
  ~FileBytes() override;
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  std::size_t read_at(std::uint64_t offset, std::span<char> bytes) const override;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// A sequence of bytes, read from its begin to its end, and at any place if it lies there unpacked.
class ByteSequence {
 public:
  ByteSequence() = default;
  ByteSequence(const ByteSequence&) = delete;
  ByteSequence& operator=(const ByteSequence&) = delete;
  ByteSequence(ByteSequence&&) = delete;
  ByteSequence& operator=(ByteSequence&&) = delete;
  virtual ~ByteSequence() = default;

  /// Number of bytes, as the file says.
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Reads the next bytes; size() must have so many left. With the last one the checksum is checked, if there
  /// is one. Throws InputError if the file has fewer bytes than it says, or wrong ones.
  virtual void next(std::span<char> bytes) = 0;
  /// True if `read_at` can be called.
  [[nodiscard]] virtual bool any_place() const = 0;
  /// Reads bytes at a place, by several threads at the same time. Checks no checksum.
  virtual void read_at(std::uint64_t offset, std::span<char> bytes) const = 0;
};

/// A part of a source: a whole file, or what an archive holds unpacked.
class PlainBytes final : public ByteSequence {
 public:
  /// `label` is for messages. `checksum`: CRC-32, as in ZIP; none: nothing is checked.
  PlainBytes(std::filesystem::path label, std::shared_ptr<const ByteSource> source, std::uint64_t begin,
             std::uint64_t size, std::optional<std::uint32_t> checksum);
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  void next(std::span<char> bytes) override;
  [[nodiscard]] bool any_place() const override { return true; }
  void read_at(std::uint64_t offset, std::span<char> bytes) const override;

 private:
  void refill();

  std::filesystem::path label_;
  std::shared_ptr<const ByteSource> source_;
  std::uint64_t begin_;
  std::uint64_t size_;
  std::optional<std::uint32_t> expected_;
  std::uint32_t checksum_ = 0;
  std::uint64_t fetched_ = 0;  ///< bytes that have come into `buffer_`
  std::vector<char> buffer_;
  std::size_t place_ = 0;  ///< next byte in `buffer_`
};

/// Continues a CRC-32, which begins with 0.
std::uint32_t crc_of(std::uint32_t crc, std::span<const char> bytes);

/// Throws InputError "<label>: ..." that the checksum is not the expected one.
[[noreturn]] void fail_checksum(const std::filesystem::path& label);

}  // namespace dtof
