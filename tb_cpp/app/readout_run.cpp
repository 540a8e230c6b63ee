// SPDX-License-Identifier: Apache-2.0
#include "app/readout_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "core/pixel_sampler.hpp"
#include "core/progress.hpp"
#include "core/row_region.hpp"
#include "readout/run_frame.hpp"
#include "rtl/error.hpp"
#include "rtl/registry.hpp"
#include "rtl/run_frame.hpp"
#include "scoreboard/scoreboard.hpp"

namespace dtof {
namespace {

/// What a read-out's array sees of a region, the same for either engine.
struct ArrayRows {
  std::unique_ptr<StreamSource> source;
  int first;        ///< sensor row of the source's row 0
  RowRange region;  ///< the region's rows in the source
};

/// Pixels of a pool read-out look at their neighbours, so its arrays are whole: of as many rows as the
/// compiled ones, those outside the region dark. All other pixels are independent, and the region's rows are
/// enough.
ArrayRows array_rows(const StreamSource& source, RowRange region, Readout readout) {
  if (!is_pool_readout(readout)) {
    return {row_region(source, region), region.first, {.first = 0, .count = region.count}};
  }
  const int rows = std::max(source.rows(), RtlConfiguration().pixels_per_sram);
  return {dark_except(source, region, rows), 0, region};
}

/// For --columns: what the array held beside `columns[index]`; just that column where columns know nothing of
/// each other.
std::string columns_to_trace(std::span<const int> columns, std::size_t index,
                             const RtlConfiguration& configuration) {
  std::size_t first = index;
  std::size_t count = 1;
  if (is_pool_readout(configuration.parameters.readout)) {
    count = static_cast<std::size_t>(configuration.sram_num);
    first = index / count * count;
  }
  return fmt::format("{}", fmt::join(columns.subspan(first, std::min(count, columns.size() - first)), ","));
}

/// Compares every row of the array.
void verify(const ArrayRows& array, const ReadoutParameters& parameters, const RunOptions& options,
            const std::vector<int>& columns, const std::string& command, const RtlSourceFrame& actual) {
  const StreamSource& source = *array.source;
  const std::vector<PixelResult> expected = run_frame(source, parameters, options.threads, columns);
  std::vector<Mismatch> mismatches = compare_frames(columns, expected, actual.results, actual.result_cycles);
  if (mismatches.empty()) {
    return;
  }
  for (Mismatch& mismatch : mismatches) {
    mismatch.row += array.first;
  }
  FrameContext context;
  context.configuration = find_rtl_configuration(parameters, source.rows(), static_cast<int>(columns.size()));
  context.acquisitions = source.acquisitions();
  context.seed = options.seed;
  const auto index =
      static_cast<std::size_t>(std::ranges::find(columns, mismatches.front().column) - columns.begin());
  context.reproduce =
      fmt::format("{} --readout {} --columns {} --trace mismatch.fst", command,
                  readout_name(parameters.readout), columns_to_trace(columns, index, context.configuration));
  throw RtlError(describe_mismatches(mismatches, expected.size(), context));
}

}  // namespace

void check_engine(const StreamSource& source, std::span<const ReadoutParameters> readouts,
                  const RunOptions& options, const Region& region) {
  if (!options.rtl()) {
    return;
  }
  constexpr std::uint32_t kMostRtlAcquisitions = std::numeric_limits<std::uint16_t>::max();
  if (source.acquisitions() > kMostRtlAcquisitions) {
    throw InputError(fmt::format("--engine rtl: {} acquisitions; the RTL counts 16 bits of them, to {}",
                                 source.acquisitions(), kMostRtlAcquisitions));
  }
  for (const ReadoutParameters& parameters : readouts) {
    const ArrayRows array = array_rows(source, region.rows, parameters.readout);
    const RtlConfiguration configuration =
        find_rtl_configuration(parameters, array.source->rows(), static_cast<int>(region.columns.size()));
    if (!options.trace.empty() && region.columns.size() > static_cast<std::size_t>(configuration.sram_num)) {
      throw InputError(
          fmt::format("--trace: a waveform holds at most SRAM_NUM = {} columns, not {}; choose some",
                      configuration.sram_num, region.columns.size()));
    }
  }
}

bool reads_samples(Readout readout, const RunOptions& options) {
  return !options.rtl() && !options.streams_only && !is_pool_readout(readout);
}

ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunOptions& options, const Region& region, const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  ReadoutRun run;
  const std::vector<int>& columns = region.columns;
  const ArrayRows array = array_rows(source, region.rows, parameters.readout);
  Progress progress(fmt::format("{} ({})", readout_title(parameters.readout), options.engine),
                    columns.size());
  const auto finish = [&](std::vector<PixelResult> results) {
    const auto first = static_cast<std::ptrdiff_t>(columns.size()) * array.region.first;
    const auto last = first + static_cast<std::ptrdiff_t>(columns.size()) * array.region.count;
    results.erase(results.begin() + last, results.end());
    results.erase(results.begin(), results.begin() + first);
    run.results = std::move(results);
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (options.rtl()) {
    RtlRunOptions rtl_options;
    rtl_options.trace = options.trace;
    const RtlSourceFrame frame =
        run_frame_rtl(*array.source, parameters, options.threads, columns, rtl_options, &progress);
    run.cycles = frame.statistics.cycles;
    finish(frame.results);
    if (options.verify) {
      verify(array, parameters, options, columns, command, frame);
    }
    return run;
  }
  const auto* sampled = dynamic_cast<const SampledSource*>(array.source.get());
  finish(sampled != nullptr && reads_samples(parameters.readout, options)
             ? run_sampled_frame(*sampled, parameters, options.threads, columns, &progress)
             : run_frame(*array.source, parameters, options.threads, columns, &progress));
  return run;
}

}  // namespace dtof
