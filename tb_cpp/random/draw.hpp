// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "rtl/configuration.hpp"

namespace dtof {

/// The `index`-th configuration of `seed`: legal parameters of an array that is small enough to simulate in
/// seconds. The read-outs follow each other, so that 11 draws have all of them; every other parameter is
/// drawn from all of its legal values, a pool read-out's columns from one to several engines.
RtlConfiguration drawn_configuration(std::uint64_t seed, std::uint32_t index);

}  // namespace dtof
