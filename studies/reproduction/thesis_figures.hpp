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

/// Settings for many simulated frames of one pixel.
struct FigureScene {
  SensorModel sensor;
  double klux = 0.0;
  double distance_m = 1.0;
  int frames = 1;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all processors
};

/// Median and central 95 % of a figure over frames.
struct Spread {
  double low = 0.0;
  double median = 0.0;
  double high = 0.0;
};

/// Statistics of full histograms of single frames, from the acquisitions before `acquisitions` (Fig. 3.5,
/// 3.13, 3.15).
struct HistogramPeaks {
  Spread count;         ///< count of the highest bin
  Spread bin;           ///< its number as in the thesis: bin k holds (k - 1, k], so code + 1
  Estimate fake_share;  ///< share of frames whose peak is more than 10 % of the distance off, by Eq. 3.11
  std::vector<double> one_frame;  ///< histogram of the first frame
};
HistogramPeaks histogram_peaks(const FigureScene& scene, std::uint32_t acquisitions);

/// Events that arrive compared with those that the TDC delivers (Fig. 2.4).
struct PileUp {
  std::vector<double> arriving;   ///< mean events per frame and bin, without pile-up
  std::vector<double> delivered;  ///< mean events per frame and bin after the TDC
  double arriving_fwhm_ns = 0.0;
  double delivered_fwhm_ns = 0.0;

  [[nodiscard]] double lost_share() const;
};
PileUp pile_up(const FigureScene& scene);

/// Histogram rotated on its circle so that the highest bin (the first on a tie) has the same number of bins
/// on both sides (Fig. 3.6). Its index is then size / 2.
std::vector<double> turned_to_peak(const std::vector<double>& histogram);

/// Share of a frame's counts above the highest bin, which is not counted; mean over frames.
struct SideShares {
  Estimate as_counted;
  Estimate turned;                ///< after turned_to_peak
  std::vector<double> one_frame;  ///< rotated histogram of the first frame
};
SideShares side_shares(const FigureScene& scene);

/// SiFH's second histogram (Fig. 3.9): the window of Eq. 2.4 and 2.5 around the coarse peak of the first
/// half, filled from the second half.
struct FineHistogram {
  Spread bin;                     ///< number of its highest bin in the full range, as in the thesis
  double first_bin = 0.0;         ///< number of one_frame's first bin
  std::vector<double> one_frame;  ///< histogram of the first frame
};
FineHistogram fine_histogram(const FigureScene& scene);

/// Timestamps of the second half that pass hisPointer's filter (Fig. 3.11).
struct FilteredCounts {
  int guard = 0;                  ///< side band of the filter, bins
  Spread kept;                    ///< share of the timestamps within 46 bins of the pulse's centre that pass
  std::vector<double> remaining;  ///< mean counts per frame and bin
};
/// A side band for tables and pictures: its parameter and its bins.
std::string guard_title(int guard);
FilteredCounts filtered_counts(const FigureScene& scene, int guard);

/// Full width at half maximum of a curve, in bins: distance of the outermost crossings of half the maximum,
/// interpolated. Throws std::logic_error unless the curve crosses on both sides of its maximum.
double full_width_at_half_maximum(std::span<const double> curve);

/// Fig. 3.5: the peak has 17 counts in bin 195.
Judgement judge_peak(const HistogramPeaks& peaks, double count, double bin);
/// Fig. 3.6: after rotation, both sides of the peak have half of the counts each, within 2 %.
Judgement judge_sides(const SideShares& shares);
/// Fig. 3.9: the peak is in this bin.
Judgement judge_fine_peak(const FineHistogram& fine, double bin);
/// Fig. 3.11: the narrow filter cuts the pulse, the wide one keeps it, and the pointer's rmse shows it.
Judgement judge_filters(const FilteredCounts& narrow, const FilteredCounts& wide, const Estimate& narrow_rmse,
                        const Estimate& wide_rmse);
/// Fig. 3.15: the highest bin misses the target more often far away than near.
Judgement judge_far_peak(const HistogramPeaks& far, const HistogramPeaks& near);
/// Fig. 2.4: fewer counts and a narrower pulse, more so at the nearer target.
Judgement judge_pile_up(const PileUp& near, const PileUp& far);

}  // namespace dtof
