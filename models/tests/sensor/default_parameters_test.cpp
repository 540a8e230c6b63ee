// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/default_parameters.hpp"

#include <gtest/gtest.h>

#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

TEST(DefaultParameters, PoolReadoutsFollowThePulse) {
  SensorModel sensor = parse_preset("thesis");
  const double bin = sensor.time_resolution_s();
  for (const Readout readout : {Readout::kPoolPointer, Readout::kPoolPointerLean}) {
    EXPECT_EQ(default_parameters(readout, parse_preset("thesis")).pool,
              PoolPointerParameters::defaults(readout));
    for (const auto& [bins, shift] : {std::pair(8, 8), std::pair(23, 8), std::pair(25, 9), std::pair(45, 9),
                                      std::pair(71, 9), std::pair(73, 10), std::pair(90, 10)}) {
      sensor.pulse_fwhm_s = bins * bin;
      EXPECT_EQ(default_parameters(readout, sensor).pool.cell_shift, shift) << bins << " bins";
    }
  }
  EXPECT_EQ(default_parameters(Readout::kSifh, sensor).pool.cell_shift, 9);
}

// The pulse counts as a share of the range, whatever the timestamps' bits.
TEST(DefaultParameters, CellsDoNotDependOnNp) {
  SensorModel sensor = parse_preset("thesis");
  sensor.pulse_fwhm_s = 12 * sensor.time_resolution_s();
  for (const int np : {8, 12, 16}) {
    sensor.np = np;
    EXPECT_EQ(default_parameters(Readout::kPoolPointer, sensor).pool.cell_shift, 8) << np;
  }
}

}  // namespace
}  // namespace dtof
