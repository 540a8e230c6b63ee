// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Random123/philox.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dtof {

inline constexpr std::size_t kPhiloxBatchBlocks = 16;

/// Writes the words of r123::Philox4x32's next kPhiloxBatchBlocks blocks from `counter`, of which the first
/// word counts: two 64-bit words a block, the first number of each in the upper half.
using PhiloxBatch = void (*)(const r123::Philox4x32::ctr_type& counter, const r123::Philox4x32::key_type& key,
                             std::uint64_t* words);

/// Those of this processor's vector instructions, the fastest first; all write the same words.
std::vector<PhiloxBatch> philox_batches();

}  // namespace dtof
