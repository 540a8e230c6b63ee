// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/core/pixel_sampler.hpp"
#include "dtof/photon/photon_source.hpp"

namespace dtof {

/// Photon source without random numbers. A pixel has the expected number of detections, spread evenly over
/// the acquisitions. Their times fill the distribution of kept events evenly (multiples of the golden ratio's
/// fraction, Weyl 1916). So a read-out's errors are systematic errors alone. Supports the same sensors as
/// FastPhotonSource (FastPhotonSource::supports).
class MeanPhotonSource final : public SampledSource {
 public:
  /// Throws InputError unless FastPhotonSource::supports().
  explicit MeanPhotonSource(PhotonSource exact);

  [[nodiscard]] int columns() const override { return exact_.columns(); }
  [[nodiscard]] int rows() const override { return exact_.rows(); }
  [[nodiscard]] std::uint32_t acquisitions() const override { return exact_.acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override { return column_rows(index, {0, rows()}); }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange range) const override;
  [[nodiscard]] std::unique_ptr<PixelSampler> pixel_sampler() const override;

 private:
  PhotonSource exact_;
};

}  // namespace dtof
