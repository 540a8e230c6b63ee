// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/host/range_converter.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// The host's part of a histogram with few, wide bins: the most likely position of one pulse on a flat
/// background.
///
///     score(t) = sum over bins k of y[k] log(1 + r g[k](t))
///
/// y[k] is the count of bin k. g[k](t) is the share of the pulse in bin k if its mean is in the middle of
/// code t. r is the ratio of the pulse's events to the background events in one bin, taken from the pixel's
/// own bins. Bins away from the highest pair give the background; the excess of the others gives the pulse. r
/// is rounded to a step of a table, half an octave.
///
/// A pulse wider than a bin appears in several bins, which distinguishes codes within a bin. With bins of one
/// code, scores equal those of the matched filter of a single pixel (readout/matched_filter.hpp). Pile-up is
/// not modelled.
class BinMatcher {
 public:
  /// `bins` >= 4 bins of `bin_codes` codes each; they cover the codes 0 .. bins * bin_codes - 1.
  BinMatcher(const SensorModel& sensor, int bins, int bin_codes);

  /// Scores of the codes 0 .. bins * bin_codes - 1 for the counts of all bins.
  [[nodiscard]] std::vector<double> scores(std::span<const std::int32_t> counts) const;
  /// Position of the highest score, refined by the parabola through its neighbours; the score is the
  /// confidence.
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> counts) const;
  /// Number of multiply-adds and comparisons in decode().
  [[nodiscard]] int operations() const {
    constexpr std::size_t kOfABin = 4;  // pairs, sums
    return static_cast<int>(codes_ * (taps_ + 1) + kOfABin * bins_);
  }

 private:
  /// Index of the table whose step fits these counts.
  [[nodiscard]] std::size_t step(std::span<const std::int32_t> counts) const;

  std::size_t bins_;
  std::size_t codes_;
  std::size_t margin_;              // bins on each side of the highest pair that may hold part of the pulse
  std::size_t taps_;                // bins that a pulse may cover
  std::vector<std::size_t> first_;  // first covered bin, for each code
  std::vector<std::vector<double>> weights_;  // for each step: taps_ weights per code
};

}  // namespace dtof
