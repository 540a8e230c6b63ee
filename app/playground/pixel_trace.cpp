// SPDX-License-Identifier: Apache-2.0
#include "playground/pixel_trace.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

namespace dtof {
namespace {

constexpr int kPairColumns = 2;  // columns that share a group

/// The detections before an acquisition, as a stream of the same length.
ColumnStream before(const ColumnStream& stream, std::uint32_t until) {
  ColumnStream kept;
  for (int row = 0; row < stream.rows(); ++row) {
    const std::span<const Detection> all = stream.row(row);
    const auto end = std::ranges::partition_point(
        all, [&](const Detection& detection) { return detection.acquisition < until; });
    kept.append_row(all.first(static_cast<std::size_t>(end - all.begin())));
  }
  return kept;
}

/// Another source's frame, whose light ends before an acquisition.
class DarkAfter final : public StreamSource {
 public:
  DarkAfter(const StreamSource& source, std::uint32_t until) : source_(source), until_(until) {}

  [[nodiscard]] int columns() const override { return source_.columns(); }
  [[nodiscard]] int rows() const override { return source_.rows(); }
  [[nodiscard]] std::uint32_t acquisitions() const override { return source_.acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override {
    return before(source_.column(index), until_);
  }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange rows) const override {
    return before(source_.column_rows(index, rows), until_);
  }

 private:
  const StreamSource& source_;
  std::uint32_t until_;
};

/// A frame of one pixel.
class OnePixel final : public StreamSource {
 public:
  OnePixel(const ColumnStream& pixel, std::uint32_t acquisitions)
      : pixel_(pixel), acquisitions_(acquisitions) {}

  [[nodiscard]] int columns() const override { return 1; }
  [[nodiscard]] int rows() const override { return 1; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return acquisitions_; }
  [[nodiscard]] ColumnStream column(int /*index*/) const override { return pixel_; }

 private:
  const ColumnStream& pixel_;
  std::uint32_t acquisitions_;
};

}  // namespace

PixelResult PixelTrace::result(const ReadoutParameters& readout, std::uint32_t until) const {
  if (!is_pool_readout(readout.readout)) {
    if (pixel_.rows() == 0) {
      pixel_ = source_.column_rows(column_, {row_, 1});
    }
    const OnePixel pixel(pixel_, source_.acquisitions());
    return engine_.read(DarkAfter(pixel, until), readout, Region::whole(1, 1)).results.front();
  }
  ReadoutParameters both = readout;
  both.pool.second_target = true;
  const int first = column_ - column_ % readout.columns_together();
  std::vector<int> columns(
      static_cast<std::size_t>(std::min(readout.columns_together(), source_.columns() - first)));
  std::iota(columns.begin(), columns.end(), first);
  const std::size_t width = columns.size();
  const std::vector<PixelResult> results =
      engine_
          .read(DarkAfter(kept_, until), both, {.columns = std::move(columns), .rows = {0, source_.rows()}})
          .results;
  return results[static_cast<std::size_t>(row_) * width + static_cast<std::size_t>(column_ - first)];
}

std::vector<PoolCandidate> PixelTrace::candidates(const ReadoutParameters& readout,
                                                  std::uint32_t until) const {
  if (!is_pool_readout(readout.readout)) {
    return {};
  }
  const PoolNumbers numbers = pool_pointer_parameters(readout);
  const PoolSchedule schedule(source_.acquisitions(), readout.pool);
  const int engine_begin = column_ - column_ % readout.columns_together();
  const int engine_end = std::min(engine_begin + readout.columns_together(), source_.columns());
  const int array_rows = std::max(source_.rows(), kArrayRows);
  const int height = (array_rows + numbers.group_rows - 1) / numbers.group_rows;
  const int group_row = row_ / numbers.group_rows;
  const int pair_begin = column_ - (column_ - engine_begin) % kPairColumns;
  // Sensor rows of the group and of those above and below.
  const int rows_begin = std::max(group_row - 1, 0) * numbers.group_rows;
  const int rows_end = std::min((group_row + 2) * numbers.group_rows, source_.rows());
  // A group without a neighbour on a side takes itself.
  const int left = pair_begin > engine_begin ? pair_begin - kPairColumns : pair_begin;
  const int right = pair_begin + kPairColumns < engine_end ? pair_begin + kPairColumns : pair_begin;
  const int above = std::max(group_row - 1, 0);
  const int below = std::min(group_row + 1, height - 1);

  if (events_for_ != readout) {
    events_for_ = readout;
    events_.clear();
    for (int column = left; column < std::min(right + kPairColumns, engine_end); ++column) {
      events_.push_back(pool_column_events(source_.column_rows(column, {rows_begin, rows_end - rows_begin}),
                                           readout.np, source_.acquisitions()));
    }
  }
  const auto histogram = [&](int pair_column, int group) {
    const int count = std::min(kPairColumns, engine_end - pair_column);
    return group_histogram(std::span(events_).subspan(static_cast<std::size_t>(pair_column - left),
                                                      static_cast<std::size_t>(count)),
                           static_cast<std::size_t>(group * numbers.group_rows - rows_begin),
                           static_cast<std::size_t>(numbers.group_rows), until, schedule.coarse_end,
                           numbers.count_width);
  };
  const CoarseHistogram own = histogram(pair_begin, group_row);
  const std::array<CoarseHistogram, 4> around = {histogram(pair_begin, above), histogram(pair_begin, below),
                                                 histogram(left, group_row), histogram(right, group_row)};
  // The significance, which counts missing neighbours, does not show here.
  const PoolGroup group = decode_group(
      {.own = &own, .neighbours = {&around[0], &around[1], &around[2], &around[3]}, .missing = 0}, {},
      source_.acquisitions(), numbers);
  PoolTracks tracks;
  const std::vector<PoolEvent>& events =
      events_[static_cast<std::size_t>(column_ - left)][static_cast<std::size_t>(row_ - rows_begin)];
  for (const PoolEvent& event : events) {
    if (event.acquisition >= schedule.coarse_end && event.acquisition < std::min(until, schedule.track_end)) {
      track_event(tracks, group, event, numbers);
    }
  }
  std::vector<PoolCandidate> candidates;
  for (std::size_t k = 0; k < static_cast<std::size_t>(group.labels); ++k) {
    candidates.push_back({group.centre_cell[k], tracks.score[k]});
  }
  return candidates;
}

}  // namespace dtof
