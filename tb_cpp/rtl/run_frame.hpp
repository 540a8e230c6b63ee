// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/result.hpp"
#include "dtof/core/select_columns.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {

struct RtlSourceFrame {
  std::vector<PixelResult> results;          ///< index = row * n + i for the i-th of n columns read
  std::vector<std::uint64_t> result_cycles;  ///< clock of each result within its column group; same index
  RtlStatistics statistics;                  ///< sum over the column groups; `cycles` of the longest one
  /// Clocks of a frame in an array with all columns of the source. None if only columns of a pool read-out's
  /// last engine were read and it has fewer columns than the others. Set by run_frame_rtl() only.
  std::optional<std::uint64_t> clocks;
};

/// Returns the compiled arrays that read the columns `selected` of a source of `source_columns` columns and
/// `rows` rows. For poolPointer these are the engines with a selected column, in order; otherwise it is a
/// single array. With `waveform`, one of the arrays can record waveforms. Throws InputError if no such array
/// is compiled.
std::vector<RtlConfiguration> find_rtl_configurations(const ReadoutParameters& parameters, int rows,
                                                      int source_columns, std::span<const int> selected,
                                                      bool waveform = false);

/// Reads out a frame with the RTL of find_rtl_configurations(), on at most `threads` threads (0 = all
/// processors). Columns are read in groups of SRAM_NUM with a model each; for poolPointer a group is a whole
/// engine.
///
/// `columns` lists the columns of the result, in its order; empty means all. Other columns are not simulated,
/// except those of the same engine. If pixels are independent, several short columns share a column of the
/// array, so a sensor of few rows costs little. `progress`, if given, advances by one per column. A trace
/// holds one group, so `options.trace` allows at most SRAM_NUM columns. Throws InputError as RtlReadout::run,
/// and for a column outside the source.
RtlSourceFrame run_frame_rtl(const StreamSource& source, const ReadoutParameters& parameters, int threads = 0,
                             std::span<const int> columns = {}, const RtlRunOptions& options = {},
                             Progress* progress = nullptr);

/// Reads the columns of an engine; `engine` is its index among the engines that are read.
using RunEngine = std::function<RtlFrame(std::size_t engine, std::span<const ColumnStream> columns,
                                         std::uint32_t acquisitions)>;

/// Reads a frame engine by engine (column_groups). Calls `run` once per engine with all its columns, from
/// several threads. The result has the columns `selected`.
RtlSourceFrame run_frame_by_engines(const StreamSource& source, std::span<const int> selected,
                                    std::span<const ColumnGroup> engines, int threads, const RunEngine& run,
                                    Progress* progress = nullptr);

/// Reads some columns, each with at most as many rows as the array.
using RunGroup = std::function<RtlFrame(std::span<const ColumnStream> columns, std::uint32_t acquisitions)>;

/// Reads a frame in independent groups of SRAM_NUM columns. Calls `run` once per group, from several threads.
/// With `stack`, several short columns share a column of the array; pixels must then be independent.
RtlSourceFrame run_frame_in_groups(const StreamSource& source, const RtlConfiguration& configuration,
                                   int threads, std::span<const int> columns, bool stack, const RunGroup& run,
                                   Progress* progress = nullptr);

}  // namespace dtof
