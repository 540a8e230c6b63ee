// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/histogram.hpp"
#include "dtof/readout/pixelwise_model.hpp"
#include "dtof/readout/pointer.hpp"

namespace dtof {
namespace {

/// Thesis section 3.3.2, Eq. 3.12.
class EzPointerPixel {
 public:
  explicit EzPointerPixel(const ReadoutParameters& parameters)
      : pointer_(parameters),
        middle_(static_cast<std::uint32_t>(parameters.code_count()) / 2),
        all_codes_{-1, parameters.no_detection()} {}

  void start_frame(std::uint32_t acquisitions) { pointer_.start_frame({0, acquisitions}); }

  template <typename Cursor>
  [[nodiscard]] PixelResult read(Cursor row) const {
    return pointer_.follow(row, middle_, all_codes_);
  }

 private:
  PointerBuilder pointer_;
  std::uint32_t middle_;
  CodeWindow all_codes_;
};

/// Thesis sections 3.3.5 (v1, no filter) and 3.3.6 (Eq. 3.13).
class HisPointerPixel {
 public:
  explicit HisPointerPixel(const ReadoutParameters& parameters)
      : coarse_{0, parameters.np, parameters.np - parameters.nb},
        reach_(parameters.readout == Readout::kHisPointer1 ? parameters.code_count()
                                                           : (1 << parameters.nb) / 2 + parameters.guard),
        histogram_(parameters.nb, parameters.count_width,
                   parameters.readout == Readout::kHisPointer1 ? FullBin::kStays : FullBin::kFreezes),
        pointer_(parameters) {}

  void start_frame(std::uint32_t acquisitions) {
    coarse_.end = measurement_1(acquisitions).end;
    pointer_.start_frame(measurement_2(acquisitions));
  }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    const std::uint32_t coarse = prefix_peak(coarse_, 0, row, histogram_).bin;
    const std::uint32_t coarse_bin = 1U << static_cast<unsigned>(coarse_.bin_shift);
    const std::uint32_t centre = coarse * coarse_bin + coarse_bin / 2;
    const auto signed_centre = static_cast<std::int32_t>(centre);
    return pointer_.follow(row, centre, {signed_centre - reach_, signed_centre + reach_});
  }

  Histogram& histogram() { return histogram_; }
  [[nodiscard]] HistogramBins bins() const { return {0, coarse_.bin_shift}; }

 private:
  PrefixPass coarse_;
  std::int32_t reach_;  // SB of Eq. 3.13; v1 reaches past both ends of the range
  Histogram histogram_;
  PointerBuilder pointer_;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_pointer_readouts(const ReadoutParameters& parameters) {
  if (parameters.readout == Readout::kEzPointer) {
    return std::make_unique<PixelwiseModel<EzPointerPixel>>(parameters);
  }
  return std::make_unique<PixelwiseModel<HisPointerPixel>>(parameters);
}

}  // namespace dtof
