// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "dtof/rival/rival.hpp"

namespace dtof {

/// Online expectation maximisation of a pulse on flat background (Poisson, Guicquero, Coriat and Sicard, a
/// 2-stage EM algorithm for online peak detection, CEA-Leti). A pixel stores the pulse's position mu and its
/// share w of the detections. With g = N(x; mu, sigma) T, T the range, each detection updates
///
///     r = w g / (w g + 1 - w);   w += (r - w) / 2^k;   mu += r (x - mu) / w / 2^k
///
/// sigma and the gain 2^-k follow a schedule that all pixels share. The schedule is a choice of this model:
/// the algorithm finds a pulse anywhere only if sigma starts at a quarter of the range. Over the first 3/4 of
/// the frame, in six stages, sigma falls geometrically from T / 4 towards the pulse's and k rises from 4 to
/// 6. The last quarter has the pulse's sigma and k = 7.
///
/// Word lengths: mu has 6 fraction bits and starts in the middle of the range. w has 16 bits, at least and
/// initially 1/64. g comes from a table of 32 steps of sigma / 8 with 4 fraction bits, 0 beyond. r has 8
/// bits; quotients are rounded to nearest. This makes 32 bits per pixel with NP = 10, and a divider that
/// works once per detection.
std::unique_ptr<Rival> make_online_em(const SensorModel& sensor);

/// Stage of the schedule, 0 to 6, in which an acquisition lies.
std::size_t online_em_stage(std::uint32_t acquisition, std::uint32_t acquisitions);

}  // namespace dtof
