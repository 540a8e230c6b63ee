// SPDX-License-Identifier: Apache-2.0
#include "app/readout_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <numeric>

#include "core/pixel_sampler.hpp"
#include "core/progress.hpp"
#include "readout/run_frame.hpp"
#include "rtl/error.hpp"
#include "rtl/registry.hpp"
#include "rtl/run_frame.hpp"
#include "scoreboard/scoreboard.hpp"

namespace dtof {
namespace {

void verify(const StreamSource& source, const ReadoutParameters& parameters, const RunOptions& options,
            std::span<const int> columns, const std::string& command, const RtlSourceFrame& actual) {
  const std::vector<PixelResult> expected = run_frame(source, parameters, options.threads, columns);
  const std::vector<Mismatch> mismatches =
      compare_frames(columns, expected, actual.results, actual.result_cycles);
  if (mismatches.empty()) {
    return;
  }
  FrameContext context;
  context.configuration = find_rtl_configuration(parameters, source.rows(), static_cast<int>(columns.size()));
  context.acquisitions = source.acquisitions();
  context.seed = options.seed;
  context.reproduce = fmt::format("{} --readout {} --columns {} --trace mismatch.fst", command,
                                  readout_name(parameters.readout), mismatches.front().column);
  throw RtlError(describe_mismatches(mismatches, expected.size(), context));
}

}  // namespace

ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunOptions& options, std::span<const int> columns, const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  ReadoutRun run;
  const std::size_t count = columns.empty() ? static_cast<std::size_t>(source.columns()) : columns.size();
  Progress progress(fmt::format("{} ({})", readout_title(parameters.readout), options.engine), count);
  if (options.rtl()) {
    RtlRunOptions rtl_options;
    rtl_options.trace = options.trace;
    const RtlSourceFrame frame =
        run_frame_rtl(source, parameters, options.threads, columns, rtl_options, &progress);
    run.results = frame.results;
    run.cycles = frame.statistics.cycles;
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.verify) {
      std::vector<int> numbers(columns.begin(), columns.end());
      if (numbers.empty()) {
        numbers.resize(count);
        std::iota(numbers.begin(), numbers.end(), 0);
      }
      verify(source, parameters, options, numbers, command, frame);
    }
    return run;
  }
  const auto* sampled = dynamic_cast<const SampledSource*>(&source);
  // Read-outs that pool pixels need to know which detections share an acquisition.
  const bool sample = sampled != nullptr && !options.streams_only && !is_pool_readout(parameters.readout);
  run.results = sample ? run_sampled_frame(*sampled, parameters, options.threads, columns, &progress)
                       : run_frame(source, parameters, options.threads, columns, &progress);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace dtof
