// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/rival/rival.hpp"

namespace dtof {

/// Average of linearised timestamps, without a histogram (Tontini, Mazzucchi, Passerone, Broseghini and
/// Gasparini, FBK, IEEE Sensors Journal 24(4), 2024, arXiv 2310.09176).
///
/// The SPAD of a pixel is armed only after the code L of the last accepted detection; an acquisition without
/// such a detection begins a new sweep of the range. With x the first code of the acquisition that is later
/// than L:
///
///     x exists:   n += 1;  s += x;  L = x
///     otherwise:  L = before the first code
///
/// The photons of different pulses are independent. So the accepted codes of a sweep are the photons that a
/// SPAD without dead time detects in one acquisition, and their mean is not distorted by pile-up. An
/// acquisition either accepts a code or ends a sweep, so A acquisitions have w = A - n sweeps. The host takes
/// the flat background off:
///
///     position = (s - b m) / (n - b),   b = n0 w / w0,   m the middle of the range
///
/// The abstract leaves open how the background becomes known; this model takes a frame of as many
/// acquisitions without laser light first, which gives n0 and w0. The sensor's TDC delivers only the first
/// detections of an acquisition, so a pixel can miss a detection after L that an armed SPAD would have.
///
/// A pixel stores L (NP bits), n, and s (NP bits more than n). n0 leaves the chip with the first frame.
/// Words: n, s, n0.
std::unique_ptr<Rival> make_linearised_average(const SensorModel& sensor);

}  // namespace dtof
