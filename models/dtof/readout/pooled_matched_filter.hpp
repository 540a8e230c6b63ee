// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "dtof/readout/matched_filter.hpp"

namespace dtof {

/// Prior probability that neighbouring pixels of a column share a surface.
struct PoolingPrior {
  /// Neighbours at most this many bins apart lie on one surface. Default: poolPointer's coarse bin, 1/32 of
  /// the range.
  int reach_bins = 32;
  /// Natural logarithm of the odds against a depth edge between two neighbours, >= 0 and finite.
  ///
  /// Example: an edge has probability 1/20. A neighbour's position is uniform over 65 bins without an edge
  /// and over 1,023 bins with one. Then the penalty is log((0.95 / 65) / (0.05 / 1023)).
  double edge_penalty = 5.7;
};

/// Reference for read-outs that combine pixels. Each pixel has its full histogram. The chain along the column
/// is poolPointer's (docs/reference/poolpointer.md, "Chain"), with every bin as a label and the matched
/// filter's log-likelihood ratio as evidence. Max-product on a chain is exact: the positions maximise
///
///     sum_r score_r(tau_r) - sum_r (|tau_r - tau_r+1| > reach ? edge_penalty : 0)
///
/// Each pixel takes its belief's best bin, refined by the parabola through its own scores. No hardware could
/// hold the 2^NP bins of every pixel of a large array, so this runs on the host only.
///
/// `scores[r]` are the scores of pixel r (MatchedFilter::scores), equally long for all and finite. A result's
/// position is on the code axis in bins. Its score is the belief's margin over the best bin further away than
/// `reach_bins`, 0 if there is none. Throws InputError for unequal or empty rows or a prior outside its
/// range.
std::vector<MatchedFilter::Result> pool_column(std::span<const std::vector<double>> scores,
                                               const PoolingPrior& prior = {});

}  // namespace dtof
