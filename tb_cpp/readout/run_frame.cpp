// SPDX-License-Identifier: Apache-2.0
#include "readout/run_frame.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <functional>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/select_columns.hpp"
#include "readout/model.hpp"

namespace dtof {

namespace {

/// `read(column, results)` fills one column's results; the frame is row-major.
std::vector<PixelResult> read_columns(
    const StreamSource& source, std::span<const int> selected, int threads, Progress* progress,
    const std::function<void(int column, std::vector<PixelResult>& results)>& read) {
  const auto rows = static_cast<std::size_t>(source.rows());
  const std::size_t width = selected.size();
  std::vector<PixelResult> frame(rows * width);
  parallel_for(width, threads, [&](std::size_t index) {
    std::vector<PixelResult> results(rows);
    read(selected[index], results);
    for (std::size_t row = 0; row < rows; ++row) {
      frame[row * width + index] = results[row];
    }
    if (progress != nullptr) {
      progress->advance();
    }
  });
  return frame;
}

}  // namespace

std::vector<PixelResult> run_frame(const StreamSource& source, const ReadoutParameters& parameters,
                                   int threads, std::span<const int> columns, Progress* progress) {
  parameters.validate();
  return read_columns(source, select_columns(source, columns), threads, progress,
                      [&](int column, std::vector<PixelResult>& results) {
                        const ColumnStream stream = source.column(column);
                        if (stream.rows() != source.rows()) {
                          throw InputError(fmt::format("column {} has {} rows, its source says {}", column,
                                                       stream.rows(), source.rows()));
                        }
                        results = make_readout_model(parameters)->run_column(stream, source.acquisitions());
                      });
}

std::vector<PixelResult> run_sampled_frame(const SampledSource& source, const ReadoutParameters& parameters,
                                           int threads, std::span<const int> columns, Progress* progress) {
  parameters.validate();
  return read_columns(source, select_columns(source, columns), threads, progress,
                      [&](int column, std::vector<PixelResult>& results) {
                        make_readout_model(parameters)
                            ->run_sampled_column(*source.pixel_sampler(), column, source.acquisitions(),
                                                 results);
                      });
}

}  // namespace dtof
