// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Cache around another source: draws each column's rows once and keeps the stream for later reads of the
/// same rows. Streams that exceed the memory limit are drawn again at each read. `source` must outlive this
/// object. Thread-safe.
class KeptStreams final : public StreamSource {
 public:
  explicit KeptStreams(const StreamSource& source, std::size_t most_bytes = kMostBytes);

  [[nodiscard]] int columns() const override { return source_.columns(); }
  [[nodiscard]] int rows() const override { return source_.rows(); }
  [[nodiscard]] std::uint32_t acquisitions() const override { return source_.acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override;
  [[nodiscard]] ColumnStream column_rows(int index, RowRange rows) const override;

  /// Frees the memory of a column's stream; the next read draws the stream again.
  void drop(int index);

  /// Default memory limit, bytes. A frame of 200 x 160 pixels and 3,333 acquisitions at 14 klux takes 0.4 GB.
  static constexpr std::size_t kMostBytes = std::size_t{1} << 30U;

 private:
  struct Kept {
    std::mutex mutex;
    std::unique_ptr<const ColumnStream> stream;
    RowRange rows;
  };

  const StreamSource& source_;
  std::size_t most_bytes_;
  mutable std::atomic<std::size_t> bytes_ = 0;
  mutable std::vector<Kept> kept_;
};

}  // namespace dtof
