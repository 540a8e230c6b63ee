// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "reproduction/thesis_statements.hpp"

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

/// Full histograms of single frames, built from the acquisitions before `acquisitions`
/// (Fig. 3.5, 3.13, 3.15).
struct HistogramPeaks {
  Spread count;                   ///< in the highest bin
  Spread bin;                     ///< its number as the thesis counts: bin k holds (k - 1, k], so code + 1
  Estimate fake_share;            ///< frames whose peak is more than 10 % of the distance off, by Eq. 3.11
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

/// A histogram turned on its circle, so that the highest bin (the first of several) has as many bins on both
/// sides (Fig. 3.6). The highest bin is then number size / 2.
std::vector<double> turned_to_peak(const std::vector<double>& histogram);

/// Share of a frame's counts that lie above its highest bin, that bin left out; mean over frames.
struct SideShares {
  Estimate as_counted;
  Estimate turned;                ///< after turned_to_peak
  std::vector<double> one_frame;  ///< turned histogram of the first frame
};
SideShares side_shares(const FigureScene& scene);

/// SiFH's second histogram (Fig. 3.9): window of Eq. 2.4 and 2.5 around the first half's coarse peak, filled
/// by the second half.
struct FineHistogram {
  Spread bin;                     ///< number of its highest bin in the full range, as the thesis counts
  double first_bin = 0.0;         ///< number of one_frame's first bin
  std::vector<double> one_frame;  ///< of the first frame
};
FineHistogram fine_histogram(const FigureScene& scene);

/// What hisPointer's filter with this GUARD leaves of the second half (Fig. 3.11).
struct FilteredCounts {
  int guard = 0;
  Spread kept;                    ///< share of the timestamps within 46 bins of the pulse's centre that pass
  std::vector<double> remaining;  ///< mean counts a frame and bin
};
FilteredCounts filtered_counts(const FigureScene& scene, int guard);

/// Full width at half maximum of a curve, in bins: the outermost crossings of half the maximum, interpolated.
/// Throws std::logic_error unless the curve crosses on both sides of its maximum.
double full_width_at_half_maximum(std::span<const double> curve);

/// Fig. 3.5: 17 counts in bin 195.
Judgement judge_peak(const HistogramPeaks& peaks, double count, double bin);
/// Fig. 3.6: turned, both sides of the peak have half of the counts each, within 2 %.
Judgement judge_sides(const SideShares& shares);
/// Fig. 3.9: the peak is in this bin.
Judgement judge_fine_peak(const FineHistogram& fine, double bin);
/// Fig. 3.11: the narrow filter cuts the pulse, the wide one keeps it, and the pointer's rmse shows it.
Judgement judge_filters(const FilteredCounts& narrow, const FilteredCounts& wide, const Estimate& narrow_rmse,
                        const Estimate& wide_rmse);
/// Fig. 3.15: the highest bin misses the target more often far away than near.
Judgement judge_far_peak(const HistogramPeaks& far, const HistogramPeaks& near);
/// Fig. 2.4: fewer counts and a narrower pulse, the more so at the nearer target.
Judgement judge_pile_up(const PileUp& near, const PileUp& far);

}  // namespace dtof
