// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "dtof/rival/rival.hpp"

namespace dtof {

/// A histogram in the pixel that reports by itself once its peak is significant (Liu, Zhang, Gyongy, Gorman,
/// Patanwala, Taneski and Henderson, arXiv 2509.19192; first in ISCAS 2025). The threshold follows the
/// background, as in a radar with a constant rate of false alarms (CFAR). The bin k of each detection is
/// tested after the detection is counted:
///
///     y[k] - r / m >= 6 sqrt(max(r / m, 2)),   r the sum of the m reference bins
///
/// Reference bins are the four bins on each side of k beyond two guard bins, as far as they exist. With
/// `early`, a bin that passes is the report, and the pixel counts no further detection in this frame. A pixel
/// without a report, and any pixel without `early`, takes its highest bin at the end of the frame. The
/// detection that would carry a bin over its limit is not counted, and neither are later ones, so that the
/// bins keep their proportion.
///
/// The abstracts leave open the number of bins, the reference bins, the factor and the least mean; those
/// above are choices of this model, with which about one pixel in a hundred reports background during a
/// frame. The 2.4 us of the paper's title belong to the circuit of its FPGA, which is not modelled; the
/// latency of this model is the number of acquisitions until the report.
///
/// Words: the bin, the counts of its left neighbour, of the bin and of its right neighbour (0 beyond the
/// range), r, m, and the acquisition of the report (the frame's number of acquisitions without one). The host
/// takes the centroid of the three counts less r / m each, negative ones as 0.
struct CfarChoice {
  int bin_bits = 5;    ///< 4 .. NP: 2^bin_bits bins over the range
  int count_bits = 8;  ///< 4 .. 16
  bool early = true;
};
std::unique_ptr<Rival> make_cfar_detector(const SensorModel& sensor, const CfarChoice& choice);

/// Probability that bin `peak` is the highest one of Poisson counts with these means (the lowest of equal
/// bins counts as the highest):
///
///     P = sum over n of P(y[peak] = n)  product over the bins j < peak of P(y[j] < n)
///                                       product over the bins j > peak of P(y[j] <= n)
///
/// This is the semi-closed form of a raw peak's detection, derived here from the definition.
double raw_peak_probability(std::span<const double> means, std::size_t peak);

}  // namespace dtof
