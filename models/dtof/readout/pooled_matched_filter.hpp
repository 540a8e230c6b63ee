// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "dtof/readout/matched_filter.hpp"

namespace dtof {

/// How much neighbouring pixels of a column are believed to share a surface.
struct PoolingPrior {
  /// Neighbours at most this many bins apart are on one surface; poolPointer's coarse bin, 1/32 of the
  /// range.
  int reach_bins = 32;
  /// Natural logarithm of the odds against a depth edge between two neighbours, >= 0 and finite.
  ///
  /// If an edge has probability 1/20, a neighbour's position is uniform over 65 bins without and over 1,023
  /// bins with one, and this is log((0.95 / 65) / (0.05 / 1023)).
  double edge_penalty = 5.7;
};

/// The yardstick for read-outs that pool: every pixel's full histogram, and the same chain along the column
/// that poolPointer has (docs/reference/poolpointer.md, "Chain"), but with every bin as a label and the
/// matched filter's log-likelihood ratio as its evidence. Max-product on a chain is exact: its positions have
/// the largest
///
///     sum over pixels of score_r(tau_r) - sum over neighbours of (|tau_r - tau_r+1| > reach ? edge_penalty :
///     0)
///
/// Each pixel takes its belief's best bin, refined by the parabola through its own scores. No hardware could
/// hold the 2^NP bins of every pixel of a large array; this runs on the host only.
///
/// `scores[r]` are pixel r's, all equally long and finite (MatchedFilter::scores). A result's position is on
/// the code axis in bins; its score is the belief's margin over the best bin further away than `reach_bins`,
/// 0 if there is none. Throws InputError for unequal or empty rows or a prior outside its range.
std::vector<MatchedFilter::Result> pool_column(std::span<const std::vector<double>> scores,
                                               const PoolingPrior& prior = {});

}  // namespace dtof
