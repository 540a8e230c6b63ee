// SPDX-License-Identifier: Apache-2.0
#include "rtl/run_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <mutex>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/select_columns.hpp"
#include "rtl/registry.hpp"

namespace dtof {
namespace {

// Groups that remain at least, so that there is work for several threads.
constexpr std::size_t kLeastGroups = 4;

/// Columns of the source that share a column of the array, one below the other. Pixels of a pool read-out
/// look at their neighbours and keep their place, as those of a trace do.
std::size_t columns_to_stack(const RtlConfiguration& configuration, std::size_t rows, std::size_t columns) {
  if (rows == 0 || is_pool_readout(configuration.parameters.readout)) {
    return 1;
  }
  const std::size_t room = static_cast<std::size_t>(configuration.pixels_per_sram) / rows;
  const std::size_t columns_of_groups = kLeastGroups * static_cast<std::size_t>(configuration.sram_num);
  const std::size_t wanted = (columns + columns_of_groups - 1) / columns_of_groups;
  return std::max<std::size_t>(std::min(room, wanted), 1);
}

}  // namespace

RtlSourceFrame run_frame_in_groups(const StreamSource& source, const RtlConfiguration& configuration,
                                   int threads, std::span<const int> columns, bool stack_columns,
                                   const RunGroup& run, Progress* progress) {
  const std::vector<int> selected = select_columns(source, columns);
  const auto sram_num = static_cast<std::size_t>(configuration.sram_num);
  const auto rows = static_cast<std::size_t>(source.rows());
  const std::size_t width = selected.size();
  const std::size_t stack = stack_columns ? columns_to_stack(configuration, rows, width) : 1;
  const std::size_t group_size = sram_num * stack;
  RtlSourceFrame frame;
  frame.results.resize(rows * width);
  frame.result_cycles.resize(rows * width);
  std::mutex statistics_mutex;
  parallel_for((width + group_size - 1) / group_size, threads, [&](std::size_t group) {
    const std::size_t first = group * group_size;
    const std::size_t count = std::min(group_size, width - first);
    // Column i of the group is in column i % used, i / used columns further down.
    const std::size_t used = (count + stack - 1) / stack;
    std::vector<ColumnStream> streams(used);
    for (std::size_t i = 0; i < used * stack; ++i) {
      const ColumnStream column = i < count ? source.column(selected[first + i]) : ColumnStream();
      for (std::size_t row = 0; row < rows; ++row) {
        streams[i % used].append_row(i < count ? column.row(static_cast<int>(row))
                                               : std::span<const Detection>());
      }
    }
    const RtlFrame part = run(streams, source.acquisitions());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t from = (i / used * rows + row) * used + i % used;
        const std::size_t to = row * width + first + i;
        frame.results[to] = part.results[from];
        frame.result_cycles[to] = part.result_cycles[from];
      }
    }
    const std::scoped_lock lock(statistics_mutex);
    frame.statistics.merge(part.statistics);
    if (progress != nullptr) {
      progress->advance(count);
    }
  });
  return frame;
}

RtlSourceFrame run_frame_rtl(const StreamSource& source, const RtlConfiguration& configuration, int threads,
                             std::span<const int> columns, const RtlRunOptions& options, Progress* progress) {
  const std::size_t width = select_columns(source, columns).size();
  if (!options.trace.empty() && width > static_cast<std::size_t>(configuration.sram_num)) {
    throw InputError(fmt::format("a trace holds at most SRAM_NUM = {} columns, not {}; choose some",
                                 configuration.sram_num, width));
  }
  return run_frame_in_groups(
      source, configuration, threads, columns, options.trace.empty(),
      [&](std::span<const ColumnStream> streams, std::uint32_t acquisitions) {
        return RtlReadout(configuration).run(streams, acquisitions, options);
      },
      progress);
}

RtlSourceFrame run_frame_rtl(const StreamSource& source, const ReadoutParameters& parameters, int threads,
                             std::span<const int> columns, const RtlRunOptions& options, Progress* progress) {
  parameters.validate();
  const std::size_t count = columns.empty() ? static_cast<std::size_t>(source.columns()) : columns.size();
  return run_frame_rtl(
      source,
      find_rtl_configuration(parameters, source.rows(), static_cast<int>(count), !options.trace.empty()),
      threads, columns, options, progress);
}

}  // namespace dtof
