// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace dtof {

/// Header of an NPY file: what its elements are, and where they begin.
class NpyHeader {
 public:
  /// Bytes that say how long the header is.
  static constexpr std::size_t kPreamble = 12;
  /// Longest header that is read; NumPy's own have some hundred bytes.
  static constexpr std::uint64_t kLongest = std::uint64_t{1} << 20U;

  /// Bytes from the file's begin to its elements, by the file's first `kPreamble` bytes (fewer in a shorter
  /// file). Throws InputError "<path>: <reason>" if they begin no NPY file of format 1.0, 2.0 or 3.0.
  static std::uint64_t length(const std::filesystem::path& path, std::string_view start);

  /// Parses `begin`, which must hold the bytes up to the elements. `file_bytes` is the size of the whole
  /// file. Throws InputError for a header that cannot be read, an unknown dtype, an empty array, and a file
  /// that is longer or shorter than its shape says.
  NpyHeader(const std::filesystem::path& path, std::string_view begin, std::uint64_t file_bytes);

  [[nodiscard]] const std::vector<std::size_t>& shape() const { return shape_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::uint64_t data_begin() const { return data_begin_; }
  [[nodiscard]] std::size_t element_bytes() const { return element_bytes_; }
  /// True if the elements lie in C order; so do those of a Fortran array that has one axis.
  [[nodiscard]] bool in_c_order() const;

  /// The elements of `bytes` in the order in which they lie there. `first` is the number in C order of the
  /// first one, for messages. Throws InputError for an integer beyond +-2^53.
  void decode(const std::filesystem::path& path, std::string_view bytes, std::size_t first,
              std::span<double> values) const;
  void decode_unchecked(std::string_view bytes, std::span<double> values) const;
  /// Throws as `decode` does, for the element of this number in C order.
  void check(const std::filesystem::path& path, double value, std::size_t index) const;

 private:
  std::vector<std::size_t> shape_;
  std::size_t count_ = 1;
  std::uint64_t data_begin_ = 0;
  double (*read_)(const char*, bool) = nullptr;
  std::size_t element_bytes_ = 1;
  bool integer_ = false;
  bool big_endian_ = false;
  bool fortran_ = false;
};

}  // namespace dtof
