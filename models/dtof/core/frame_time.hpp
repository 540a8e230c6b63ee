// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// Clocks in dtof_array from a pixel's first result to the result of the last of `columns` columns.
std::int64_t sending_clocks(int columns);

/// Clocks in dtof_pool_pointer_array from the first step of decide to the last result sent.
std::int64_t pool_decide_clocks(int rows, int columns, int engine_columns);

/// Clocks of a frame, start to done, of an array with BROADCAST_STAGES = 2. Assumes a source that never
/// pauses and a sink that is always ready. The number does not depend on the photons.
std::uint64_t predicted_frame_clocks(const ReadoutParameters& parameters, int rows, int columns,
                                     std::uint32_t acquisitions, bool signalled_clear = false);

/// Clock and frame rate that a frame must fit.
struct FrameBudget {
  double clock_hz = 330e6;
  double frames_per_s = 30.0;
};

/// Whether a frame fits, and a sentence with the numbers. If the frame does not fit, the sentence says what
/// would.
struct FrameFit {
  bool fits;
  std::uint64_t clocks;
  std::string sentence;
};

FrameFit frame_fit(const ReadoutParameters& parameters, int rows, int columns, std::uint32_t acquisitions,
                   const FrameBudget& budget);

}  // namespace dtof
