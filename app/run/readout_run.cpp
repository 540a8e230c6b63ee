// SPDX-License-Identifier: Apache-2.0
#include "run/readout_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/frame/array_rows.hpp"
#include "dtof/readout/run_frame.hpp"
#include "on_demand/on_demand.hpp"
#include "rtl/error.hpp"
#include "rtl/run_frame.hpp"
#include "run/reproduction.hpp"
#include "scoreboard/scoreboard.hpp"
#include "subsystem/registry.hpp"
#include "subsystem/subsystem_frame.hpp"

namespace dtof {
namespace {

/// Options that the scoreboard adds to a command with values of its own.
constexpr std::array<std::string_view, 4> kOfReproduction = {"--readout", "-r", "--columns", "--trace"};

// Throws RtlError that describes every pixel in which the frame differs from the model's.
void verify_subsystem(const StreamSource& source, const ReadoutParameters& parameters,
                      const RunSettings& options, std::span<const int> columns, const RtlSourceFrame& frame,
                      const std::string& command) {
  const std::vector<PixelResult> expected = run_frame(source, parameters, options.threads, columns);
  const std::vector<Mismatch> mismatches =
      compare_frames(columns, expected, frame.results, frame.result_cycles);
  if (!mismatches.empty()) {
    throw RtlError(describe_mismatches(
        mismatches, expected.size(),
        {.configuration =
             find_subsystems(parameters, source.rows(), source.columns(), columns).front().configuration,
         .acquisitions = source.acquisitions(),
         .seed = options.seed,
         .reproduce = command,
         .shortest_failing_frame = std::nullopt}));
  }
}

std::string array_phrase(int columns, int rows) {
  return fmt::format("{} columns of {} rows", columns, rows);
}

}  // namespace

void check_engine(const StreamSource& source, std::span<const ReadoutParameters> readouts,
                  const RunSettings& options, const Region& region) {
  if (!options.hardware()) {
    return;
  }
  constexpr std::uint32_t kMostRtlAcquisitions = std::numeric_limits<std::uint16_t>::max();
  if (source.acquisitions() > kMostRtlAcquisitions) {
    throw InputError(fmt::format("--engine {}: {} acquisitions; the RTL counts 16 bits of them, to {}",
                                 options.engine, source.acquisitions(), kMostRtlAcquisitions));
  }
  for (const ReadoutParameters& parameters : readouts) {
    const ArrayRows array = array_rows(source, region.rows, parameters.readout, options.own_rows);
    // An array for all of the source's rows serves every region.
    const int rows = std::max(source.rows(), array.source->rows());
    if (options.subsystem()) {
      build_missing_subsystems(parameters, rows, source.columns(), region.columns);
      (void)find_subsystems(parameters, array.source->rows(), source.columns(), region.columns);
      continue;
    }
    if (options.trace.empty()) {
      build_missing_arrays(parameters, rows, source.columns(), region.columns);
    }
    (void)find_rtl_configurations(parameters, array.source->rows(), source.columns(), region.columns,
                                  !options.trace.empty());
  }
}

std::vector<ReadoutParameters> without_unfit_engines(const StreamSource& source,
                                                     std::vector<ReadoutParameters> readouts,
                                                     const RunSettings& options, const Region& region) {
  std::erase_if(readouts, [&](const ReadoutParameters& parameters) {
    if (!options.rtl() || !is_pool_readout(parameters.readout)) {
      return false;
    }
    try {
      const ArrayRows array = array_rows(source, region.rows, parameters.readout, options.own_rows);
      (void)find_rtl_configurations(parameters, array.source->rows(), source.columns(), region.columns);
      return false;
    } catch (const InputError&) {
      if (options.trace.empty() && obstacle_to_building().empty()) {
        return false;
      }
      fmt::print(
          "{} is left out: its RTL is not compiled for {} columns or the pulse (--readout {} says more).\n",
          readout_title(parameters.readout), source.columns(), readout_name(parameters.readout));
      return true;
    }
  });
  return readouts;
}

bool reads_samples(Readout readout, const RunSettings& options) {
  return !options.hardware() &&
         ModelEngine({.threads = options.threads, .streams_only = options.streams_only})
             .reads_samples(readout);
}

ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunSettings& options, const Region& region, const std::string& command) {
  if (!options.hardware()) {
    return ModelEngine({.threads = options.threads,
                        .streams_only = options.streams_only,
                        .own_rows = options.own_rows})
        .read(source, parameters, region);
  }
  const auto start = std::chrono::steady_clock::now();
  ReadoutRun run;
  const std::vector<int>& columns = region.columns;
  const ArrayRows array = array_rows(source, region.rows, parameters.readout, options.own_rows);
  Progress progress(fmt::format("{} ({})", readout_title(parameters.readout), options.engine),
                    columns.size());
  const auto finish = [&](std::vector<PixelResult> results) {
    run.results = array.read(std::move(results));
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (options.subsystem()) {
    const RtlSourceFrame frame =
        run_frame_subsystem(*array.source, parameters, options.threads, columns, &progress);
    run.cycles = frame.statistics.cycles;
    const RtlConfiguration& simulated =
        find_subsystems(parameters, array.source->rows(), source.columns(), columns).front().configuration;
    run.array = array_phrase(simulated.sram_num, simulated.pixels_per_sram);
    if (options.verify) {
      verify_subsystem(*array.source, parameters, options, columns, frame, command);
    }
    finish(frame.results);
    return run;
  }
  RtlRunOptions rtl_options;
  rtl_options.trace = options.trace;
  const RtlSourceFrame frame =
      run_frame_rtl(*array.source, parameters, options.threads, columns, rtl_options, &progress);
  run.cycles = frame.clocks.value_or(0);
  run.array = array_phrase(
      source.columns(), find_rtl_configurations(parameters, array.source->rows(), source.columns(), columns,
                                                !options.trace.empty())
                            .front()
                            .pixels_per_sram);
  finish(frame.results);
  if (options.verify) {
    const std::string difference = check_source_frame(*array.source, parameters, columns, frame,
                                                      {.threads = options.threads,
                                                       .first_row = array.first,
                                                       .seed = options.seed,
                                                       .command = without_options(command, kOfReproduction)});
    if (!difference.empty()) {
      throw RtlError(difference);
    }
  }
  return run;
}

}  // namespace dtof
