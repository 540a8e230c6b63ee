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

/// What the sensor delivered for one pixel of one frame.
struct Measurement {
  double position;    ///< code axis, bins: code + fraction / 2^FRACTION_BITS
  double confidence;  ///< on the read-out's own scale (docs/reference/readouts.md)

  bool operator==(const Measurement&) const = default;
};

/// A result beat as the sensor sends it.
Measurement to_measurement(const PixelResult& result, int fraction_bits);

/// Where a run's photons came from. Runs of equal identity saw the same photons. For recordings: any number
/// that tells captures apart.
struct RunIdentity {
  std::uint64_t seed;
  std::uint32_t frame;

  // clang-tidy 14 objects to the 0 with which the compiler makes this comparison.
  auto operator<=>(const RunIdentity&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Repeated measurements of a target at a known distance.
struct TargetRun {
  RunIdentity identity;
  double distance_m;
  std::vector<Measurement> measurements;
};

/// The host's side of the read-out (thesis section 3.4): codes to metres by a monotone look-up table, and
/// rejection of measurements with too little confidence.
class RangeConverter {
 public:
  /// Fits the table to the median position of each run (interpolated within the step of the code, so that a
  /// median of whole codes is finer than a code; robust up to half of the measurements outlying). A run
  /// weighs as the reciprocal of its median's variance, and the table ends where positions stop growing: a
  /// read-out that no longer finds its target would otherwise bend the table for the distances it does find.
  /// `code_step` is the resolution of positions in bins: 1, 2^-FRACTION_BITS, or 0 for continuous positions.
  /// Throws InputError for fewer than two runs, an empty run, a distance that is not above 0, or values that
  /// are not finite.
  static RangeConverter calibrate(std::span<const TargetRun> runs, double code_step = 1.0);

  /// Measurements below `confidence` are rejected from now on (default: none is).
  void set_least_confidence(double confidence) { least_confidence_ = confidence; }
  [[nodiscard]] double least_confidence() const { return least_confidence_; }
  /// Sets the lowest threshold at which, over all `runs`, at most `share` of the accepted measurements are
  /// more than `tolerance` (relative) off the true distance. False, and nothing changed, if no threshold is.
  bool choose_least_confidence(std::span<const TargetRun> runs, double share, double tolerance = 0.1);

  /// Distance in m, whatever the confidence.
  [[nodiscard]] double distance(double position) const { return table_.distance(position); }
  /// Distance in m, or nothing if rejected.
  [[nodiscard]] std::optional<double> convert(const Measurement& measurement) const;

  /// Distances of a run that measures how good this converter is. Throws std::logic_error if the run, or
  /// another of the same identity, was used to calibrate: its errors would look too small.
  [[nodiscard]] std::vector<double> evaluate(const TargetRun& run) const;

  [[nodiscard]] const LookupTable& table() const { return table_; }
  /// Largest distance that the table was fitted to, m; beyond it, distances are extrapolated.
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  RangeConverter(LookupTable table, double reach_m, std::vector<RunIdentity> seen);

  LookupTable table_;
  double reach_m_;
  std::vector<RunIdentity> seen_;  // sorted
  double least_confidence_;
};

}  // namespace dtof
