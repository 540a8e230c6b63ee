// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "rivals/models/rival.hpp"

namespace dtof {

/// Online expectation maximisation of a pulse on flat background (Poisson, Guicquero, Coriat and Sicard, a
/// 2-stage EM algorithm for online peak detection, CEA-Leti): a pixel keeps the pulse's place mu and its
/// weight w among the detections. With g = N(x; mu, sigma) T, T the range, at each detection
///
///     r = w g / (w g + 1 - w);   w += (r - w) / 2^k;   mu += r (x - mu) / w / 2^k
///
/// sigma and the gain 2^-k follow a schedule that all pixels share, a choice of this model: a place is found
/// from anywhere only by a pulse that starts as wide as a quarter of the range. Over the first 3/4 of the
/// frame, in six stages, sigma falls geometrically from T / 4 towards the pulse's and k rises from 4 to 6;
/// the last quarter has the pulse's sigma and k = 7.
///
/// In numbers: mu with 6 fraction bits, from the middle of the range on; w of 16 bits, at least and at first
/// 1/64; g from a table of 32 steps of sigma / 8 with 4 fraction bits, 0 beyond; r of 8 bits; quotients
/// rounded to nearest. 32 bits a pixel with NP = 10, and a divider that works once a detection.
std::unique_ptr<Rival> make_online_em(const SensorModel& sensor);

/// Stage of the schedule, 0 to 6, in which an acquisition lies.
std::size_t online_em_stage(std::uint32_t acquisition, std::uint32_t acquisitions);

}  // namespace dtof
