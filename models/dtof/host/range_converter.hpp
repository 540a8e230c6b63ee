// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dtof/core/result.hpp"
#include "dtof/metrics/lookup_table.hpp"

namespace dtof {

/// Result of one pixel and frame.
struct Measurement {
  double position;    ///< code axis, bins: code + fraction / 2^FRACTION_BITS
  double confidence;  ///< on the read-out's own scale (docs/reference/readouts.md)

  bool operator==(const Measurement&) const = default;
};

/// Converts a result beat of the sensor.
Measurement to_measurement(const PixelResult& result, int fraction_bits);

/// Origin of a run's photons. Runs with equal identity saw the same photons. For recordings: any number that
/// differs between captures.
struct RunIdentity {
  std::uint64_t seed;
  std::uint32_t frame;

  // clang-tidy 14 objects to the 0 that the compiler uses in this comparison.
  auto operator<=>(const RunIdentity&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Repeated measurements of a target at a known distance.
struct TargetRun {
  RunIdentity identity;
  double distance_m;
  std::vector<Measurement> measurements;
};

/// The host's part of the read-out (thesis section 3.4): converts codes to metres by a monotone look-up
/// table, and rejects measurements of low confidence.
class RangeConverter {
 public:
  /// Fits the table to the median position of each run.
  ///
  /// The median is interpolated within the code step, so it is finer than a code; it tolerates up to half of
  /// the measurements as outliers. A run's weight is the reciprocal of its median's variance. The table ends
  /// where positions stop growing: beyond, the read-out no longer finds its target and would bend the table.
  ///
  /// `code_step` is the resolution of positions in bins: 1, 2^-FRACTION_BITS, or 0 for continuous positions.
  /// Throws InputError for fewer than two runs, an empty run, a distance that is not above 0, or values that
  /// are not finite.
  static RangeConverter calibrate(std::span<const TargetRun> runs, double code_step = 1.0);

  /// Sets the least confidence of accepted measurements. By default all are accepted.
  void set_least_confidence(double confidence) { least_confidence_ = confidence; }
  [[nodiscard]] double least_confidence() const { return least_confidence_; }
  /// Sets the lowest threshold at which at most `share` of the accepted measurements of `runs` have a
  /// relative error above `tolerance`. Returns false, without a change, if no threshold achieves this.
  bool choose_least_confidence(std::span<const TargetRun> runs, double share, double tolerance = 0.1);

  /// Distance in m, for any confidence.
  [[nodiscard]] double distance(double position) const { return table_.distance(position); }
  /// Distance in m; none if the measurement is rejected.
  [[nodiscard]] std::optional<double> convert(const Measurement& measurement) const;

  /// Distances in m of a run that tests this converter. Throws std::logic_error if a run of the same identity
  /// was used to calibrate: the errors would look too small.
  [[nodiscard]] std::vector<double> evaluate(const TargetRun& run) const;

  [[nodiscard]] const LookupTable& table() const { return table_; }
  /// Largest distance in the fit, m. Distances beyond it are extrapolated.
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  RangeConverter(LookupTable table, double reach_m, std::vector<RunIdentity> seen);

  LookupTable table_;
  double reach_m_;
  std::vector<RunIdentity> seen_;  // sorted
  double least_confidence_;
};

}  // namespace dtof
