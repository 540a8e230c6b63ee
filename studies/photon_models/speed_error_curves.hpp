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

/// What the statistics of N frames cost with one photon model, and how far they are from the truth.
struct ErrorCurve {
  std::string model;
  std::vector<int> frames;     ///< N, ascending; empty for a model that draws none
  std::vector<double> cpu_ms;  ///< photons of N frames of a pixel and one read-out, all threads added up
  std::vector<double> error_percent;  ///< rms error of bias and relative precision, % of the distance
};

/// Frames are drawn and summed up in blocks of this many.
inline constexpr int kCurveBlock = 100;

/// Numbers of frames are multiples of kCurveBlock, from one block up.
struct ErrorCurveSettings {
  std::vector<double> distances_m = {0.5, 1.0, 2.0, 3.0};
  double klux = 14.0;
  /// N of the curves, ascending; the last is drawn, and cut into disjoint sets of the others.
  std::vector<int> frames = {100, 200, 500, 1000, 2000, 5000, 10'000, 20'000, 50'000, 100'000};
  int reference_frames = 400'000;  ///< other frames of the exact model, whose answer is the truth

  /// Throws InputError for empty lists or numbers of frames as they must not be.
  void validate() const;
};

/// Curves of the exact model, the fast one's streams and sampler, and one point of the analytic model. The
/// error is the rms over the distances, five read-outs, both quantities and the disjoint sets of N frames.
/// Noise falls with 1/sqrt(N), a model's own error stays. Errors depend on `seed`, not on `threads`.
/// Throws InputError for illegal settings, or physics as PhotonSource does.
std::vector<ErrorCurve> speed_error_curves(const SensorModel& sensor, const ErrorCurveSettings& settings,
                                           std::uint64_t seed, int threads);

/// CPU ms of a frame by photon model, photons and one read-out.
struct ModelCosts {
  double exact_stream_ms = 0.0;
  double fast_stream_ms = 0.0;
  double fast_sampler_ms = 0.0;
};

/// CPU ms at which a curve reaches an error of `error_percent`, interpolated between its points on
/// logarithmic scales; not a number if it does not get there.
double cost_to_reach(const ErrorCurve& curve, double error_percent);

/// Three lines a user can act on, as a Markdown list: the cheapest model for a stream, for a sampler, and for
/// a sweep of several errors. Each is computed from the figures.
std::string advice(const ModelCosts& costs, const std::vector<ErrorCurve>& curves);

/// What a set of frames of one pixel says.
struct ErrorAnswer {
  double bias = 0.0;       ///< relative to the distance
  double precision = 0.0;  ///< relative precision (Eq. 3.14)
};

/// The errors of all blocks together. Throws InputError if they hold no frame.
ErrorAnswer error_answer(std::span<const ErrorStatistics> blocks, double distance_m);

/// Root of the mean squared difference of answers from the truth, two differences (bias and precision) an
/// answer.
class AnswerError {
 public:
  void add(const ErrorAnswer& answer, const ErrorAnswer& truth);
  /// The answer of each disjoint set of `blocks_a_set` (>= 1) neighbouring blocks; a rest that fills no set
  /// is left out.
  void add_sets(std::span<const ErrorStatistics> blocks, std::size_t blocks_a_set, double distance_m,
                const ErrorAnswer& truth);
  /// NaN if nothing was added.
  [[nodiscard]] double percent() const;

 private:
  double sum_ = 0.0;
  double count_ = 0.0;
};

/// Processor time of `run` in ms, all threads added up: the least of `repeats` (>= 1) runs, as what caches
/// and other programs add is not the run's own.
double least_cpu_ms(const std::function<void()>& run, int repeats);

}  // namespace dtof
