// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rivals/models/rival.hpp"

namespace dtof {

/// A window of few bins around the last frame's depth (Edinburgh's guided dToF; FoveaSPAD, arXiv 2412.02052):
/// eight bins, whose window the host sets for each pixel before each frame. The result is that of the third
/// frame of a scene that does not move, and stays wrong where the first frame was:
///
///  1. bins of a 2^(NP-3), the whole range: the highest bin, the lowest of a tie;
///  2. bins of 2^(NP-5) around that bin's middle;
///  3. bins of 2^(NP-6) around what the host matched (BinMatcher) in the second frame.
///
/// Windows are moved into the range. On the chip: for begin <= x < begin + 8 bins, bin (x - begin) / width +=
/// 1, saturating at 2^count_bits - 1. The window's begin is a word of NP bits, and the first one that is
/// read.
struct GuidedWindowChoice {
  int count_bits = 10;  ///< 1 .. 16; sunlight fills 8 bits of the widest bins
};
std::unique_ptr<Rival> make_guided_window(const SensorModel& sensor, const GuidedWindowChoice& choice);

}  // namespace dtof
