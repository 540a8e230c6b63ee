// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace dtof {

inline constexpr double kSpeedOfLight = 299792458.0;  ///< m/s, exact (SI)

}  // namespace dtof
