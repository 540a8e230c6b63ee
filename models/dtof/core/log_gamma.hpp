// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace dtof {

/// ln |Gamma(x)|. std::lgamma writes the sign to a global variable, which threads would share.
inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace dtof
