// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "dtof/core/pixel_sampler.hpp"
#include "dtof/photon/photon_source.hpp"

namespace dtof {

/// Faster, approximate replacement of a PhotonSource, with other random numbers. Times come from a table of
/// the pixel's cumulative mean events (ArrivalTable) instead of single events. Included are pile-up to SLOTS,
/// time gates, jitter, hot and dead pixels. Dead time, afterpulsing, binning, coincidence, a measured pulse,
/// TDC code widths, surroundings and transient cubes need the exact source.
///
/// Streams (`column`): pixels with few events per acquisition are drawn by the exact model. In others, one
/// exponential gap per detection gives acquisition and time together; empty acquisitions and events after the
/// last slot cost nothing. The only approximation: times are displaced by ArrivalTable::displacement.
///
/// Sampler (`pixel_sampler`): draws the number of a measurement's detections, then their times from the
/// distribution of kept events, only inside the requested window. This ignores which detections share an
/// acquisition, a second approximation. Pixels with more than 0.7 events per acquisition are drawn as their
/// streams are, without it.
class FastPhotonSource final : public SampledSource {
 public:
  /// Throws InputError unless supports().
  explicit FastPhotonSource(PhotonSource exact);

  [[nodiscard]] int columns() const override { return exact_.columns(); }
  [[nodiscard]] int rows() const override { return exact_.rows(); }
  [[nodiscard]] std::uint32_t acquisitions() const override { return exact_.acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override { return column_rows(index, {0, rows()}); }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange range) const override;
  [[nodiscard]] std::unique_ptr<PixelSampler> pixel_sampler() const override;

  /// False if the model has an effect that only the exact source includes.
  static bool supports(const SensorModel& model);
  /// The same for a source; false also for a transient cube.
  static bool supports(const PhotonSource& exact);

 private:
  PhotonSource exact_;
};

}  // namespace dtof
