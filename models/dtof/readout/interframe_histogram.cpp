// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>

#include "dtof/readout/histogram.hpp"
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {
namespace {

/// A window may begin below code 0, where an empty fine histogram has its peak. No window's peak lies beyond
/// the last code: only codes that were measured are counted, and an empty window's first code is in the
/// range.
std::uint16_t window_code(std::int32_t first, const HistogramPeak& fine) {
  return static_cast<std::uint16_t>(std::max(first + static_cast<std::int32_t>(fine.bin), 0));
}

/// Eq. 2.3 to 2.8.
class SifhPixel {
 public:
  explicit SifhPixel(const ReadoutParameters& parameters)
      : fine_bits_(parameters.nb),
        coarse_{0, parameters.np, parameters.np - parameters.nb},
        histogram_(parameters.nb, parameters.count_width, FullBin::kFreezes) {
    const int coarse_bin = 1 << (parameters.np - parameters.nb);
    const int half_window = (1 << parameters.nb) / 2;
    const int centring = parameters.window_centred ? std::max(coarse_bin / 2 - 1, 0) : 0;
    window_offset_ = centring - half_window + 1;
  }

  void start_frame(std::uint32_t acquisitions) {
    coarse_.end = measurement_1(acquisitions).end;
    end_ = acquisitions;
  }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    const std::uint32_t peak = prefix_peak(coarse_, 0, row, histogram_).bin;
    first_ = static_cast<std::int32_t>(peak << static_cast<unsigned>(coarse_.bin_shift)) + window_offset_;
    const HistogramPeak fine = window_peak(end_, first_, fine_bits_, row, histogram_);
    return {window_code(first_, fine), 0, histogram_confidence(fine, fine_bits_)};
  }

  Histogram& histogram() { return histogram_; }
  [[nodiscard]] HistogramBins bins() const { return {first_, 0}; }

 private:
  int fine_bits_;
  PrefixPass coarse_;
  std::int32_t window_offset_ = 0;  // TH- + 1 of coarse peak 0
  std::int32_t first_ = 0;          // code of the window's first bin
  std::uint32_t end_ = 0;
  Histogram histogram_;
};

/// Eq. 2.2.
class FifhPixel {
 public:
  explicit FifhPixel(const ReadoutParameters& parameters)
      : fine_bits_(parameters.np - parameters.nb),
        coarse_{0, parameters.np, fine_bits_},
        fine_{0, fine_bits_, 0},
        histogram_(std::max(parameters.nb, fine_bits_), parameters.count_width, FullBin::kFreezes) {}

  void start_frame(std::uint32_t acquisitions) {
    coarse_.end = measurement_1(acquisitions).end;
    fine_.end = acquisitions;
  }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    const std::uint32_t coarse = prefix_peak(coarse_, 0, row, histogram_).bin;
    const HistogramPeak fine = prefix_peak(fine_, coarse, row, histogram_);
    first_ = static_cast<std::int32_t>(coarse << static_cast<unsigned>(fine_bits_));
    return {static_cast<std::uint16_t>(extend_prefix(fine_, coarse, fine)), 0,
            histogram_confidence(fine, fine_bits_)};
  }

  Histogram& histogram() { return histogram_; }
  [[nodiscard]] HistogramBins bins() const { return {first_, 0}; }

 private:
  int fine_bits_;
  PrefixPass coarse_;
  PrefixPass fine_;
  std::int32_t first_ = 0;  // code of the fine histogram's first bin
  Histogram histogram_;
};

/// Thesis section 3.3.4.
class ThreeStepsPixel {
 public:
  explicit ThreeStepsPixel(const ReadoutParameters& parameters)
      : histogram_(kFineBits, parameters.count_width, FullBin::kFreezes) {
    int shift = parameters.np;
    for (PrefixPass& step : steps_) {
      step.prefix_shift = shift;
      shift = std::max(shift - kStepBits, 0);
      step.bin_shift = shift;
    }
    section_shift_ = shift;
  }

  void start_frame(std::uint32_t acquisitions) {
    const std::uint32_t zoom_acquisitions = measurement_1(acquisitions).size();
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      steps_[k].end = frame_part(zoom_acquisitions, static_cast<std::uint32_t>(k), kSteps).end;
    }
    end_ = acquisitions;
  }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    std::uint32_t section = 0;
    for (const PrefixPass& step : steps_) {
      section = extend_prefix(step, section, prefix_peak(step, section, row, histogram_));
    }
    const std::int32_t section_width = 1 << section_shift_;
    const auto section_begin = static_cast<std::int32_t>(section << static_cast<unsigned>(section_shift_));
    first_ = section_begin + section_width / 2 - (1 << kFineBits) / 2;
    const HistogramPeak fine = window_peak(end_, first_, kFineBits, row, histogram_);
    return {window_code(first_, fine), 0, histogram_confidence(fine, kFineBits)};
  }

  Histogram& histogram() { return histogram_; }
  [[nodiscard]] HistogramBins bins() const { return {first_, 0}; }

 private:
  static constexpr std::uint32_t kSteps = 3;
  static constexpr int kStepBits = 3;
  static constexpr int kFineBits = 4;

  std::array<PrefixPass, kSteps> steps_{};
  int section_shift_ = 0;
  std::int32_t first_ = 0;  // code of the window's first bin
  std::uint32_t end_ = 0;
  Histogram histogram_;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_interframe_histogram(const ReadoutParameters& parameters) {
  switch (parameters.readout) {
    case Readout::kSifh:
      return std::make_unique<PixelwiseModel<SifhPixel>>(parameters);
    case Readout::kFifh:
      return std::make_unique<PixelwiseModel<FifhPixel>>(parameters);
    default:
      return std::make_unique<PixelwiseModel<ThreeStepsPixel>>(parameters);
  }
}

}  // namespace dtof
