// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/core/result.hpp"

namespace dtof {

/// Position of a result on the code axis, in bins: code + fraction / 2^fraction_bits.
double code_position(const PixelResult& result, int fraction_bits);

/// Conversion between code position and depth: Eq. 3.11, with the middle of the code as its time (spec
/// section 3). R = c/2 (T_res (position + 0.5) - FWHM).
class DepthScale {
 public:
  /// T_res = integration_time_s / 2^np. Throws InputError unless time and FWHM are finite, time > 0, FWHM >=
  /// 0 and np 1 .. 16.
  DepthScale(double integration_time_s, int np, double fwhm_s);

  /// Depth in m; negative for a position earlier than the pulse of a target at 0 m.
  [[nodiscard]] double depth(double position) const;
  /// Inverse of `depth`: position in bins of a depth in m.
  [[nodiscard]] double position(double depth_m) const;
  /// Depth of one bin in m: c/2 T_res.
  [[nodiscard]] double bin_depth() const { return bin_depth_; }

 private:
  double bin_depth_;
  double offset_;  // m, the depth equivalent of FWHM
};

}  // namespace dtof
