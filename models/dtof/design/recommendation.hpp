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

/// A candidate and its measured errors.
struct DesignOption {
  DesignCandidate candidate;
  ReadoutScore screened;              ///< from one frame; compares parameters
  std::optional<ReadoutScore> score;  ///< from several frames; compares read-outs

  [[nodiscard]] const ReadoutScore& best_known() const { return score ? *score : screened; }
};

/// A copy of the limits with one of them changed.
struct LimitChange {
  std::string name;  ///< "area 10 % less"
  DesignLimits limits;
};
/// Returns copies of the limits, each with one finite limit 10 % tighter or 10 % looser.
std::vector<LimitChange> limit_changes(const DesignLimits& limits);

/// True if `one` has no larger share of errors above 3 % than `other`, as far as their intervals can tell.
bool as_good(const LightScore& one, const LightScore& other);

/// Returns the options that go to the final, by the frame that all options have read: for each read-out that
/// has options within the limits, the one with the smallest share of errors above 3 % at its worst light
/// level, and the smallest array of those that are as good (as_good).
std::vector<std::size_t> finalists(std::span<const DesignOption> options, const DesignLimits& limits);

/// A smaller array is preferred if its share of errors is at most this many times the smallest share, or at
/// most this share of all pixels larger.
inline constexpr double kGoodRatio = 1.05;
inline constexpr double kGoodDifference = 0.001;
/// Returns the largest share of errors with which a smaller array is preferred to one with the share
/// `smallest`.
double good_share(double smallest);

struct Recommendation {
  std::vector<std::size_t> within;  ///< best option of each read-out, in order of merit
  std::optional<std::size_t> chosen;
  std::optional<std::size_t> competitor;  ///< the choice if the chosen read-out were not available
};

/// Chooses among the finalists: the smallest array whose share of errors above 3 % at its worst light
/// level is at most good_share of the smallest share.
Recommendation recommend(std::span<const DesignOption> options, const DesignLimits& limits);

/// Returns the finalists that more frames could make the choice: those whose frames do not show, at
/// 95 %, that their share is larger than good_share of the smallest one. Empty if the frames settle the
/// choice: for each of them it shows whether a smaller array's share is at most good_share of the best one,
/// and that the best share is at most good_share of a larger array's. Frames of the same number are compared,
/// because read-outs with equal SLOTS see the same photons in them.
std::vector<std::size_t> contenders(std::span<const DesignOption> options, const DesignLimits& limits);

/// Change of a single limit, e.g. "--max-mm2 1.19", after which this read-out meets all limits.
struct SingleWay {
  std::string option;
  Readout readout;
};
std::vector<SingleWay> single_ways(std::span<const DesignCandidate> candidates, const DesignLimits& limits);

/// One line that says which single limit must change, to which value, for which read-out. If no single change
/// suffices, the line gives the least value of each limit that any read-out needs. Use it when no candidate
/// meets the limits.
std::string what_would_be_needed(std::span<const DesignCandidate> candidates, const DesignLimits& limits);

}  // namespace dtof
