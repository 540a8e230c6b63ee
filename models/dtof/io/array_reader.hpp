// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "dtof/io/npy.hpp"

namespace dtof {

/// An array that is read piece by piece, in C order and as doubles, so that it may be larger than memory.
class ArrayReader {
 public:
  ArrayReader(const ArrayReader&) = delete;
  ArrayReader& operator=(const ArrayReader&) = delete;
  ArrayReader(ArrayReader&&) = delete;
  ArrayReader& operator=(ArrayReader&&) = delete;
  virtual ~ArrayReader() = default;

  [[nodiscard]] const std::vector<std::size_t>& shape() const { return shape_; }
  /// Product of the shape.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Reads the next elements; so many must be left. Throws InputError "<path>: <reason>" for a file that is
  /// damaged. A checksum has been checked once the last element is read.
  virtual void next(std::span<double> values) = 0;
  /// True if `read_at` can be called.
  [[nodiscard]] virtual bool any_place() const = 0;
  /// Reads elements from number `first` on, by several threads at the same time; checks no checksum.
  virtual void read_at(std::size_t first, std::span<double> values) const = 0;

 protected:
  explicit ArrayReader(std::vector<std::size_t> shape);

 private:
  std::vector<std::size_t> shape_;
  std::size_t count_;
};

/// An array that is held.
class HeldArray final : public ArrayReader {
 public:
  explicit HeldArray(NpyArray array);
  void next(std::span<double> values) override;
  [[nodiscard]] bool any_place() const override { return true; }
  void read_at(std::size_t first, std::span<double> values) const override;

 private:
  std::vector<double> values_;
  std::size_t next_ = 0;
};

/// Reads the whole array from its begin. Throws InputError "<path>: ..." for more than 2^27 elements.
NpyArray read_whole(const std::filesystem::path& path, ArrayReader& array);

/// Calls `take` with all elements from the begin, piece by piece.
void for_each_piece(ArrayReader& array, const std::function<void(std::span<const double>)>& take);

/// Writes the array as write_npy does, piece by piece.
void write_npy(const std::filesystem::path& path, ArrayReader& array);

}  // namespace dtof
