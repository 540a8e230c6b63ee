// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/paired_his_pointer.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dtof/readout/pixelwise_model.hpp"
#include "dtof/readout/pointer.hpp"

namespace dtof {
namespace {

class PairedHisPointerPixel {
 public:
  explicit PairedHisPointerPixel(const ReadoutParameters& parameters)
      : codes_(parameters.code_count()),
        bin_shift_(static_cast<unsigned>(parameters.np - parameters.nb)),
        limit_((1U << static_cast<unsigned>(parameters.count_width)) - 1),
        reach_((1 << parameters.nb) / 2 + parameters.guard),
        counts_(std::size_t{1} << static_cast<unsigned>(parameters.nb)),
        pointer_(parameters) {}

  void start_frame(std::uint32_t acquisitions) {
    coarse_end_ = measurement_1(acquisitions).end;
    pointer_.start_frame(measurement_2(acquisitions));
  }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    std::ranges::fill(counts_, 0U);
    row.advance_to(coarse_end_, 0, codes_, [&](std::uint32_t timestamp) {
      std::uint32_t& count = counts_[timestamp >> bin_shift_];
      count += count < limit_ ? 1 : 0;
    });
    std::size_t best = 0;
    for (std::size_t pair = 1; pair + 1 < counts_.size(); ++pair) {
      if (counts_[pair] + counts_[pair + 1] > counts_[best] + counts_[best + 1]) {
        best = pair;
      }
    }
    const auto centre = static_cast<std::int32_t>((best + 1) << bin_shift_);
    return pointer_.follow(row, static_cast<std::uint32_t>(centre), {centre - reach_, centre + reach_});
  }

 private:
  std::int32_t codes_;
  unsigned bin_shift_;
  std::uint32_t limit_;
  std::int32_t reach_;
  std::vector<std::uint32_t> counts_;
  PointerBuilder pointer_;
  std::uint32_t coarse_end_ = 0;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_paired_his_pointer(const ReadoutParameters& parameters) {
  parameters.validate();
  return std::make_unique<PixelwiseModel<PairedHisPointerPixel>>(parameters);
}

}  // namespace dtof
