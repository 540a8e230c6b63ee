// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "rtl/configuration.hpp"

namespace dtof {

/// Configuration number `index` of `seed`: an array with random legal parameters, small enough to simulate in
/// seconds. The read-outs take turns, so 11 draws include all of them. Every other parameter is drawn from
/// all its legal values; a pool read-out has one to several engines of columns.
RtlConfiguration drawn_configuration(std::uint64_t seed, std::uint32_t index);

}  // namespace dtof
