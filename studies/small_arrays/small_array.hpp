// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "dtof/rival/rival.hpp"
#include "small_arrays/models/enlarger.hpp"

namespace dtof {

/// Sensor of a small array: the large one's laser power on fewer spots. A pixel's signal grows inversely with
/// their number; its background is unchanged.
SensorModel sharing_the_laser(const SensorModel& sensor, const SpotGrid& grid);

/// Throws InputError unless `name` is a read-out, or a rival (models/dtof/rival/rival.hpp) with one frame
/// per result.
void check_small_readout(const std::string& name, const SensorModel& sensor);

/// A small array at the spots of a grid, which shares the laser of a large array among fewer pixels, read out
/// in several ways. All read-outs see the same photons. They come from FastPhotonSource if it supports the
/// sensor, since a small array's pixels have too many events for the exact model's speed. Each read-out has
/// its own look-up table (FlatCalibration) with the small array's light.
class SmallArray {
 public:
  /// `sensor` is the large array's. Throws InputError for names that check_small_readout refuses.
  SmallArray(const SensorModel& sensor, SpotGrid grid, double klux, std::span<const std::string> readouts,
             std::uint64_t calibration_seed, int threads);

  /// Titles, in the order of `readouts`.
  [[nodiscard]] const std::vector<std::string>& titles() const { return titles_; }
  [[nodiscard]] const SpotGrid& grid() const { return grid_; }
  /// One map per read-out, for `targets` of the large array's pixels.
  [[nodiscard]] std::vector<SmallMap> measure(const TargetMap& targets, std::uint64_t seed) const;

 private:
  /// A read-out or a rival; exactly one of both is set.
  struct Reader {
    std::vector<ReadoutParameters> readout;
    std::unique_ptr<Rival> rival;
  };
  [[nodiscard]] std::vector<Measurement> read_rival(const Rival& rival, const StreamSource& source) const;

  SensorModel sensor_;
  SpotGrid grid_;
  double klux_;
  int threads_;
  std::vector<std::string> titles_;
  std::vector<Reader> readers_;
  std::vector<RangeConverter> tables_;  // for each reader
};

}  // namespace dtof
