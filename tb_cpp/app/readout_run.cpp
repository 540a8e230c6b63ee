// SPDX-License-Identifier: Apache-2.0
#include "app/readout_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <memory>

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

/// A source whose columns fill those of an array.
class ArrayRows final : public StreamSource {
 public:
  ArrayRows(const StreamSource& source, const RtlConfiguration& configuration)
      : source_(source), configuration_(configuration) {}
  [[nodiscard]] int columns() const override { return source_.columns(); }
  [[nodiscard]] int rows() const override { return configuration_.pixels_per_sram; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return source_.acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override {
    return with_dark_rows(source_.column(index), configuration_);
  }

 private:
  const StreamSource& source_;
  RtlConfiguration configuration_;
};

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

/// `source` has the region's rows only.
void verify(const StreamSource& source, const ReadoutParameters& parameters, const RunOptions& options,
            const Region& region, const std::string& command, const RtlSourceFrame& actual) {
  const std::vector<int>& columns = region.columns;
  const RtlConfiguration configuration =
      find_rtl_configuration(parameters, source.rows(), static_cast<int>(columns.size()));
  std::vector<PixelResult> expected =
      run_frame(ArrayRows(source, configuration), parameters, options.threads, columns);
  expected.resize(actual.results.size());
  std::vector<Mismatch> mismatches = compare_frames(columns, expected, actual.results, actual.result_cycles);
  if (mismatches.empty()) {
    return;
  }
  for (Mismatch& mismatch : mismatches) {
    mismatch.row += region.rows.first;
  }
  FrameContext context;
  context.configuration = configuration;
  context.acquisitions = source.acquisitions();
  context.seed = options.seed;
  const auto index =
      static_cast<std::size_t>(std::ranges::find(columns, mismatches.front().column) - columns.begin());
  context.reproduce =
      fmt::format("{} --readout {} --columns {} --trace mismatch.fst", command,
                  readout_name(parameters.readout), columns_to_trace(columns, index, configuration));
  throw RtlError(describe_mismatches(mismatches, expected.size(), context));
}

}  // namespace

ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunOptions& options, const Region& region, const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  ReadoutRun run;
  const std::vector<int>& columns = region.columns;
  const std::unique_ptr<StreamSource> rows = row_region(source, region.rows);
  Progress progress(fmt::format("{} ({})", readout_title(parameters.readout), options.engine),
                    columns.size());
  if (options.rtl()) {
    RtlRunOptions rtl_options;
    rtl_options.trace = options.trace;
    const RtlSourceFrame frame =
        run_frame_rtl(*rows, parameters, options.threads, columns, rtl_options, &progress);
    run.results = frame.results;
    run.cycles = frame.statistics.cycles;
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.verify) {
      verify(*rows, parameters, options, region, command, frame);
    }
    return run;
  }
  const auto* sampled = dynamic_cast<const SampledSource*>(rows.get());
  // Read-outs that pool pixels need to know which detections share an acquisition.
  const bool sample = sampled != nullptr && !options.streams_only && !is_pool_readout(parameters.readout);
  run.results = sample ? run_sampled_frame(*sampled, parameters, options.threads, columns, &progress)
                       : run_frame(*rows, parameters, options.threads, columns, &progress);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace dtof
