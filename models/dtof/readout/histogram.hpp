// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dtof/readout/pass_schedule.hpp"

namespace dtof {

/// Result of a peak search over a histogram.
struct HistogramPeak {
  std::uint32_t bin = 0;    ///< largest count, lowest index on a tie; 0 for an empty histogram
  std::uint32_t count = 0;  ///< count of `bin`
  std::uint32_t sum = 0;    ///< sum of all counts
};

/// The highest sum of two neighbouring bins, and the sums of the pairs before and behind, each of which
/// shares a bin with it. Bins outside the histogram count as 0.
struct PairPeak {
  std::uint32_t edge = 1;    ///< upper bin of the pair, so the border between its bins; lowest on a tie
  std::uint32_t before = 0;  ///< sum of the lower bin and the one before it
  std::uint32_t count = 0;   ///< sum of the pair
  std::uint32_t behind = 0;  ///< sum of the upper bin and the one behind it
  std::uint32_t sum = 0;     ///< sum of all counts
};

/// Height of the peak above the mean of the other bins, never negative, for 2^bin_bits bins
/// (docs/reference/readouts.md, "Histogram confidence").
constexpr std::uint16_t histogram_confidence(const HistogramPeak& peak, int bin_bits) {
  const std::uint32_t mean_of_rest = (peak.sum - peak.count) >> static_cast<unsigned>(bin_bits);
  return static_cast<std::uint16_t>(peak.count - std::min(peak.count, mean_of_rest));
}

/// Position of a histogram's bins: bin b begins at code first + (b << shift).
struct HistogramBins {
  std::int32_t first = 0;  ///< may be negative
  int shift = 0;
};

/// Behaviour after the first full bin, i.e. a count of 2^count_width - 1 (docs/reference/readouts.md, "Full
/// counters").
enum class FullBin : std::uint8_t {
  kFreezes,  ///< all counting stops until the next scan
  kStays,    ///< the full bin stays full; other bins still count
};

/// Histogram of counters that never wrap. Scan and clear visit only bins that were counted, so a pass costs
/// time by its detections, not its bins.
class Histogram {
 public:
  /// 2^bin_bits bins (bin_bits 0 .. 16) of count_width bits (1 .. 16).
  Histogram(int bin_bits, int count_width, FullBin full)
      : counts_(std::size_t{1} << static_cast<unsigned>(bin_bits)),
        touched_(counts_.size() + 1),  // `add` writes one entry past the last touched bin
        limit_(static_cast<std::uint16_t>((1U << static_cast<unsigned>(count_width)) - 1)),
        step_when_full_(full == FullBin::kFreezes ? 0 : 1) {}

  void add(std::uint32_t bin) {
    std::uint16_t& count = counts_[bin];
    touched_[touched_count_] = static_cast<std::uint16_t>(bin);
    touched_count_ += count == 0 ? step_ : 0U;
    count = static_cast<std::uint16_t>(count + (count < limit_ ? step_ : 0U));
    step_ = count == limit_ ? step_when_full_ : step_;
  }

  /// From now on, peak searches copy all counts to `counts` before clearing; null: no copy.
  void copy_counts_to(std::vector<std::uint16_t>* counts) { copy_ = counts; }

  /// Finds the peak, then clears the histogram.
  HistogramPeak take_peak() {
    if (copy_ != nullptr) {
      *copy_ = counts_;
    }
    // Count in the upper half, complemented index in the lower: the maximum is the lowest bin of a tie.
    std::uint32_t best = kIndexMask;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < touched_count_; ++i) {
      const std::uint32_t bin = touched_[i];
      const std::uint32_t count = counts_[bin];
      counts_[bin] = 0;
      sum += count;
      best = std::max(best, (count << 16U) | (kIndexMask - bin));
    }
    touched_count_ = 0;
    step_ = 1;
    return {kIndexMask - (best & kIndexMask), best >> 16U, sum};
  }

  /// Finds the highest pair of bins, then clears the histogram. Needs at least two bins.
  PairPeak take_pair_peak() {
    if (copy_ != nullptr) {
      *copy_ = counts_;
    }
    const auto pair = [this](std::size_t upper) {
      return std::uint32_t{counts_[upper - 1]} + (upper < counts_.size() ? counts_[upper] : 0U);
    };
    PairPeak peak;
    peak.count = pair(1);
    for (std::size_t upper = 2; upper < counts_.size(); ++upper) {
      if (pair(upper) > peak.count) {
        peak.edge = static_cast<std::uint32_t>(upper);
        peak.count = pair(upper);
      }
    }
    peak.before = peak.edge > 1 ? pair(peak.edge - 1) : counts_[0];
    peak.behind = pair(peak.edge + 1);
    for (std::size_t i = 0; i < touched_count_; ++i) {
      peak.sum += counts_[touched_[i]];
      counts_[touched_[i]] = 0;
    }
    touched_count_ = 0;
    step_ = 1;
    return peak;
  }

 private:
  static constexpr std::uint32_t kIndexMask = 0xFFFF;

  std::vector<std::uint16_t> counts_;
  std::vector<std::uint16_t> touched_;
  std::size_t touched_count_ = 0;
  std::uint16_t limit_;
  std::uint32_t step_when_full_;
  std::uint32_t step_ = 1;  // added per detection; 0: frozen
  std::vector<std::uint16_t>* copy_ = nullptr;
};

/// A pass that keeps timestamps with a given prefix and counts their next bits in a histogram. Used by every
/// coarse pass, the steps of three steps, FiFH's fine pass and PiFH's runs.
struct PrefixPass {
  std::uint32_t end;  ///< the pass ends before this acquisition
  int prefix_shift;   ///< keeps x >> prefix_shift == prefix
  int bin_shift;      ///< bin = low bits of x >> bin_shift
};

/// Peak of a prefix pass. extend_prefix gives the longer prefix.
template <typename Cursor>
HistogramPeak prefix_peak(const PrefixPass& pass, std::uint32_t prefix, Cursor& row, Histogram& histogram) {
  const auto prefix_shift = static_cast<unsigned>(pass.prefix_shift);
  const auto bin_shift = static_cast<unsigned>(pass.bin_shift);
  const std::uint32_t first = prefix << (prefix_shift - bin_shift);
  const auto first_code = static_cast<std::int32_t>(prefix << prefix_shift);
  const auto last_code = static_cast<std::int32_t>((prefix + 1) << prefix_shift);
  row.advance_to(pass.end, first_code, last_code,
                 [&](std::uint32_t timestamp) { histogram.add((timestamp >> bin_shift) - first); });
  return histogram.take_peak();
}

/// Prefix after a prefix pass: `prefix` followed by the bits of the peak's bin.
constexpr std::uint32_t extend_prefix(const PrefixPass& pass, std::uint32_t prefix,
                                      const HistogramPeak& peak) {
  return (prefix << static_cast<unsigned>(pass.prefix_shift - pass.bin_shift)) + peak.bin;
}

/// Peak of a pass that counts timestamps first <= x < first + 2^bin_bits in bin x - first. `first` may be
/// negative and the window may extend beyond the last code; it does not wrap.
template <typename Cursor>
HistogramPeak window_peak(std::uint32_t end, std::int32_t first, int bin_bits, Cursor& row,
                          Histogram& histogram) {
  const std::uint32_t bins = 1U << static_cast<unsigned>(bin_bits);
  row.advance_to(end, first, first + static_cast<std::int32_t>(bins), [&](std::uint32_t timestamp) {
    histogram.add(static_cast<std::uint32_t>(static_cast<std::int32_t>(timestamp) - first));
  });
  return histogram.take_peak();
}

}  // namespace dtof
