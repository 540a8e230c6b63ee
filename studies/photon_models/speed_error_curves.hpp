// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Cost and error of the statistics of N frames with one photon model.
struct ErrorCurve {
  std::string model;
  std::vector<int> frames;            ///< N, ascending; empty for a model without random numbers
  std::vector<double> cpu_ms;         ///< photons of N frames of a pixel and one read-out; sum of all threads
  std::vector<double> error_percent;  ///< rms error of bias and relative precision, % of the distance
};

/// Frames are drawn and summed in blocks of this size.
inline constexpr int kCurveBlock = 100;

/// Numbers of frames are multiples of kCurveBlock, at least one block.
struct ErrorCurveSettings {
  std::vector<double> distances_m = {0.5, 1.0, 2.0, 3.0};
  double klux = 14.0;
  /// N of the curves, ascending. The last number is drawn, and divided into disjoint sets for the others.
  std::vector<int> frames = {100, 200, 500, 1000, 2000, 5000, 10'000, 20'000, 50'000, 100'000};
  int reference_frames = 400'000;  ///< separate frames of the exact model, which give the true values

  /// Throws InputError for empty lists or illegal numbers of frames.
  void validate() const;
};

/// Curves of the exact model and of the fast model's streams and sampler, and one point of the analytic
/// model. The error is the rms over distances, five read-outs, both quantities and the disjoint sets of N
/// frames. Noise falls with 1/sqrt(N), a model's own error stays. Errors depend on `seed`, not on `threads`.
/// Throws InputError for illegal settings, or for physics that PhotonSource refuses.
std::vector<ErrorCurve> speed_error_curves(const SensorModel& sensor, const ErrorCurveSettings& settings,
                                           std::uint64_t seed, int threads);

/// CPU ms at which a curve reaches `error_percent`, interpolated on logarithmic scales; NaN if it never does.
double cost_to_reach(const ErrorCurve& curve, double error_percent);

/// Figures from a set of frames of one pixel.
struct ErrorAnswer {
  double bias = 0.0;       ///< relative to the distance
  double precision = 0.0;  ///< relative precision (Eq. 3.14)
};

/// Figures of all blocks together. Throws InputError if they hold no frame.
ErrorAnswer error_answer(std::span<const ErrorStatistics> blocks, double distance_m);

/// Root mean square of the differences between measured and true figures; each answer has two differences
/// (bias and precision).
class AnswerError {
 public:
  void add(const ErrorAnswer& answer, const ErrorAnswer& truth);
  /// Adds the answer of each disjoint set of `blocks_a_set` >= 1 neighbouring blocks; an incomplete last set
  /// is left out.
  void add_sets(std::span<const ErrorStatistics> blocks, std::size_t blocks_a_set, double distance_m,
                const ErrorAnswer& truth);
  /// The root mean square in per cent; NaN if nothing was added.
  [[nodiscard]] double percent() const;

 private:
  double sum_ = 0.0;
  double count_ = 0.0;
};

/// Processor time of `run` in ms, summed over all threads: the minimum of `repeats` >= 1 runs, which excludes
/// most effects of caches and other programs.
double least_cpu_ms(const std::function<void()>& run, int repeats);

}  // namespace dtof
