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

  /// Reads out one column's frame of `acquisitions`. Returns one result per row. Throws InputError for a
  /// malformed stream.
  [[nodiscard]] virtual std::vector<PixelResult> run_column(const ColumnStream& column,
                                                            std::uint32_t acquisitions) = 0;
  /// Reads out `count` neighbouring columns from left to right; in pool read-outs their pixels depend on each
  /// other. Returns results [column][row]. Throws InputError if the columns differ in the number of rows.
  [[nodiscard]] virtual std::vector<std::vector<PixelResult>> run_columns(int count,
                                                                          const ColumnReader& column,
                                                                          std::uint32_t acquisitions);
  /// Same, for columns that are already in memory.
  [[nodiscard]] std::vector<std::vector<PixelResult>> run_columns(std::span<const ColumnStream> columns,
                                                                  std::uint32_t acquisitions);
  /// Reads out a column from photons drawn by `sampler`, which must have the same NP. Fills one result per
  /// row, results.size() rows.
  virtual void run_sampled_column(PixelSampler& sampler, int column, std::uint32_t acquisitions,
                                  std::span<PixelResult> results) = 0;
  /// Contents of a raw frame for the column: for each row, the bins of the last histogram that the read-out
  /// built, raw_bins() in number. A bin appears as a result: code is its lowest code, limited to 0 .. 2^NP -
  /// 1 if the window extends beyond the range; confidence is its count. Throws InputError for a read-out
  /// without such a histogram.
  [[nodiscard]] virtual std::vector<std::vector<PixelResult>> run_raw_column(const ColumnStream& column,
                                                                             std::uint32_t acquisitions);
};

/// Makes the model of a read-out. Throws InputError for illegal parameters.
std::unique_ptr<ReadoutModel> make_readout_model(const ReadoutParameters& parameters);

}  // namespace dtof
