// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/core/pulse_response.hpp"

namespace dtof {

/// What a pixel's TDC sees: a Gaussian or measured pulse on a flat background. Times in bins (T_res).
struct PulseObservation {
  double signal_events;      ///< mean signal events per acquisition, >= 0
  double background_events;  ///< mean background events per acquisition and T_int (2^np bins), >= 0
  double centre_bins;        ///< mean arrival time; may lie outside the range
  double sigma_bins;         ///< standard deviation of the pulse, > 0
  int np;               ///< bits of a timestamp, 1 .. 16; the last bin is "no detection" and tells nothing
  double acquisitions;  ///< acquisitions per frame, >= 0
  int kept_events;      ///< the TDC keeps the first 1 .. 16 events of an acquisition; 0 = all of them
  std::shared_ptr<const PulseResponse> response = nullptr;  ///< in bins; none: the Gaussian
};

/// Cramer-Rao bound (spec section 5): the least standard deviation, in bins, of any unbiased estimate of the
/// arrival time from one frame. Infinite where the frame tells nothing (no signal, a pulse outside the
/// range).
///
/// Information = acquisitions * sum over bins of w_i (d lambda_i / d tau)^2 / lambda_i, lambda_i the event
/// rate of bin i and w_i the mean probability over the bin of fewer than `kept_events` earlier events, so
/// that w_i lambda_i is the mean number of kept events (for one kept event the exact first-photon
/// probability). A measured pulse's slope is taken over a shift of one bin, half a bin to either side, so
/// that the noise of its samples passes for no information. Codes are taken as equally wide. Throws
/// InputError for a value outside its range.
double cramer_rao_bound(const PulseObservation& observation);

}  // namespace dtof
