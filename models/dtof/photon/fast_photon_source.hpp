// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "dtof/core/pixel_sampler.hpp"
#include "dtof/photon/photon_source.hpp"

namespace dtof {

/// Faster stand-in for a PhotonSource: times come from a table of the pixel's cumulative mean events
/// (ArrivalTable) instead of single events. Pile-up to SLOTS is included; other random numbers than the exact
/// source's. Time gates, jitter, hot and dead pixels work; dead time, afterpulsing, binning, coincidence, a
/// measured pulse, TDC code widths and surroundings need the exact source.
///
/// Streams (`column`): a pixel of few events per acquisition is drawn by the exact model. For others one
/// exponential gap per detection gives acquisition and time together; empty acquisitions and events after the
/// last slot are not visited. Their times are displaced by ArrivalTable::displacement against the exact
/// distribution; nothing else is approximated.
///
/// Sampler (`pixel_sampler`): the number of a measurement's detections, then their times from the
/// distribution of kept events, only those inside the asked window. Approximated beyond the table: which
/// detections share an acquisition is forgotten. Pixels of more than 0.7 events an acquisition are walked as
/// the streams of bright pixels are, without that approximation.
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

  /// False for what only the exact source models.
  static bool supports(const SensorModel& model);

 private:
  PhotonSource exact_;
};

}  // namespace dtof
