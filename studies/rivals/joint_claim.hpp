// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rivals/paper_claims.hpp"

namespace dtof {

/// The claim of Parra et al. on codes that are optimised together with the laser's light. The photons are
/// those of rivals/joint_code.hpp, because the light is a part of the code.
PaperClaim codes_with_the_laser(const PaperClaimSettings& settings);

}  // namespace dtof
