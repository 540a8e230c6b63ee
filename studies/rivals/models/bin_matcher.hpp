// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/host/range_converter.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// The host's part of a histogram of few, wide bins: the most likely place of one pulse on a flat background.
///
///     score(t) = sum over bins k of y[k] log(1 + r g[k](t))
///
/// g[k](t) is the share of the pulse that bin k has if the pulse's mean is in the middle of code t, r the
/// pulse's events over those of the background in one bin, both taken from the pixel's own bins: the
/// background from those away from the highest pair, the pulse from what the others have beyond it. r is
/// rounded to a step of a table, half an octave. A pulse that is wider than a bin shows in several, which is
/// what tells a code from the next. Codes are as in the matched filter of the single pixel
/// (readout/matched_filter.hpp), which this is for bins of one code. Pile-up is not known.
class BinMatcher {
 public:
  /// `bins` >= 4 bins of `bin_codes` codes each; together the codes 0 .. bins * bin_codes - 1.
  BinMatcher(const SensorModel& sensor, int bins, int bin_codes);

  /// Scores of the codes 0 .. bins * bin_codes - 1 for counts of each bin.
  [[nodiscard]] std::vector<double> scores(std::span<const std::int32_t> counts) const;
  /// The highest, refined by the parabola through its neighbours; the score is the confidence.
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> counts) const;
  /// Multiply-adds and comparisons of decode().
  [[nodiscard]] int operations() const {
    constexpr std::size_t kOfABin = 4;  // pairs, sums
    return static_cast<int>(codes_ * (taps_ + 1) + kOfABin * bins_);
  }

 private:
  /// Table of the step that fits these counts.
  [[nodiscard]] std::size_t step(std::span<const std::int32_t> counts) const;

  std::size_t bins_;
  std::size_t codes_;
  std::size_t margin_;              // bins on each side of the highest pair that may have some of the pulse
  std::size_t taps_;                // bins that a pulse may touch
  std::vector<std::size_t> first_;  // of each code
  std::vector<std::vector<double>> weights_;  // of each step: taps_ of each code
};

}  // namespace dtof
