// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/kept_streams.hpp"

#include <utility>

namespace dtof {

KeptStreams::KeptStreams(const StreamSource& source, std::size_t most_bytes)
    : source_(source), most_bytes_(most_bytes), kept_(static_cast<std::size_t>(source.columns())) {}

ColumnStream KeptStreams::column(int index) const {
  return column_rows(index, {.first = 0, .count = rows()});
}

ColumnStream KeptStreams::column_rows(int index, RowRange rows) const {
  if (index < 0 || index >= columns()) {
    return source_.column_rows(index, rows);  // the source refuses it
  }
  Kept& kept = kept_[static_cast<std::size_t>(index)];
  const std::lock_guard lock(kept.mutex);
  if (kept.stream != nullptr && kept.rows == rows) {
    return *kept.stream;
  }
  ColumnStream drawn = source_.column_rows(index, rows);
  const std::size_t bytes = drawn.detection_count() * sizeof(Detection);
  if (kept.stream == nullptr) {
    if (bytes_.fetch_add(bytes) + bytes <= most_bytes_) {
      kept.stream = std::make_unique<const ColumnStream>(drawn);
      kept.rows = rows;
    } else {
      bytes_.fetch_sub(bytes);
    }
  }
  return drawn;
}

void KeptStreams::drop(int index) {
  Kept& kept = kept_.at(static_cast<std::size_t>(index));
  const std::lock_guard lock(kept.mutex);
  if (kept.stream != nullptr) {
    bytes_.fetch_sub(kept.stream->detection_count() * sizeof(Detection));
    kept.stream.reset();
  }
}

}  // namespace dtof
