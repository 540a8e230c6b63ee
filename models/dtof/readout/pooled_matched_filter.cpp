// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pooled_matched_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

/// The message from a pixel to its neighbour: at each bin the best of the pixel's bins within reach, or any
/// bin at the price of an edge, relative to its very best.
std::vector<double> message(const std::vector<double>& evidence, std::size_t reach, double edge_penalty) {
  const std::size_t bins = evidence.size();
  const double best = std::ranges::max(evidence);
  std::vector<double> outgoing(bins);
  std::deque<std::size_t> falling;  // bins of the window that can still become its maximum, largest first
  std::size_t next = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    for (; next < std::min(bin + reach + 1, bins); ++next) {
      while (!falling.empty() && evidence[falling.back()] <= evidence[next]) {
        falling.pop_back();
      }
      falling.push_back(next);
    }
    if (falling.front() + reach < bin) {
      falling.pop_front();
    }
    outgoing[bin] = std::max(evidence[falling.front()] - best, -edge_penalty);
  }
  return outgoing;
}

void add(const std::vector<double>& summand, std::vector<double>& sum) {
  std::ranges::transform(sum, summand, sum.begin(), std::plus<>());
}

/// Largest belief further than `reach` from `best`; that of `best` itself if no bin is.
double best_elsewhere(const std::vector<double>& belief, std::size_t best, std::size_t reach) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t bin = 0; bin < belief.size(); ++bin) {
    if (bin + reach < best || bin > best + reach) {
      largest = std::max(largest, belief[bin]);
    }
  }
  return std::isinf(largest) ? belief[best] : largest;
}

void validate(std::span<const std::vector<double>> scores, const PoolingPrior& prior) {
  if (prior.reach_bins < 0) {
    throw InputError(fmt::format("pooling: a reach of {} bins, but it must be at least 0", prior.reach_bins));
  }
  if (!std::isfinite(prior.edge_penalty) || prior.edge_penalty < 0.0) {
    throw InputError(fmt::format("pooling: an edge penalty of {}, but it must be finite and at least 0",
                                 prior.edge_penalty));
  }
  for (std::size_t row = 0; row < scores.size(); ++row) {
    if (scores[row].empty() || scores[row].size() != scores.front().size()) {
      throw InputError(fmt::format("pooling: pixel {} has {} scores, but pixel 0 has {}", row,
                                   scores[row].size(), scores.front().size()));
    }
  }
}

}  // namespace

std::vector<MatchedFilter::Result> pool_column(std::span<const std::vector<double>> scores,
                                               const PoolingPrior& prior) {
  validate(scores, prior);
  const std::size_t rows = scores.size();
  const auto reach = static_cast<std::size_t>(prior.reach_bins);
  // Evidence of each pixel and of all above it; then the beliefs, from the last row up.
  std::vector<std::vector<double>> beliefs(scores.begin(), scores.end());
  for (std::size_t row = 1; row < rows; ++row) {
    add(message(beliefs[row - 1], reach, prior.edge_penalty), beliefs[row]);
  }
  std::vector<double> from_below;  // evidence of a pixel and of all below it
  for (std::size_t row = rows; row-- > 0;) {
    std::vector<double> evidence = scores[row];
    if (row + 1 < rows) {
      const std::vector<double> incoming = message(from_below, reach, prior.edge_penalty);
      add(incoming, beliefs[row]);
      add(incoming, evidence);
    }
    from_below = std::move(evidence);
  }
  std::vector<MatchedFilter::Result> results;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::vector<double>& belief = beliefs[row];
    const auto best = static_cast<std::size_t>(std::ranges::max_element(belief) - belief.begin());
    results.push_back({refined_peak(scores[row], best), belief[best] - best_elsewhere(belief, best, reach)});
  }
  return results;
}

}  // namespace dtof
