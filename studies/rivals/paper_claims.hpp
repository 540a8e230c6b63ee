// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/independent_photons.hpp"
#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

/// How exactly a pixel's memory tells the pulse's place.
struct CodePrecision {
  std::string code;    ///< e.g. "sketch M = 8"
  std::string family;  ///< e.g. "sketch"
  int values;          ///< numbers that leave a pixel
  int bits;            ///< of a pixel's memory; 0 for a reference that keeps every timestamp
  Estimate rmse;       ///< in codes
  double lost;         ///< share of pixels that are more than three standard deviations of the pulse off
};

/// One kind of photons, and all codes that were tried on them.
struct PaperScene {
  std::string name;
  std::string description;
  IndependentPhotons photons;
  double bound = 0.0;  ///< Cramer-Rao, in codes
  std::vector<CodePrecision> codes;

  /// Throws std::logic_error for a code that was not tried.
  [[nodiscard]] const CodePrecision& code(std::string_view name) const;
  /// How many times the error of `other` a code's is.
  [[nodiscard]] double ratio(std::string_view name, std::string_view other) const;
};

/// Whether a claim holds under all conditions that it is tested under, under some, or under none.
enum class ClaimVerdict { kHolds, kInPart, kFails };
std::string_view claim_verdict_word(ClaimVerdict verdict);

/// What a paper claims of its read-out, and what the project's model of it does.
struct PaperClaim {
  std::string paper;
  std::string claim;   ///< in the project's words
  std::string test;    ///< what is compared, and what counts as holding
  std::string figure;  ///< what came out
  ClaimVerdict verdict;
};

struct PaperClaimSettings {
  std::size_t pixels = 2000;  ///< of each kind of photons, at least 100
  std::uint64_t seed = 1;
  int threads = 0;
};

struct PaperClaims {
  std::vector<PaperScene> scenes;
  std::vector<PaperClaim> claims;
};

/// Up to here an error counts as that of the full histogram: one tenth more.
inline constexpr double kNegligibleLoss = 1.1;

/// Tests the claims that stand in the papers' abstracts, on photons as the papers have them
/// (study/independent_photons.hpp). The yardstick is a full histogram with a matched filter, which is held
/// against the Cramer-Rao bound. Throws InputError for too few pixels.
PaperClaims judge_paper_claims(const PaperClaimSettings& settings);

}  // namespace dtof
