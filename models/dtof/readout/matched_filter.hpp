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

/// Pulse and background of the matched filter: a Gaussian or measured pulse on a flat background. Events are
/// per acquisition.
struct MatchedFilterParameters {
  int np = 10;                     ///< NP, 3 .. 16
  double sigma_bins = 1.0;         ///< standard deviation of the pulse in bins, > 0
  double signal_events = 1.0;      ///< mean signal events, > 0
  double background_events = 1.0;  ///< mean background events over all 2^np bins, > 0
  std::shared_ptr<const PulseResponse> response = nullptr;  ///< measured pulse, in bins; null: Gaussian
  /// Mean events of cover glass and fog in each bin 0 .. 2^np - 2, equal in all pixels. They count as
  /// additional, known background. Empty: none.
  std::vector<double> returns = {};
};

/// Maximum-likelihood arrival time of one pulse from all detections of a frame: the argmax over tau of sum_i
/// log(1 + A g(t_i - tau) / b(t_i)), with A and b known.
///
/// The filter needs every photon's time (a full histogram), which no large array can store. It serves as the
/// practical bound for all read-outs. Pile-up is not modelled: near targets get a bias that the host's
/// look-up table removes. Codes are taken as equally wide.
///
/// tau is searched on whole bins and refined by the parabola through the best score and its neighbours.
class MatchedFilter {
 public:
  struct Result {
    double position = 0.0;  ///< on the code axis (metrics/depth.hpp), 0 .. 2^np - 2; 0 without detections
    double score = 0.0;     ///< maximum of the sum: a log-likelihood ratio up to a constant
  };

  /// Throws InputError for a parameter outside its range.
  explicit MatchedFilter(const MatchedFilterParameters& parameters);

  /// Arrival time from one pixel's frame; the no-detection code is ignored. Throws InputError for a timestamp
  /// outside the range.
  Result estimate(std::span<const Detection> detections);

  /// The sum for every tau in 0 .. 2^np - 2: log-likelihood ratios up to a constant. Valid until the next
  /// call of either function. Throws InputError as `estimate` does.
  std::span<const double> scores(std::span<const Detection> detections);

 private:
  /// `peak_ratio`: signal divided by background at the pulse's peak.
  void match_gaussian(double sigma_bins, double peak_ratio);
  /// `bin_ratio`: the whole signal divided by one bin's background.
  void match_response(const PulseResponse& response, double bin_ratio);
  /// Templates of the bins whose background exceeds the flat one.
  void match_bins(const MatchedFilterParameters& parameters);

  std::size_t no_detection_;
  std::size_t reach_ = 1;         // bins on each side beyond which the template is negligible
  std::vector<double> template_;  // of tau - reach .. tau + reach for an event in bin tau: the pulse reversed
  std::vector<std::vector<double>> of_bin_;  // like template_, of a bin with returns; empty: template_
  std::vector<double> counts_;
  std::vector<double> scores_;  // with `reach_` bins of margin on both sides
};

/// Position of a peak between whole bins, from the parabola through the score at `peak` < scores.size() and
/// its two neighbours. Returns `peak` itself at either end, and if the score there is no maximum.
double refined_peak(std::span<const double> scores, std::size_t peak);

}  // namespace dtof
