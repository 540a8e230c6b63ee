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
  RtlStatistics statistics;                  ///< sum over the column groups; `cycles` of the longest
  /// Clocks of a frame in an array of all the source's columns; nothing if the columns read are of a pool
  /// read-out's last engine alone, which has fewer columns than the others. Only of run_frame_rtl().
  std::optional<std::uint64_t> clocks;
};

/// The compiled arrays that read the columns `selected` of a source of `source_columns` columns and `rows`
/// rows: of poolPointer one for each engine that has one of them, in their order, else one for all. With
/// `waveform` it records one of all of them, or InputError is thrown; it also is for what is not compiled.
std::vector<RtlConfiguration> find_rtl_configurations(const ReadoutParameters& parameters, int rows,
                                                      int source_columns, std::span<const int> selected,
                                                      bool waveform = false);

/// Reads out a frame with the RTL of find_rtl_configurations(): the chosen columns in groups of SRAM_NUM, one
/// model instance each, on at most `threads` threads (0 = all processors); of poolPointer whole engines.
///
/// `columns` lists the columns to read, in the order of the result; empty means all; columns not read cost
/// nothing, but for those of an engine. Where pixels are independent, short columns share a column of the
/// array, one below the other: a sensor of few rows costs little. `progress`, if given, advances by one per
/// column. A trace holds one group: more columns than SRAM_NUM with `options.trace` set are refused. Throws
/// InputError as RtlReadout::run and for a column outside the source.
RtlSourceFrame run_frame_rtl(const StreamSource& source, const ReadoutParameters& parameters, int threads = 0,
                             std::span<const int> columns = {}, const RtlRunOptions& options = {},
                             Progress* progress = nullptr);

/// Reads an engine's columns; `engine`: of those that are read.
using RunEngine = std::function<RtlFrame(std::size_t engine, std::span<const ColumnStream> columns,
                                         std::uint32_t acquisitions)>;

/// A frame by engines, whose columns hear each other (column_groups): `run` reads each with all its columns,
/// from several threads at a time. The result has the columns `selected`.
RtlSourceFrame run_frame_by_engines(const StreamSource& source, std::span<const int> selected,
                                    std::span<const ColumnGroup> engines, int threads, const RunEngine& run,
                                    Progress* progress = nullptr);

/// Reads `columns` streams, of as many rows as the array has or fewer.
using RunGroup = std::function<RtlFrame(std::span<const ColumnStream> columns, std::uint32_t acquisitions)>;

/// A frame by groups of SRAM_NUM columns that know nothing of each other, each of which `run` reads, from
/// several threads at a time. `stack`: where pixels are independent, short columns may share a column of the
/// array.
RtlSourceFrame run_frame_in_groups(const StreamSource& source, const RtlConfiguration& configuration,
                                   int threads, std::span<const int> columns, bool stack, const RunGroup& run,
                                   Progress* progress = nullptr);

}  // namespace dtof
