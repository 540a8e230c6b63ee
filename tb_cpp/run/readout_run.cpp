// SPDX-License-Identifier: Apache-2.0
#include "run/readout_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "core/pixel_sampler.hpp"
#include "core/progress.hpp"
#include "frame/array_rows.hpp"
#include "readout/run_frame.hpp"
#include "rtl/error.hpp"
#include "rtl/registry.hpp"
#include "rtl/run_frame.hpp"
#include "scoreboard/scoreboard.hpp"

namespace dtof {

void check_engine(const StreamSource& source, std::span<const ReadoutParameters> readouts,
                  const RunSettings& options, const Region& region) {
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
    const RtlConfiguration configuration = find_rtl_configuration(
        parameters, array.source->rows(), static_cast<int>(region.columns.size()), !options.trace.empty());
    if (!options.trace.empty() && region.columns.size() > static_cast<std::size_t>(configuration.sram_num)) {
      throw InputError(
          fmt::format("--trace: a waveform holds at most SRAM_NUM = {} columns, not {}; choose some",
                      configuration.sram_num, region.columns.size()));
    }
  }
}

bool reads_samples(Readout readout, const RunSettings& options) {
  return !options.rtl() && !options.streams_only && !is_pool_readout(readout);
}

ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunSettings& options, const Region& region, const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  ReadoutRun run;
  const std::vector<int>& columns = region.columns;
  const ArrayRows array = array_rows(source, region.rows, parameters.readout);
  Progress progress(fmt::format("{} ({})", readout_title(parameters.readout), options.engine),
                    columns.size());
  const auto finish = [&](std::vector<PixelResult> results) {
    run.results = array.read(std::move(results));
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
      const std::string difference = check_source_frame(
          *array.source, parameters, columns, frame,
          {.threads = options.threads, .first_row = array.first, .seed = options.seed, .command = command});
      if (!difference.empty()) {
        throw RtlError(difference);
      }
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
