// SPDX-License-Identifier: Apache-2.0
#include "rtl/run_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <mutex>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/select_columns.hpp"
#include "rtl/frame_clocks.hpp"
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

RtlSourceFrame run_frame_by_engines(const StreamSource& source, std::span<const int> selected,
                                    std::span<const ColumnGroup> engines, int threads, const RunEngine& run,
                                    Progress* progress) {
  const auto rows = static_cast<std::size_t>(source.rows());
  const std::size_t width = selected.size();
  RtlSourceFrame frame;
  frame.results.resize(rows * width);
  frame.result_cycles.resize(rows * width);
  std::mutex statistics_mutex;
  parallel_for(engines.size(), threads, [&](std::size_t index) {
    const ColumnGroup& engine = engines[index];
    std::vector<ColumnStream> streams;
    streams.reserve(static_cast<std::size_t>(engine.count));
    for (int column = 0; column < engine.count; ++column) {
      streams.push_back(source.column(engine.first + column));
    }
    const RtlFrame part = run(index, streams, source.acquisitions());
    for (const std::size_t place : engine.asked) {
      const auto column = static_cast<std::size_t>(selected[place] - engine.first);
      for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t from = row * streams.size() + column;
        frame.results[row * width + place] = part.results[from];
        frame.result_cycles[row * width + place] = part.result_cycles[from];
      }
    }
    const std::scoped_lock lock(statistics_mutex);
    frame.statistics.merge(part.statistics);
    if (progress != nullptr) {
      progress->advance(engine.asked.size());
    }
  });
  return frame;
}

std::vector<RtlConfiguration> find_rtl_configurations(const ReadoutParameters& parameters, int rows,
                                                      int source_columns, std::span<const int> selected,
                                                      bool waveform) {
  const int together = parameters.columns_together();
  std::vector<RtlConfiguration> arrays;
  if (together == 1) {
    arrays.push_back(find_rtl_configuration(parameters, rows, static_cast<int>(selected.size()), waveform));
  } else {
    for (const ColumnGroup& engine : column_groups(selected, together, source_columns)) {
      arrays.push_back(find_rtl_configuration(parameters, rows, engine.count, waveform));
    }
  }
  const bool one_array =
      arrays.size() == 1 && (together > 1 || selected.size() <= static_cast<std::size_t>(arrays[0].sram_num));
  if (waveform && !one_array) {
    throw InputError(fmt::format("a waveform holds at most SRAM_NUM = {} columns{}, not {}; choose some",
                                 arrays[0].sram_num, together > 1 ? ", those of one engine" : "",
                                 selected.size()));
  }
  return arrays;
}

RtlSourceFrame run_frame_rtl(const StreamSource& source, const ReadoutParameters& parameters, int threads,
                             std::span<const int> columns, const RtlRunOptions& options, Progress* progress) {
  parameters.validate();
  const std::vector<int> selected = select_columns(source, columns);
  const bool waveform = !options.trace.empty();
  const std::vector<RtlConfiguration> arrays =
      find_rtl_configurations(parameters, source.rows(), source.columns(), selected, waveform);
  // That of the most columns, whose frame is the longest.
  const RtlConfiguration& widest = *std::ranges::max_element(arrays, {}, &RtlConfiguration::sram_num);
  const auto with_clocks = [&](RtlSourceFrame frame) {
    frame.clocks = frame_clocks(widest, frame.statistics, source.columns());
    return frame;
  };
  if (parameters.columns_together() > 1) {
    return with_clocks(run_frame_by_engines(
        source, selected, column_groups(selected, parameters.columns_together(), source.columns()), threads,
        [&](std::size_t engine, std::span<const ColumnStream> streams, std::uint32_t acquisitions) {
          return RtlReadout(arrays[engine]).run(streams, acquisitions, options);
        },
        progress));
  }
  return with_clocks(run_frame_in_groups(
      source, arrays.front(), threads, selected, !waveform,
      [&](std::span<const ColumnStream> streams, std::uint32_t acquisitions) {
        return RtlReadout(arrays.front()).run(streams, acquisitions, options);
      },
      progress));
}

}  // namespace dtof
