// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/rival/rival.hpp"

namespace dtof {

/// A window of eight bins around the last frame's depth, set by the host for each pixel before each frame
/// (Edinburgh's guided dToF; FoveaSPAD, arXiv 2412.02052). The result is that of the third frame of a static
/// scene; it stays wrong if the first frame was wrong:
///
///  1. Bins of 2^(NP-3) codes over the whole range: the highest bin, the lowest on a tie.
///  2. Bins of 2^(NP-5) codes around the middle of that bin.
///  3. Bins of 2^(NP-6) codes around the host's match (BinMatcher) of the second frame.
///
/// Windows are shifted into the range. On the chip: for begin <= x < begin + 8 bins, bin (x - begin) / width
/// += 1, saturating at 2^count_bits - 1. The begin of the window is a word of NP bits, the first word read.
struct GuidedWindowChoice {
  int count_bits = 10;  ///< 1 .. 16; sunlight fills 8 bits of the widest bins
};
std::unique_ptr<Rival> make_guided_window(const SensorModel& sensor, const GuidedWindowChoice& choice);

}  // namespace dtof
