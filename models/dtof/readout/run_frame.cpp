// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/run_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/select_columns.hpp"
#include "dtof/readout/model.hpp"

namespace dtof {

namespace {

ColumnStream checked_column(const StreamSource& source, int column) {
  ColumnStream stream = source.column(column);
  if (stream.rows() != source.rows()) {
    throw InputError(
        fmt::format("column {} has {} rows, its source says {}", column, stream.rows(), source.rows()));
  }
  return stream;
}

/// Copies one column's results into a row-major frame of `width` columns.
void store_column(std::span<const PixelResult> results, std::size_t width, std::size_t index,
                  std::vector<PixelResult>& frame) {
  for (std::size_t row = 0; row < results.size(); ++row) {
    frame[row * width + index] = results[row];
  }
}

}  // namespace

std::vector<PixelResult> run_frame(const StreamSource& source, const ReadoutParameters& parameters,
                                   int threads, std::span<const int> columns, Progress* progress) {
  parameters.validate();
  const std::vector<int> selected = select_columns(source, columns);
  const std::vector<ColumnGroup> groups =
      column_groups(selected, parameters.columns_together(), source.columns());
  const std::size_t width = selected.size();
  std::vector<PixelResult> frame(static_cast<std::size_t>(source.rows()) * width);
  parallel_for(groups.size(), threads, [&](std::size_t index) {
    const ColumnGroup& group = groups[index];
    ColumnStream stream;
    const std::vector<std::vector<PixelResult>> results =
        make_readout_model(parameters)
            ->run_columns(
                group.count,
                [&](int column) -> const ColumnStream& {
                  return stream = checked_column(source, group.first + column);
                },
                source.acquisitions());
    for (const std::size_t place : group.asked) {
      store_column(results[static_cast<std::size_t>(selected[place] - group.first)], width, place, frame);
    }
    if (progress != nullptr) {
      progress->advance(group.asked.size());
    }
  });
  return frame;
}

std::vector<PixelResult> run_sampled_frame(const SampledSource& source, const ReadoutParameters& parameters,
                                           int threads, std::span<const int> columns, Progress* progress) {
  parameters.validate();
  const std::vector<int> selected = select_columns(source, columns);
  const std::size_t width = selected.size();
  const auto rows = static_cast<std::size_t>(source.rows());
  std::vector<PixelResult> frame(rows * width);
  parallel_for(width, threads, [&](std::size_t index) {
    std::vector<PixelResult> results(rows);
    make_readout_model(parameters)
        ->run_sampled_column(*source.pixel_sampler(), selected[index], source.acquisitions(), results);
    store_column(results, width, index, frame);
    if (progress != nullptr) {
      progress->advance();
    }
  });
  return frame;
}

}  // namespace dtof
