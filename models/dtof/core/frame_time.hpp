// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// Clocks of dtof_array from the first result of a pixel to that of the last of so many columns.
std::int64_t sending_clocks(int columns);

/// Clocks of dtof_pool_pointer_array from the first step of decide until the last result is sent.
std::int64_t pool_decide_clocks(int rows, int columns, int engine_columns);

/// Clocks of a frame, start to done, of an array of so many rows and columns with BROADCAST_STAGES = 2, a
/// source that never pauses and a sink that never waits. No photon changes them.
std::uint64_t predicted_frame_clocks(const ReadoutParameters& parameters, int rows, int columns,
                                     std::uint32_t acquisitions, bool signalled_clear = false);

/// What a frame has to fit.
struct FrameBudget {
  double clock_hz = 330e6;
  double frames_per_s = 30.0;
};

/// Whether a frame fits, and a sentence that says so with numbers; if the frame does not fit, what would.
struct FrameFit {
  bool fits;
  std::uint64_t clocks;
  std::string sentence;
};

FrameFit frame_fit(const ReadoutParameters& parameters, int rows, int columns, std::uint32_t acquisitions,
                   const FrameBudget& budget);

}  // namespace dtof
