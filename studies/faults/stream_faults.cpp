// SPDX-License-Identifier: Apache-2.0
#include "faults/stream_faults.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace dtof {
namespace {

ColumnStream with_row(const ColumnStream& column, int row, std::span<const Detection> detections) {
  ColumnStream changed;
  for (int i = 0; i < column.rows(); ++i) {
    changed.append_row(i == row ? detections : column.row(i));
  }
  return changed;
}

}  // namespace

ColumnStream with_stuck_timestamps(const ColumnStream& column, std::uint32_t acquisitions, int slots,
                                   Timestamp code) {
  std::vector<Detection> detections;
  for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
    detections.insert(detections.end(), static_cast<std::size_t>(slots), {acquisition, code});
  }
  ColumnStream stuck;
  for (int row = 0; row < column.rows(); ++row) {
    stuck.append_row(detections);
  }
  return stuck;
}

ColumnStream with_hot_pixel(const ColumnStream& column, int row, std::uint32_t acquisitions, int slots,
                            const std::function<Timestamp()>& code) {
  const std::span<const Detection> own = column.row(row);
  std::vector<Detection> detections;
  auto next = own.begin();
  for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
    std::vector<Timestamp> events = {code()};
    for (; next != own.end() && next->acquisition == acquisition; ++next) {
      events.push_back(next->timestamp);
    }
    std::ranges::sort(events);
    events.resize(std::min(events.size(), static_cast<std::size_t>(slots)));
    for (const Timestamp event : events) {
      detections.push_back({acquisition, event});
    }
  }
  return with_row(column, row, detections);
}

ColumnStream with_dead_pixel(const ColumnStream& column, int row) { return with_row(column, row, {}); }

}  // namespace dtof
