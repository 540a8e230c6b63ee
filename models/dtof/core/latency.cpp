// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/latency.hpp"

#include "dtof/core/frame_time.hpp"

namespace dtof {
namespace {

/// The read-out of one measurement whose results are found and sent as those of `parameters`.
ReadoutParameters last_measurement(const ReadoutParameters& parameters) {
  constexpr int kThreeStepsBits = 4;
  if (parameters.readout == Readout::kCoarseHistogram) {
    return parameters;
  }
  ReadoutParameters alone = parameters;
  alone.readout = is_pointer_readout(parameters.readout) ? Readout::kEzPointer : Readout::kHistogram;
  if (parameters.readout == Readout::kThreeSteps) {
    alone.np = kThreeStepsBits;
  } else if (parameters.readout == Readout::kFifh) {
    alone.np = parameters.np - parameters.nb;
  } else if (parameters.readout != Readout::kHistogram) {
    alone.np = parameters.nb;
  }
  return alone;
}

/// A frame without acquisitions of that read-out is its start, then the latency.
std::uint64_t array_latency(const ReadoutParameters& parameters, int rows, int columns) {
  const ReadoutParameters alone = last_measurement(parameters);
  constexpr std::uint64_t kSignalledClear = 3;  // start_i to the end of a clear that is signalled
  constexpr std::uint64_t kAroundClear = 4;     // beside one clock for each word of ezPointer
  const std::uint64_t start = alone.readout == Readout::kEzPointer
                                  ? static_cast<std::uint64_t>(rows) + kAroundClear
                                  : kSignalledClear;
  return predicted_frame_clocks(alone, rows, columns, 0, true) - start;
}

/// The end of the last pass of the pixels, with those that fill its last word, then decide.
std::uint64_t pool_latency(const ReadoutParameters& parameters, int rows, int columns) {
  constexpr int kPassEnd = 3;
  constexpr int kOperationEnd = 2;
  constexpr int kWidePass = 7;
  const bool wide = parameters.pool.bin_halves(parameters.count_width) == 2;
  const int together = wide ? 8 : 4;
  const int filling = (together - rows % together) % together;
  const int pass = filling * parameters.slots + kPassEnd + (wide ? kWidePass : 0) + kOperationEnd;
  return static_cast<std::uint64_t>(pass + pool_decide_clocks(rows, columns, parameters.pool.engine_columns));
}

}  // namespace

std::uint64_t predicted_latency_clocks(const ReadoutParameters& parameters, int rows, int columns) {
  return is_pool_readout(parameters.readout) ? pool_latency(parameters, rows, columns)
                                             : array_latency(parameters, rows, columns);
}

}  // namespace dtof
