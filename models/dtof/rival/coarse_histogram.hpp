// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/rival/rival.hpp"

namespace dtof {

/// A histogram of 2^bin_bits bins over the whole range for the whole frame, matched on the host (BinMatcher).
/// No part of the frame is spent on finding the peak, and no window is placed.
///
/// On the chip: bin x >> (NP - bin_bits) += 1, saturating at 2^count_bits - 1.
struct CoarseHistogramChoice {
  int bin_bits = 5;    ///< 2 .. NP
  int count_bits = 8;  ///< 1 .. 16
};
std::unique_ptr<Rival> make_coarse_histogram(const SensorModel& sensor, const CoarseHistogramChoice& choice);

}  // namespace dtof
