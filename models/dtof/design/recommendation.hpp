// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/design/bench.hpp"
#include "dtof/design/candidates.hpp"

namespace dtof {

/// A candidate with what it is worth.
struct DesignOption {
  DesignCandidate candidate;
  ReadoutScore screened;              ///< of one frame, to compare parameters
  std::optional<ReadoutScore> score;  ///< of several frames, to compare read-outs

  [[nodiscard]] const ReadoutScore& best_known() const { return score ? *score : screened; }
};

/// One of several limits, changed.
struct LimitChange {
  std::string name;  ///< "area 10 % less"
  DesignLimits limits;
};
/// Copies of the limits, in each of which one finite limit is 10 % tighter or 10 % looser. Infinite limits
/// stay as they are.
std::vector<LimitChange> limit_changes(const DesignLimits& limits);

/// Whether no more pixels are off in the first than in the second, as far as their intervals can tell.
bool as_good(const LightScore& one, const LightScore& other);

/// The best parameters of each read-out that has an option within the limits: those with fewest pixels that
/// are more than 3 % off in the worst light; the smallest array of those that are as good.
std::vector<std::size_t> representatives(std::span<const DesignOption> options, const DesignLimits& limits);

struct Recommendation {
  std::vector<std::size_t> within;  ///< a representative of each read-out, best first
  std::optional<std::size_t> chosen;
  std::optional<std::size_t> competitor;  ///< what would be chosen of the other read-outs
};

/// By the same rule between read-outs.
Recommendation recommend(std::span<const DesignOption> options, const DesignLimits& limits);

/// A limit that alone would have to become another, e.g. "--max-mm2 1.19", so that this read-out keeps all.
struct SingleWay {
  std::string option;
  Readout readout;
};
std::vector<SingleWay> single_ways(std::span<const DesignCandidate> candidates, const DesignLimits& limits);

/// One line that says which single limit would have to become what, and for which read-out; if no single one
/// suffices, the least of each that any read-out needs. For limits that no candidate keeps.
std::string what_would_be_needed(std::span<const DesignCandidate> candidates, const DesignLimits& limits);

}  // namespace dtof
