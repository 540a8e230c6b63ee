// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "rtl/configuration.hpp"

namespace dtof {

/// Configuration number `index` of `seed`: an array with random legal parameters, small enough to simulate in
/// seconds. The read-outs take turns, so 11 draws include all of them. Every other parameter is drawn from
/// all its legal values; a pool read-out has one to several engines of columns.
RtlConfiguration drawn_configuration(std::uint64_t seed, std::uint32_t index);

/// Most status bits of a column in a simulated netlist. Each is a flip-flop; Yosys takes minutes to elaborate
/// 2^16 of them, before any mapping and simulation.
inline constexpr int kMostStatusBits = 4096;

/// The array whose netlist is simulated in place of `drawn`: SIGNALLED_CLEAR is 0 if three pixels, as
/// `make sim-netlist` has, would have more than kMostStatusBits.
RtlConfiguration netlist_configuration(const RtlConfiguration& drawn);

}  // namespace dtof
