// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/pulse_response.hpp"

namespace dtof {

/// What a matched filter is matched to: a Gaussian or measured pulse on a flat background, per acquisition.
struct MatchedFilterParameters {
  int np = 10;                     ///< NP, 3 .. 16
  double sigma_bins = 1.0;         ///< standard deviation of the pulse in bins, > 0
  double signal_events = 1.0;      ///< mean signal events, > 0
  double background_events = 1.0;  ///< mean background events over all 2^np bins, > 0
  std::shared_ptr<const PulseResponse> response = nullptr;  ///< in bins; none: the Gaussian
  /// Mean events of each bin 0 .. 2^np - 2 in every pixel, of cover glass and fog: more background, which is
  /// known; empty: none.
  std::vector<double> returns = {};
};

/// Maximum-likelihood arrival time of one pulse from all detections of a frame: argmax over tau of
/// sum_i log(1 + A g(t_i - tau) / b(t_i)), A and b known. It needs every photon's time (a full histogram), so
/// it is no read-out for a large array, but the practical bound for all of them. Pile-up is not modelled:
/// near targets get a bias that the host's look-up table removes. Codes are taken as equally wide.
///
/// tau is searched on whole bins and refined by the parabola through the best three scores.
class MatchedFilter {
 public:
  struct Result {
    double position = 0.0;  ///< code axis (metrics/depth.hpp), 0 .. 2^np - 2; 0 without detections
    double score = 0.0;     ///< the sum at its maximum: log-likelihood ratio but for a constant
  };

  /// Throws InputError for a parameter outside its range.
  explicit MatchedFilter(const MatchedFilterParameters& parameters);

  /// One pixel's frame; the no-detection code is dropped. Throws InputError for a timestamp outside the
  /// range.
  Result estimate(std::span<const Detection> detections);

  /// The sum at every tau of 0 .. 2^np - 2: log-likelihood ratios but for a constant. Valid until the next
  /// call of either function. Throws InputError as `estimate` does.
  std::span<const double> scores(std::span<const Detection> detections);

 private:
  /// `peak_ratio`: signal over background at the pulse's peak.
  void match_gaussian(double sigma_bins, double peak_ratio);
  /// `bin_ratio`: all the signal over one bin's background.
  void match_response(const PulseResponse& response, double bin_ratio);
  /// Templates of the bins in which there is more than the flat background.
  void match_bins(const MatchedFilterParameters& parameters);

  std::size_t no_detection_;
  std::size_t reach_ = 1;         // bins on each side beyond which the template is negligible
  std::vector<double> template_;  // of tau - reach .. tau + reach for an event in bin tau: the pulse reversed
  std::vector<std::vector<double>> of_bin_;  // like template_, of a bin with returns; empty: template_
  std::vector<double> counts_;
  std::vector<double> scores_;  // with `reach_` bins of margin on both sides
};

/// Position of a peak between whole bins, by the parabola through the score at `peak` < scores.size() and its
/// two neighbours; `peak` itself at either end, and where it is no peak.
double refined_peak(std::span<const double> scores, std::size_t peak);

}  // namespace dtof
