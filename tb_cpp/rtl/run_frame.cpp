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

RtlSourceFrame run_frame_rtl(const StreamSource& source, const RtlConfiguration& configuration, int threads,
                             std::span<const int> columns, const RtlRunOptions& options, Progress* progress) {
  const std::vector<int> selected = select_columns(source, columns);
  const auto group_size = static_cast<std::size_t>(configuration.sram_num);
  if (!options.trace.empty() && selected.size() > group_size) {
    throw InputError(fmt::format("a trace holds at most SRAM_NUM = {} columns, not {}; choose some",
                                 group_size, selected.size()));
  }

  const auto rows = static_cast<std::size_t>(source.rows());
  const std::size_t width = selected.size();
  RtlSourceFrame frame;
  frame.results.resize(rows * width);
  frame.result_cycles.resize(rows * width);
  std::mutex statistics_mutex;
  parallel_for((width + group_size - 1) / group_size, threads, [&](std::size_t group) {
    const std::size_t first = group * group_size;
    const std::size_t count = std::min(group_size, width - first);
    std::vector<ColumnStream> streams;
    for (std::size_t i = 0; i < count; ++i) {
      streams.push_back(source.column(selected[first + i]));
    }
    const RtlFrame part = RtlReadout(configuration).run(streams, source.acquisitions(), options);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto from = static_cast<std::ptrdiff_t>(row * count);
      const auto to = static_cast<std::ptrdiff_t>(row * width + first);
      std::copy_n(part.results.begin() + from, count, frame.results.begin() + to);
      std::copy_n(part.result_cycles.begin() + from, count, frame.result_cycles.begin() + to);
    }
    const std::scoped_lock lock(statistics_mutex);
    frame.statistics.merge(part.statistics);
    if (progress != nullptr) {
      progress->advance(count);
    }
  });
  return frame;
}

RtlSourceFrame run_frame_rtl(const StreamSource& source, const ReadoutParameters& parameters, int threads,
                             std::span<const int> columns, const RtlRunOptions& options, Progress* progress) {
  parameters.validate();
  const std::size_t count = columns.empty() ? static_cast<std::size_t>(source.columns()) : columns.size();
  return run_frame_rtl(source, find_rtl_configuration(parameters, source.rows(), static_cast<int>(count)),
                       threads, columns, options, progress);
}

}  // namespace dtof
