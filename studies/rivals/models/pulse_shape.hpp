// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// What a host knows of the laser: the share of the pulse's events in each code, if the pulse's mean lies in
/// the middle of one. Jitter is in it; pile-up and unequal codes are not.
class PulseShape {
 public:
  explicit PulseShape(const SensorModel& sensor);

  /// Offsets -reach() .. reach() hold all of the pulse but for 1e-9 of it.
  [[nodiscard]] int reach() const { return reach_; }
  /// Share of the pulse in the code `offset` codes behind the code that has the pulse's mean; 0 beyond the
  /// reach.
  [[nodiscard]] double share(int offset) const;
  /// Standard deviation in codes.
  [[nodiscard]] double sigma() const { return sigma_; }

 private:
  double sigma_;
  int reach_ = 1;
  std::vector<double> shares_;
};

}  // namespace dtof
