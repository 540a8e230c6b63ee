// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Random123/philox.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dtof {

inline constexpr std::size_t kPhiloxBatchBlocks = 16;

/// Writes the next kPhiloxBatchBlocks blocks of r123::Philox4x32, starting at `counter`. Each block gives two
/// 64-bit words, with the block's first number in the upper half. Only the first word of `counter` is
/// incremented.
using PhiloxBatch = void (*)(const r123::Philox4x32::ctr_type& counter, const r123::Philox4x32::key_type& key,
                             std::uint64_t* words);

/// Implementations for this processor's vector instructions, fastest first. All write the same words.
std::vector<PhiloxBatch> philox_batches();

}  // namespace dtof
