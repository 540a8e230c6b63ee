// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/random.hpp"

#include "dtof/core/philox.hpp"

namespace dtof {

void CounterRandom::fill(std::span<std::uint64_t> words) {
  static const std::vector<PhiloxBatch> batches = philox_batches();
  std::size_t i = 0;
  if (!batches.empty()) {
    constexpr std::size_t kBatchWords = 2 * kPhiloxBatchBlocks;
    for (; i + kBatchWords <= words.size(); i += kBatchWords) {
      batches.front()(counter_, key_, &words[i]);
      counter_[0] += kPhiloxBatchBlocks;
    }
  }
  for (; i < words.size(); i += 2, ++counter_[0]) {
    const r123::Philox4x32::ctr_type block = r123::Philox4x32()(counter_, key_);
    words[i] = (std::uint64_t{block[0]} << 32U) | block[1];
    words[i + 1] = (std::uint64_t{block[2]} << 32U) | block[3];
  }
}

}  // namespace dtof
