// SPDX-License-Identifier: Apache-2.0
#include "random/draw.hpp"

#include <algorithm>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "dtof/design/array_memories.hpp"

namespace dtof {
namespace {

class Draw {
 public:
  Draw(std::uint64_t seed, std::uint32_t index)
      : random_(seed, static_cast<std::uint32_t>(RandomPurpose::kTestControl), index, 2) {}

  /// `lowest` to `highest`, both included.
  int from(int lowest, int highest) {
    return lowest + static_cast<int>(random_() % static_cast<std::uint32_t>(highest - lowest + 1));
  }
  bool coin() { return from(0, 1) != 0; }

 private:
  CounterRandom random_;
};

// Bins of a column's histograms, all its pixels together, that a simulation clears and scans in a moment.
constexpr int kMostBins = 1 << 15;
constexpr int kMostRows = 12;
constexpr int kMostPoolRows = 40;  // more than a group's

/// An upper bound of a pixel's bins.
int bins(const ReadoutParameters& parameters) {
  if (!has_histogram(parameters.readout) || is_pool_readout(parameters.readout)) {
    return 1;
  }
  return parameters.readout == Readout::kHistogram
             ? parameters.code_count()
             : std::max(1 << parameters.nb, 1 << (parameters.np - parameters.nb));
}

void draw_pool(Draw& draw, ReadoutParameters& parameters) {
  parameters.np = draw.from(8, 16);
  parameters.slots = draw.from(2, 4);
  parameters.count_width = draw.from(4, 8);
  parameters.fraction_bits = 16 - parameters.np;
  PoolPointerParameters& pool = parameters.pool;
  pool.group_size = 1 << draw.from(2, 5);
  pool.labels = draw.from(2, 8);
  pool.score_bits = draw.from(1, 4);
  pool.rival_moves = draw.coin();
  pool.offset_bits = pool.rival_moves ? draw.from(1, 6) : 0;
  pool.offset_bits = pool.offset_bits == 1 ? 0 : pool.offset_bits;
  pool.count_bits = draw.coin() ? 4 : 7;
  pool.pointer_shift = draw.from(0, pool.count_bits == 4 ? 4 : 2);
  pool.cell_shift = draw.from(8, 10);
  pool.second_target = draw.coin();
  pool.prior = draw.coin();
  pool.coarse_share = draw.from(1, 62);
  pool.track_share = draw.from(1, 63 - pool.coarse_share);
  pool.smooth = draw.coin();
  pool.engine_columns = 2 * draw.from(1, 4);
  pool.amplitude = draw.coin();
}

void draw_other(Draw& draw, RtlConfiguration& configuration) {
  ReadoutParameters& parameters = configuration.parameters;
  parameters.np = draw.from(3, 16);
  parameters.nb = draw.from(1, parameters.np);
  parameters.slots = draw.coin() ? draw.from(1, 4) : draw.from(1, 16);
  parameters.count_width = draw.from(1, 16);
  parameters.pointer_step = draw.coin() ? 1 : draw.from(1, (1 << (parameters.np - 1)) - 1);
  parameters.fraction_bits = draw.from(0, std::min(8, 16 - parameters.np));
  parameters.confidence_width = draw.from(0, 8);
  parameters.guard = draw.from(0, 1 << parameters.np);
  parameters.window_centred = draw.coin() && has_parameter(parameters.readout, "WINDOW_CENTRED");
  configuration.pointer_ports = parameters.slots >= 2 ? draw.from(1, 2) : 2;
  configuration.signalled_clear = draw.coin();
  configuration.raw_histogram = parameters.raw_bins() > 0 && draw.coin();
}

bool legal(const ReadoutParameters& parameters) {
  try {
    parameters.validate();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

RtlConfiguration drawn_configuration(std::uint64_t seed, std::uint32_t index) {
  Draw draw(seed, index);
  RtlConfiguration configuration;
  configuration.records_waveform = false;
  const Readout readout = kRtlReadouts[index % kRtlReadouts.size()];
  do {
    configuration.parameters = ReadoutParameters::defaults(readout);
    if (is_pool_readout(readout)) {
      draw_pool(draw, configuration.parameters);
    } else {
      draw_other(draw, configuration);
    }
  } while (!legal(configuration.parameters) || bins(configuration.parameters) > kMostBins);
  ReadoutParameters& parameters = configuration.parameters;
  if (draw.coin()) {
    parameters.time_gate = CodeGate{0, parameters.no_detection()};
  }
  configuration.pixels_per_sram = draw.from(
      1, is_pool_readout(readout) ? kMostPoolRows : std::min(kMostRows, kMostBins / bins(parameters)));
  configuration.sram_num = draw.from(1, 9);
  configuration.parity = draw.coin();
  return configuration;
}

RtlConfiguration netlist_configuration(const RtlConfiguration& drawn) {
  constexpr int kPixels = 3;  // synth/dtof_synth/simulation.py
  RtlConfiguration netlist = drawn;
  if (drawn.signalled_clear) {
    const std::vector<MacroSize> memories =
        column_memories({.parameters = drawn.parameters, .rows = kPixels});
    netlist.signalled_clear = memories.front().words <= kMostStatusBits;  // the first one has the histograms
  }
  return netlist;
}

}  // namespace dtof
