// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "dtof/readout/histogram.hpp"
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {
namespace {

/// One histogram of wide bins for the whole frame (docs/reference/readouts.md, coarsehistogram).
class CoarseHistogramPixel {
 public:
  explicit CoarseHistogramPixel(const ReadoutParameters& parameters)
      : code_count_(parameters.code_count()),
        bin_bits_(static_cast<unsigned>(parameters.nb)),
        bin_shift_(static_cast<unsigned>(parameters.np - parameters.nb)),
        fraction_bits_(static_cast<unsigned>(parameters.fraction_bits)),
        limit_((1U << static_cast<unsigned>(parameters.count_width)) - 1),
        histogram_(parameters.nb, parameters.count_width, FullBin::kFreezes) {}

  void start_frame(std::uint32_t acquisitions) { end_ = acquisitions; }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    row.advance_to(end_, 0, code_count_,
                   [this](std::uint32_t timestamp) { histogram_.add(timestamp >> bin_shift_); });
    const PairPeak peak = histogram_.take_pair_peak();
    // Zero for an empty histogram alone: the mean of the others is less than the highest pair.
    const std::uint32_t height = peak.count - ((peak.sum - peak.count) >> (bin_bits_ - 1));

    const bool before = peak.behind < peak.before;
    const std::uint32_t tilt = before ? peak.before - peak.behind : peak.behind - peak.before;
    const unsigned place_bits = bin_shift_ + fraction_bits_;
    const auto offset =
        height == 0 ? 0U
                    : static_cast<std::uint32_t>((std::uint64_t{2} * std::min(tilt, height) << place_bits) /
                                                 (std::uint64_t{3} * height));
    const std::uint32_t edge = peak.edge << place_bits;
    const std::uint32_t position = before ? edge - 1 - offset : edge + offset;
    return {.code = static_cast<std::uint16_t>(position >> fraction_bits_),
            .fraction = static_cast<std::uint16_t>(position & ((1U << fraction_bits_) - 1)),
            .confidence = static_cast<std::uint16_t>(std::min(height, limit_))};
  }

  Histogram& histogram() { return histogram_; }
  [[nodiscard]] HistogramBins bins() const { return {0, static_cast<int>(bin_shift_)}; }

 private:
  std::int32_t code_count_;
  unsigned bin_bits_;
  unsigned bin_shift_;
  unsigned fraction_bits_;
  std::uint32_t limit_;
  std::uint32_t end_ = 0;
  Histogram histogram_;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_coarse_histogram(const ReadoutParameters& parameters) {
  return std::make_unique<PixelwiseModel<CoarseHistogramPixel>>(parameters);
}

}  // namespace dtof
