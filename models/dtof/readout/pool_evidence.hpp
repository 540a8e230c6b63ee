// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "dtof/readout/pool_parts.hpp"

namespace dtof {

// Evidence for a target in a result of poolPointer. Names as in docs/reference/poolpointer.md, Significance
// and Confidence.

inline constexpr int kMostSignificance = 7;

/// lg(x) = 8 e + m for x = 2^e (1 + m / 8 + ...): 8 log2(x), at most 0.69 too small. x >= 1.
int eighth_octaves(std::uint32_t x);

/// Offset in eighth octaves by which a candidate's significance is reduced in long frames, whose sweeps hide
/// part of the background. 0 up to 3,839 acquisitions.
int significance_offset(std::uint32_t acquisitions);

/// A candidate's pair of bins and its neighbourhood.
struct CandidatePeak {
  std::size_t pair;  ///< index i of the pair in w
  bool raised;       ///< w[i] includes the prior's weight
  int missing;       ///< missing neighbours, 0 to 4; the group's own histogram replaces each
};
/// Significance Z of a candidate, 0 to 7: the logarithm of its height above the sums three and four pairs
/// away, in units of their spread. `sums` is w. `before` is w before the last candidate's leakage was
/// subtracted; it is used for the pairs above this candidate.
int significance(const PairSums& sums, const PairSums& before, const CandidatePeak& peak, int prior_weight,
                 int offset);

/// Z as a group word stores it in `bits`, which is 0, 2 or 3.
int kept_significance(int significance, int bits);

/// Margins of a pixel and its neighbours.
struct PooledMargin {
  int own;     ///< |margin|
  int others;  ///< sum over the neighbours above, below and to the left whose position is near
};
/// Confidence of a winner: the evidence, and at least 12 if the pixel's own margin is at least 12.
/// `significance`: largest stored significance of the group's candidates within a coarse bin of the winner.
/// `bits`: its width, above 0.
int pool_confidence(int significance, int bits, const PooledMargin& margin, int background, bool tilted);

}  // namespace dtof
