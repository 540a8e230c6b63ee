// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "app/accuracy_study.hpp"
#include "app/thesis_statements.hpp"
#include "photon/sensor_model.hpp"

namespace dtof {

/// Where many frames are simulated of one pixel, and how.
struct FigureScene {
  SensorModel sensor;
  double klux = 0.0;
  double distance_m = 1.0;
  int frames = 1;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all processors
};

/// Middle 95 % and median of a figure over frames.
struct Spread {
  double low = 0.0;
  double median = 0.0;
  double high = 0.0;
};

/// Full histograms of single frames, built from the acquisitions before `acquisitions`.
struct HistogramPeaks {
  Spread count;                   ///< in the highest bin
  Spread bin;                     ///< its number as the thesis counts: bin k holds (k - 1, k], so code + 1
  double fake_share = 0.0;        ///< peaks more than 10 % of the distance off, by Eq. 3.11
  std::vector<double> one_frame;  ///< histogram of the first frame
};
HistogramPeaks histogram_peaks(const FigureScene& scene, std::uint32_t acquisitions);

/// What the TDC delivers against what arrives (Fig. 2.4).
struct PileUp {
  std::vector<double> arriving;   ///< mean events per frame and bin, without pile-up
  std::vector<double> delivered;  ///< the same after the TDC
  double arriving_fwhm_ns = 0.0;
  double delivered_fwhm_ns = 0.0;

  [[nodiscard]] double lost_share() const;
};
PileUp pile_up(const FigureScene& scene);

/// Full width at half maximum of a curve, in bins: the outermost crossings of half the maximum, interpolated.
/// Throws std::logic_error unless the curve crosses on both sides of its maximum.
double full_width_at_half_maximum(std::span<const double> curve);

/// Fig. 3.5: 17 counts in bin 195.
Judgement judge_peak(const HistogramPeaks& peaks, double count, double bin);
/// Fig. 2.4: fewer counts and a narrower pulse, the more so at the nearer target.
Judgement judge_pile_up(const PileUp& near, const PileUp& far);

}  // namespace dtof
