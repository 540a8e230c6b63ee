// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "dtof/readout/pool_parts.hpp"

namespace dtof {

// How much speaks for a target in a result of poolPointer (docs/reference/poolpointer.md, Significance and
// Confidence, which have the same names).

inline constexpr int kMostSignificance = 7;

/// lg(x) = 8 e + m for x = 2^e (1 + m / 8 + ...): eight times log2(x), at most 0.69 too small. x >= 1.
int eighth_octaves(std::uint32_t x);

/// By how many eighth octaves the significance of a candidate falls in long frames, whose sweeps hide part of
/// the background. 0 up to 3,839 acquisitions.
int significance_offset(std::uint32_t acquisitions);

/// What a candidate stands out from.
struct CandidatePeak {
  std::size_t pair;  ///< i
  bool raised;       ///< w[i] has the prior's weight
  int missing;       ///< neighbours that the group does not have, 0 to 4: its own histogram stands for them
};
/// Z of a candidate, 0 to 7: the logarithm of its height above the sums three and four pairs away, in units
/// of their spread. `sums`: w; `before`: w before the last candidate took its leakage, which the pairs beyond
/// this one still have.
int significance(const PairSums& sums, const PairSums& before, const CandidatePeak& peak, int prior_weight,
                 int offset);

/// What a group's word keeps of Z in `bits`, 0, 2 or 3.
int kept_significance(int significance, int bits);

/// What a pixel's neighbours say of it.
struct PooledMargin {
  int own;     ///< |margin|
  int others;  ///< sum over those above, below and to the left whose position is near
};
/// Confidence of a winner. `significance`: the largest kept one of its group's candidates within a coarse bin
/// of the winner; `bits` of it, above 0.
int pool_confidence(int significance, int bits, const PooledMargin& margin, int background, bool tilted);

}  // namespace dtof
