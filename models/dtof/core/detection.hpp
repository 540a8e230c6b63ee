// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace dtof {

/// TDC code, 0 .. 2^NP - 1; the all-ones code means "no detection" (spec section 2).
using Timestamp = std::uint16_t;

/// One timestamp that a TDC delivered in one acquisition.
struct Detection {
  std::uint32_t acquisition;  ///< 0 .. ACQ_NUM - 1
  Timestamp timestamp;        ///< 0 .. 2^NP - 1

  bool operator==(const Detection&) const = default;
};

/// Allocator that leaves new elements uninitialised; ColumnStream writes its rows in place.
template <typename T>
class UnwrittenAllocator : public std::allocator<T> {
 public:
  template <typename U>
  // NOLINTNEXTLINE(readability-identifier-naming): the standard's name
  struct rebind {
    using other = UnwrittenAllocator<U>;
  };
  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// All detections of one column over one frame, pixel (row) by pixel.
///
/// Within a pixel detections are sorted by acquisition; detections of one acquisition stand in slot
/// order and are at most SLOTS. Empty slots are not stored.
class ColumnStream {
 public:
  /// Appends the next row; `detections` must be sorted by acquisition.
  void append_row(std::span<const Detection> detections) {
    const std::size_t begin = detections_.size();
    detections_.resize(begin + detections.size());
    std::copy(detections.begin(), detections.end(), detections_.begin() + static_cast<std::ptrdiff_t>(begin));
    row_end_.push_back(detections_.size());
  }
  /// Reserves memory for `detections` in all rows together.
  void reserve(std::size_t detections) { detections_.reserve(detections); }
  /// Returns space for up to `most` detections of the next row; write from its beginning. `finish_row(count)`
  /// then keeps the first `count`.
  std::span<Detection> next_row(std::size_t most) {
    const std::size_t begin = row_end_.empty() ? 0 : row_end_.back();
    detections_.resize(begin + most);
    return std::span<Detection>(detections_).subspan(begin);
  }
  void finish_row(std::size_t count) {
    detections_.resize((row_end_.empty() ? 0 : row_end_.back()) + count);
    finish_row();
  }
  /// Appends one detection to the current row; `finish_row` closes the row.
  void append(Detection detection) { detections_.push_back(detection); }
  void finish_row() { row_end_.push_back(detections_.size()); }

  [[nodiscard]] int rows() const { return static_cast<int>(row_end_.size()); }
  [[nodiscard]] std::span<const Detection> row(int index) const {
    const auto i = static_cast<std::size_t>(index);
    const std::size_t begin = i == 0 ? 0 : row_end_[i - 1];
    return std::span<const Detection>(detections_).subspan(begin, row_end_[i] - begin);
  }
  [[nodiscard]] std::size_t detection_count() const { return detections_.size(); }
  void clear() {
    detections_.clear();
    row_end_.clear();
  }

  bool operator==(const ColumnStream&) const = default;

 private:
  std::vector<Detection, UnwrittenAllocator<Detection>> detections_;
  std::vector<std::size_t> row_end_;
};

/// Returns `stream` without its first `acquisitions`; the numbers of the others fall by as much.
ColumnStream without_first(const ColumnStream& stream, std::uint32_t acquisitions);

/// A range of neighbouring rows: first .. first + count - 1.
struct RowRange {
  int first = 0;  ///< >= 0
  int count = 0;  ///< >= 0

  bool operator==(const RowRange&) const = default;
};

/// Returns the stream of column `column`. Callers ask for each column once, from left to right. The stream is
/// valid until the next call, so a reader needs memory for one column only.
using ColumnReader = std::function<const ColumnStream&(int column)>;

/// Returns a reader over columns that are already in memory. The columns must outlive the reader.
inline ColumnReader reader_of(std::span<const ColumnStream> columns) {
  return [columns](int column) -> const ColumnStream& { return columns[static_cast<std::size_t>(column)]; };
}

/// Source of a frame's TDC stream. Any column can be made alone and from any thread.
class StreamSource {
 public:
  StreamSource() = default;
  StreamSource(const StreamSource&) = default;
  StreamSource& operator=(const StreamSource&) = default;
  StreamSource(StreamSource&&) = default;
  StreamSource& operator=(StreamSource&&) = default;
  virtual ~StreamSource() = default;

  [[nodiscard]] virtual int columns() const = 0;
  [[nodiscard]] virtual int rows() const = 0;
  [[nodiscard]] virtual std::uint32_t acquisitions() const = 0;
  /// Returns the stream of column `index` (0 .. columns() - 1) with rows() rows. Thread-safe.
  [[nodiscard]] virtual ColumnStream column(int index) const = 0;
  /// Returns the same detections for `rows` alone (within 0 .. rows() - 1); row 0 of the result is row
  /// `rows.first`. Thread-safe. This default makes the whole column; sources of photons draw the needed ones
  /// only. Throws InputError if `column` lacks one of the rows.
  [[nodiscard]] virtual ColumnStream column_rows(int index, RowRange rows) const;
};

}  // namespace dtof
