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

/// Precision of the pulse's position from a pixel's memory.
struct CodePrecision {
  std::string code;    ///< e.g. "sketch M = 8"
  std::string family;  ///< e.g. "sketch"
  int values;          ///< numbers per pixel that leave the chip
  int bits;            ///< memory bits of a pixel; 0 for a reference that keeps every timestamp
  Estimate rmse;       ///< in codes
  double lost;         ///< share of pixels whose error exceeds three standard deviations of the pulse
};

/// One kind of photons, and the codes measured with them.
struct PaperScene {
  std::string name;
  std::string description;
  IndependentPhotons photons;
  double bound = 0.0;  ///< Cramer-Rao bound, in codes
  std::vector<CodePrecision> codes;

  /// Throws std::logic_error for a code that was not measured.
  [[nodiscard]] const CodePrecision& code(std::string_view name) const;
  /// Error of a code divided by that of `other`.
  [[nodiscard]] double ratio(std::string_view name, std::string_view other) const;
};

/// Whether a claim holds under all tested conditions, under some, or under none.
enum class ClaimVerdict { kHolds, kInPart, kFails };
std::string_view claim_verdict_word(ClaimVerdict verdict);
/// The verdict for the conditions of one claim, true where it holds.
ClaimVerdict claim_verdict(const std::vector<bool>& conditions);

/// A claim of a paper on its read-out, and the result of the project's model.
struct PaperClaim {
  std::string paper;
  std::string claim;   ///< in the project's words
  std::string test;    ///< what is compared, and the condition under which the claim holds
  std::string figure;  ///< the measured figures
  ClaimVerdict verdict;
};

struct PaperClaimSettings {
  std::size_t pixels = 2000;  ///< pixels for each kind of photons, at least 100
  std::uint64_t seed = 1;
  int threads = 0;
};

struct PaperClaims {
  std::vector<PaperScene> scenes;
  std::vector<PaperClaim> claims;
};

/// Up to this ratio an error counts as equal to that of the full histogram.
inline constexpr double kNegligibleLoss = 1.1;

/// Tests the claims in the papers' abstracts with the papers' photon statistics
/// (studies/common/independent_photons.hpp). The reference is a full histogram with a matched filter, which
/// is compared with the Cramer-Rao bound. Throws InputError for too few pixels.
PaperClaims judge_paper_claims(const PaperClaimSettings& settings);

}  // namespace dtof
