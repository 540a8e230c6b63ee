// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/pixel_sampler.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

/// Bit-exact integer model of a read-out (docs/reference/readouts.md). Not thread-safe: one instance per
/// thread.
class ReadoutModel {
 public:
  ReadoutModel() = default;
  ReadoutModel(const ReadoutModel&) = delete;
  ReadoutModel& operator=(const ReadoutModel&) = delete;
  ReadoutModel(ReadoutModel&&) = delete;
  ReadoutModel& operator=(ReadoutModel&&) = delete;
  virtual ~ReadoutModel() = default;

  /// Reads out one column's frame of `acquisitions`; one result per row.
  [[nodiscard]] virtual std::vector<PixelResult> run_column(const ColumnStream& column,
                                                            std::uint32_t acquisitions) = 0;
  /// Reads out `count` neighbouring columns of equally many rows from left to right, whose pixels may hear
  /// each other; index: column, row. Throws InputError for different numbers of rows.
  [[nodiscard]] virtual std::vector<std::vector<PixelResult>> run_columns(int count,
                                                                          const ColumnReader& column,
                                                                          std::uint32_t acquisitions);
  /// The same for columns that are all there.
  [[nodiscard]] std::vector<std::vector<PixelResult>> run_columns(std::span<const ColumnStream> columns,
                                                                  std::uint32_t acquisitions);
  /// Reads out the column from what `sampler` draws, which must be of the same NP; one result per row, as
  /// many as `results` holds.
  virtual void run_sampled_column(PixelSampler& sampler, int column, std::uint32_t acquisitions,
                                  std::span<PixelResult> results) = 0;
  /// What a raw frame shows of the column: of each row the bins of the histogram that the read-out holds at
  /// the frame's end (the last one it built), as many as raw_bins() of its parameters. A bin is its lowest
  /// code, limited to 0 .. 2^NP - 1 where a window begins or ends beyond the range, and its count as the
  /// confidence. Throws InputError for a read-out
  /// without such a histogram.
  [[nodiscard]] virtual std::vector<std::vector<PixelResult>> run_raw_column(const ColumnStream& column,
                                                                             std::uint32_t acquisitions);
};

/// Throws InputError for illegal parameters.
std::unique_ptr<ReadoutModel> make_readout_model(const ReadoutParameters& parameters);

}  // namespace dtof
