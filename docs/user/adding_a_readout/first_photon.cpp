// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {
namespace {

/// The result is the code of the first detection, with confidence 1; without a detection both are 0.
class FirstPhotonPixel {
 public:
  explicit FirstPhotonPixel(const ReadoutParameters& parameters) : code_count_(parameters.code_count()) {}

  void start_frame(std::uint32_t acquisitions) { end_ = acquisitions; }

  template <typename Cursor>
  PixelResult read(Cursor row) {
    PixelResult first;
    row.advance_to(end_, 0, code_count_, [&](std::uint32_t timestamp) {
      if (first.confidence == 0) {
        first = {static_cast<std::uint16_t>(timestamp), 0, 1};
      }
    });
    return first;
  }

 private:
  std::int32_t code_count_;
  std::uint32_t end_ = 0;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_first_photon(const ReadoutParameters& parameters) {
  return std::make_unique<PixelwiseModel<FirstPhotonPixel>>(parameters);
}

}  // namespace dtof
