// SPDX-License-Identifier: Apache-2.0
#include "random/check.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "dtof/core/frame_time.hpp"
#include "dtof/core/random.hpp"
#include "on_demand/on_demand.hpp"
#include "rtl/error.hpp"
#include "rtl/rtl_readout.hpp"
#include "scoreboard/scoreboard.hpp"
#include "vectors/stimulus.hpp"

namespace dtof {
namespace {

// The long one fills counters; a pixel with many bins has a frame of its own length.
constexpr std::array<std::uint32_t, 7> kFrames = {37, 0, 1, 2, 151, 5, 1200};

RtlRunOptions disturbed(CounterRandom& random, std::uint32_t acquisitions) {
  RtlRunOptions options;
  options.seed = random.bits64();
  options.reset_first = random() % 3 == 0;
  if (random() % 2 == 0) {
    options.pause_probability = 0.5 * random.uniform();
    options.empty_slot_probability = 0.5 * random.uniform();
    options.stall_probability = 0.8 * random.uniform();
    options.start_probability = 0.2 * random.uniform();
  }
  if (acquisitions > 2 && acquisitions < 1000 && random() % 3 == 0) {
    options.reset_at = 1 + random() % (4 * acquisitions);
  }
  return options;
}

/// Clocks in which poolPointer with parity clears the words of its groups, two in each.
std::uint64_t clocks_of_parity(const RtlConfiguration& configuration) {
  if (!configuration.parity || !is_pool_readout(configuration.parameters.readout)) {
    return 0;
  }
  const int group = configuration.parameters.pool.group_size;
  const int groups = (configuration.pixels_per_sram + group - 1) / group;
  return static_cast<std::uint64_t>((groups + 1) / 2);
}

/// Whether a dark frame takes the clocks that are predicted.
std::string clock_difference(RtlReadout& rtl, const std::string& reproduce) {
  const RtlConfiguration& configuration = rtl.configuration();
  constexpr std::uint32_t kAcquisitions = 43;
  std::vector<ColumnStream> columns(static_cast<std::size_t>(configuration.sram_num));
  for (ColumnStream& column : columns) {
    for (int row = 0; row < configuration.pixels_per_sram; ++row) {
      column.finish_row();
    }
  }
  const std::uint64_t clocks = rtl.run(columns, kAcquisitions).statistics.cycles;
  const std::uint64_t predicted =
      predicted_frame_clocks(configuration.parameters, configuration.pixels_per_sram, configuration.sram_num,
                             kAcquisitions, configuration.signalled_clear) +
      clocks_of_parity(configuration);
  return clocks == predicted
             ? ""
             : fmt::format(
                   "a frame of {} acquisitions takes {} clocks, not the {} predicted\n  read-out   {}\n"
                   "  reproduce  {}\n",
                   kAcquisitions, clocks, predicted, configuration.to_string(), reproduce);
}

}  // namespace

ArrayCheck check_array(const RtlConfiguration& configuration, std::uint64_t seed,
                       const std::string& reproduce, std::span<const SourceFile> sources) {
  build_missing_array(configuration, sources);
  CounterRandom random(seed, static_cast<std::uint32_t>(RandomPurpose::kTestControl), 0, 3);
  RtlReadout rtl(configuration);
  ArrayParameters array{.readout = configuration.parameters,
                        .rows = configuration.pixels_per_sram,
                        .columns = configuration.sram_num};
  ArrayCheck check;
  check.difference = clock_difference(rtl, reproduce);
  if (!check.difference.empty()) {
    return check;
  }
  std::size_t kind = random() % 9;
  for (const std::uint32_t acquisitions : kFrames) {
    if (array.readout.time_gate) {
      const auto code = [&] {
        return static_cast<int>(random() % static_cast<std::uint32_t>(array.readout.code_count()));
      };
      array.readout.time_gate = CodeGate{code(), code()};
      rtl.set_time_gate(*array.readout.time_gate);
    }
    const std::vector<ColumnStream> columns = random_columns(array, acquisitions, kind, random);
    RtlFrame frame;
    try {
      check.difference =
          check_frame(rtl, columns, acquisitions, disturbed(random, acquisitions), reproduce, &frame);
    } catch (const RtlError& error) {
      check.difference = std::string(error.what()) + "\n  read-out   " + configuration.to_string() +
                         "\n  reproduce  " + reproduce + "\n";
    }
    if (!check.difference.empty()) {
      return check;
    }
    ++check.frames;
    check.results += frame.results.size();
    check.clocks += frame.statistics.cycles;
  }
  return check;
}

}  // namespace dtof
