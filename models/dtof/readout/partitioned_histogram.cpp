// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "dtof/readout/histogram.hpp"
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {
namespace {

/// PiFH (Eq. 2.1); with one partition it is the classical histogram.
class PartitionedPixel {
 public:
  explicit PartitionedPixel(const ReadoutParameters& parameters)
      : bin_bits_(parameters.readout == Readout::kHistogram ? parameters.np : parameters.nb),
        run_end_(std::size_t{1} << static_cast<unsigned>(parameters.np - bin_bits_)),
        histogram_(bin_bits_, parameters.count_width,
                   run_end_.size() == 1 ? FullBin::kFreezes : FullBin::kStays) {}

  void start_frame(std::uint32_t acquisitions) {
    const auto runs = static_cast<std::uint32_t>(run_end_.size());
    for (std::uint32_t run = 0; run < runs; ++run) {
      run_end_[run] = frame_part(acquisitions, run, runs).end;
    }
  }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    PixelResult best;
    std::uint32_t best_count = 0;
    for (std::uint32_t run = 0; run < run_end_.size(); ++run) {
      const PrefixPass pass{run_end_[run], bin_bits_, 0};
      const HistogramPeak peak = prefix_peak(pass, run, row, histogram_);
      if (peak.count > best_count) {
        best_count = peak.count;
        best = {static_cast<std::uint16_t>(extend_prefix(pass, run, peak)), 0,
                histogram_confidence(peak, bin_bits_)};
      }
    }
    return best;
  }

  Histogram& histogram() { return histogram_; }
  [[nodiscard]] HistogramBins bins() const { return {}; }

 private:
  int bin_bits_;
  std::vector<std::uint32_t> run_end_;
  Histogram histogram_;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_partitioned_histogram(const ReadoutParameters& parameters) {
  return std::make_unique<PixelwiseModel<PartitionedPixel>>(parameters);
}

}  // namespace dtof
