// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/core/pulse_response.hpp"

namespace dtof {

/// Pulse and background as a pixel's TDC sees them. Times are in bins (T_res).
struct PulseObservation {
  double signal_events;      ///< mean signal events per acquisition, >= 0
  double background_events;  ///< mean background events per acquisition and T_int (2^np bins), >= 0
  double centre_bins;        ///< mean arrival time; may lie outside the range
  double sigma_bins;         ///< standard deviation of the pulse, > 0
  int np;  ///< bits of a timestamp, 1 .. 16; the last bin means "no detection" and holds no information
  double acquisitions;  ///< acquisitions per frame, >= 0
  int kept_events;      ///< events that the TDC keeps of an acquisition, 1 .. 16, earliest first; 0 = all
  std::shared_ptr<const PulseResponse> response = nullptr;  ///< measured pulse, in bins; null: Gaussian
};

/// Cramer-Rao bound (spec section 5): the least standard deviation, in bins, of any unbiased estimate of the
/// arrival time from one frame. Infinite if the frame holds no information (no signal, or a pulse outside the
/// range).
///
/// Information = acquisitions * sum over bins of w_i (d lambda_i / d tau)^2 / lambda_i.
///  - lambda_i is the event rate of bin i.
///  - w_i is the mean probability, over the bin, of fewer than `kept_events` earlier events. So w_i lambda_i
///    is the mean number of kept events; for one kept event it is the exact first-photon probability.
///  - The slope of a measured pulse is a difference over one bin (half a bin to either side), so that noise
///    of its samples does not count as information.
///
/// All codes are taken as equally wide. Throws InputError for a value outside its range.
double cramer_rao_bound(const PulseObservation& observation);

}  // namespace dtof
