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
#include "rivals/models/rival.hpp"
#include "small_arrays/models/enlarger.hpp"

namespace dtof {

/// A small array's sensor: the large one's laser power on fewer spots, so that a pixel's signal grows as
/// their number falls; its background stays.
SensorModel sharing_the_laser(const SensorModel& sensor, const SpotGrid& grid);

/// Throws InputError unless `name` is a read-out or a rival (rival/rival.hpp) that needs one frame.
void check_small_readout(const std::string& name, const SensorModel& sensor);

/// An array that shares the laser of a large one among fewer pixels (study/array_size.hpp) and looks at the
/// spots of a grid, read out in several ways. All see the same photons, those of FastPhotonSource where it
/// models the sensor: a small array's pixels have too many events for the exact model's speed. Each read-out
/// has a look-up table of its own (FlatCalibration), made with the small array's light.
class SmallArray {
 public:
  /// `sensor` is the large array's. Throws InputError for names that check_small_readout does not take.
  SmallArray(const SensorModel& sensor, SpotGrid grid, double klux, std::span<const std::string> readouts,
             std::uint64_t calibration_seed, int threads);

  /// Titles, in the order of `readouts`.
  [[nodiscard]] const std::vector<std::string>& titles() const { return titles_; }
  [[nodiscard]] const SpotGrid& grid() const { return grid_; }
  /// One map a read-out, of what the large array's pixels look at.
  [[nodiscard]] std::vector<SmallMap> measure(const TargetMap& targets, std::uint64_t seed) const;

 private:
  /// One of the two is set.
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
  std::vector<RangeConverter> tables_;  // of each reader
};

}  // namespace dtof
