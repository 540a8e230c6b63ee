// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace dtof {

/// ln |Gamma(x)|, thread-safe. (std::lgamma writes the sign to a global variable.)
inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace dtof
