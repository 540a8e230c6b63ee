// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dtof/photon/sensor_model.hpp"
#include "dtof/rival/rival.hpp"

namespace dtof {

/// The state of a spiking network without TDC (MacLean, Stewart and Gyongy, arXiv 2401.10793; IISW 2025, doi
/// 10.60928/1tqh-z8bu). The network's input is the SPAD's pulse in time. A Legendre memory unit (Voelker,
/// Kajic and Eliasmith, NeurIPS 2019) keeps d numbers: the projections of the last window of the input on the
/// shifted Legendre polynomials P[0] .. P[d - 1]. A trained network reads them.
///
/// Here the window is one laser period, and a detection at x is a pulse of area 1. The state at the end of a
/// window then is a sum over its detections, and the sum over all acquisitions is a linear code of the
/// timestamps:
///
///     y[k] = sum over the detections of h sqrt((2 k + 1) / (2 d - 1)) P[k]((x + 1/2) / 2^NP)
///
/// in whole numbers, with h the largest number. A unit counts time back from the window's end: its odd
/// numbers have the other sign, which changes no result. With this scale flat background gives all numbers
/// the same noise, as the matcher expects; to a trained network any scale is the same.
///
/// The model is an upper bound of a network with a unit of this order. A unit's projection is approximate,
/// and keeps some of the windows before; the model's is exact. A network has neurons' noise and leaks; the
/// sum has none. The trained network, whose weights are not public, is replaced by the matched filter for
/// codes (CodeMatcher), which knows the pulse. The abstracts state neither d nor the width of a number, so
/// the list has the orders 8 and 16, and the 4 bits of its Fourier codes.

/// P[0](x) .. P[order - 1](x), for x from 0 to 1.
std::vector<double> legendre_polynomials(int order, double x);

/// The numbers of the code, weights[x * order + k] of `bits` bits, sign included: h is 2^(bits - 1) - 1.
/// Throws InputError unless `order` is 2 .. 32 and `bits` 2 .. 12.
std::vector<std::int16_t> legendre_weights(int np, int order, int bits);

/// Numbers of 4 bits, and counters that no frame fills, as a sketch has.
std::unique_ptr<Rival> make_legendre_memory(const SensorModel& sensor, int order);

}  // namespace dtof
