// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "rivals/paper_claims.hpp"

namespace dtof {

/// Codes of the full histogram with which the claims compare.
inline constexpr std::string_view kFull = "full histogram, matched filter";
inline constexpr std::string_view kFullPeak = "1024 bins, highest";

/// Judges the claims that compare codes on the same photons. `scenes`: even, sunlit, narrow and fine photons,
/// in this order. `even`, `narrow`: errors of each pixel for these two scenes.
std::vector<PaperClaim> claims_of_scenes(std::span<const PaperScene> scenes, const PlaceErrors& even,
                                         const PlaceErrors& narrow);

}  // namespace dtof
