// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "rivals/paper_claims.hpp"

namespace dtof {

/// The claims of papers since 2023 on strong light, early reports and codes that include the laser;
/// judge_paper_claims() has them last. Each test states its own photons (rivals/flux_photons.hpp,
/// rivals/joint_code.hpp, common/independent_photons.hpp).
std::vector<PaperClaim> judge_recent_claims(const PaperClaimSettings& settings);

}  // namespace dtof
