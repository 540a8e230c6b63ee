// SPDX-License-Identifier: Apache-2.0
#include "scoreboard/scoreboard.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <memory>
#include <numeric>

#include "dtof/core/error.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/run_frame.hpp"
#include "rtl/run_frame.hpp"

namespace dtof {
namespace {

constexpr std::size_t kDescribedMismatches = 5;

std::string to_text(const PixelResult& result) {
  return fmt::format("code {} fraction {} confidence {}{}{}", result.code, result.fraction, result.confidence,
                     result.second != 0 ? fmt::format(" second {}", result.second) : "",
                     result.amplitude != 0 || result.ambient != 0
                         ? fmt::format(" amplitude {} ambient {}", result.amplitude, result.ambient)
                         : "");
}

std::vector<PixelResult> run_model(const RtlConfiguration& configuration,
                                   std::span<const ColumnStream> columns, std::uint32_t acquisitions) {
  const std::size_t rows = columns.empty() ? 0 : static_cast<std::size_t>(columns.front().rows());
  std::vector<PixelResult> results(rows * columns.size());
  // The array has all its columns and rows; those that are not given are dark.
  ColumnStream stream;
  const std::vector<std::vector<PixelResult>> expected =
      make_readout_model(configuration.parameters)
          ->run_columns(
              configuration.sram_num,
              [&](int column) -> const ColumnStream& {
                const auto given = static_cast<std::size_t>(column);
                return stream = with_dark_rows(given < columns.size() ? columns[given] : ColumnStream(),
                                               configuration);
              },
              acquisitions);
  for (std::size_t column = 0; column < columns.size(); ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      results[row * columns.size() + column] = expected[column][row];
    }
  }
  return results;
}

std::vector<ColumnStream> cut(std::span<const ColumnStream> columns, std::uint32_t acquisitions) {
  std::vector<ColumnStream> shorter(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (int row = 0; row < columns[i].rows(); ++row) {
      const std::span<const Detection> all = columns[i].row(row);
      const auto end = std::ranges::lower_bound(all, acquisitions, {}, &Detection::acquisition);
      shorter[i].append_row(all.first(static_cast<std::size_t>(end - all.begin())));
    }
  }
  return shorter;
}

std::vector<Mismatch> run_both(RtlReadout& rtl, std::span<const ColumnStream> columns,
                               std::uint32_t acquisitions, const RtlRunOptions& options, RtlFrame& frame) {
  frame = rtl.run(columns, acquisitions, options);
  std::vector<int> numbers(columns.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return compare_frames(numbers, run_model(rtl.configuration(), columns, acquisitions), frame.results,
                        frame.result_cycles);
}

// Bisection; a fault need not be monotonic in the frame's length, so the answer is short, not proven
// shortest.
std::uint32_t shortest_failing_frame(RtlReadout& rtl, std::span<const ColumnStream> columns,
                                     std::uint32_t acquisitions, RtlRunOptions options) {
  options.trace.clear();
  std::uint32_t agrees = 0;
  std::uint32_t differs = acquisitions;
  RtlFrame frame;
  while (differs > agrees + 1) {
    const std::uint32_t middle = agrees + (differs - agrees) / 2;
    const bool same = run_both(rtl, cut(columns, middle), middle, options, frame).empty();
    (same ? agrees : differs) = middle;
  }
  return differs;
}

/// For --columns: what the array held beside `columns[index]`; just that column where columns know nothing of
/// each other.
std::string columns_to_trace(std::span<const int> columns, std::size_t index,
                             const RtlConfiguration& configuration) {
  const int together = configuration.parameters.columns_together();
  if (together > 1) {
    std::vector<int> engine;
    std::ranges::copy_if(columns, std::back_inserter(engine),
                         [&](int column) { return column / together == columns[index] / together; });
    return fmt::format("{}", fmt::join(engine, ","));
  }
  std::size_t first = index;
  std::size_t count = 1;
  if (is_pool_readout(configuration.parameters.readout)) {
    count = static_cast<std::size_t>(configuration.sram_num);
    first = index / count * count;
  }
  return fmt::format("{}", fmt::join(columns.subspan(first, std::min(count, columns.size() - first)), ","));
}

/// The arrays of `dtof` record no waveforms. Those of `dtof-wave` do, and the engines of poolPointer in
/// `dtof-wave-pool`.
std::string waveform_command(std::string command, const ReadoutParameters& parameters) {
  constexpr std::string_view kProgram = "dtof ";
  if (command.starts_with(kProgram)) {
    command.replace(0, kProgram.size(), parameters.columns_together() > 1 ? "dtof-wave-pool " : "dtof-wave ");
  }
  return command;
}

}  // namespace

ColumnStream with_dark_rows(ColumnStream column, const RtlConfiguration& configuration) {
  while (column.rows() < configuration.pixels_per_sram) {
    column.finish_row();
  }
  return column;
}

std::vector<Mismatch> compare_frames(std::span<const int> columns, std::span<const PixelResult> expected,
                                     std::span<const PixelResult> actual,
                                     std::span<const std::uint64_t> result_cycles) {
  const bool whole_rows = columns.empty() ? expected.empty() : expected.size() % columns.size() == 0;
  if (!whole_rows || actual.size() != expected.size() || result_cycles.size() != expected.size()) {
    throw InputError(fmt::format("frames of {} and {} results, {} result clocks, {} columns do not compare",
                                 expected.size(), actual.size(), result_cycles.size(), columns.size()));
  }
  std::vector<Mismatch> mismatches;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] != actual[i]) {
      mismatches.push_back({.column = columns[i % columns.size()],
                            .row = static_cast<int>(i / columns.size()),
                            .expected = expected[i],
                            .actual = actual[i],
                            .cycle = result_cycles[i]});
    }
  }
  return mismatches;
}

std::string describe_mismatches(std::span<const Mismatch> mismatches, std::size_t pixels,
                                const FrameContext& context) {
  std::string text = fmt::format("{} of {} pixels differ between RTL and model\n", mismatches.size(), pixels);
  text += fmt::format("  read-out   {}\n", context.configuration.to_string());
  text += fmt::format("  frame      {} acquisitions, seed {}\n", context.acquisitions, context.seed);
  if (context.shortest_failing_frame.has_value()) {
    text += fmt::format("             differs already when cut to {} acquisitions\n",
                        *context.shortest_failing_frame);
  }
  for (const Mismatch& mismatch : mismatches.first(std::min(mismatches.size(), kDescribedMismatches))) {
    text += fmt::format("  column {} row {}: expected {}, actual {}, clock {}\n", mismatch.column,
                        mismatch.row, to_text(mismatch.expected), to_text(mismatch.actual), mismatch.cycle);
  }
  return text + fmt::format("  reproduce  {}\n", context.reproduce);
}

std::string check_frame(RtlReadout& rtl, std::span<const ColumnStream> columns, std::uint32_t acquisitions,
                        const RtlRunOptions& options, const std::string& reproduce, RtlFrame* frame) {
  RtlFrame local;
  RtlFrame& rtl_frame = frame != nullptr ? *frame : local;
  const std::vector<Mismatch> mismatches = run_both(rtl, columns, acquisitions, options, rtl_frame);
  if (mismatches.empty()) {
    return {};
  }
  FrameContext context{.configuration = rtl.configuration(),
                       .acquisitions = acquisitions,
                       .seed = options.seed,
                       .reproduce = reproduce,
                       .shortest_failing_frame = std::nullopt};
  if (acquisitions > 0) {
    context.shortest_failing_frame = shortest_failing_frame(rtl, columns, acquisitions, options);
  }
  return describe_mismatches(mismatches, rtl_frame.results.size(), context);
}

std::string check_source_frame(const StreamSource& source, const ReadoutParameters& parameters,
                               std::span<const int> columns, const RtlSourceFrame& actual,
                               const SourceFrameContext& frame) {
  const std::vector<PixelResult> expected = run_frame(source, parameters, frame.threads, columns);
  std::vector<Mismatch> mismatches = compare_frames(columns, expected, actual.results, actual.result_cycles);
  if (mismatches.empty()) {
    return {};
  }
  for (Mismatch& mismatch : mismatches) {
    mismatch.row += frame.first_row;
  }
  const std::array<int, 1> engine_of = {mismatches.front().column};
  const RtlConfiguration configuration =
      find_rtl_configurations(parameters, source.rows(), source.columns(),
                              parameters.columns_together() > 1 ? std::span<const int>(engine_of) : columns)
          .front();
  const auto index =
      static_cast<std::size_t>(std::ranges::find(columns, mismatches.front().column) - columns.begin());
  return describe_mismatches(
      mismatches, expected.size(),
      {.configuration = configuration,
       .acquisitions = source.acquisitions(),
       .seed = frame.seed,
       .reproduce = fmt::format("{} --readout {} --columns {} --trace mismatch.fst",
                                waveform_command(frame.command, parameters), readout_name(parameters.readout),
                                columns_to_trace(columns, index, configuration)),
       .shortest_failing_frame = std::nullopt});
}

}  // namespace dtof
