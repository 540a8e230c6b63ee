// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// The pulse as the host knows it: share of its events in each code if its mean is in the middle of a code.
/// Includes jitter, but neither pile-up nor unequal codes.
class PulseShape {
 public:
  explicit PulseShape(const SensorModel& sensor);

  /// Offsets -reach() .. reach() hold all of the pulse except 1e-9.
  [[nodiscard]] int reach() const { return reach_; }
  /// Share of the pulse in the code `offset` codes after the code with the pulse's mean; 0 beyond the reach.
  [[nodiscard]] double share(int offset) const;
  /// Standard deviation in codes.
  [[nodiscard]] double sigma() const { return sigma_; }

 private:
  double sigma_;
  int reach_ = 1;
  std::vector<double> shares_;
};

}  // namespace dtof
