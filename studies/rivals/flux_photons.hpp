// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/independent_photons.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Photons in strong light, as papers on pile-up use them. A pulse that is Gaussian around the pixel's
/// position and a flat background send Poisson numbers of photons in each acquisition.
struct FluxPhotons {
  /// Photons that become detections.
  enum class Kept {
    kAll,          ///< all: a read-out that arms the SPAD itself takes what it needs
    kSynchronous,  ///< by a SPAD that is armed at each pulse and after each dead time
    kFreeRunning,  ///< by a SPAD that is armed after each dead time, also if a pulse comes in between
  };

  int np = 10;                     ///< bits of a timestamp
  double pulse_sigma = 0.02;       ///< standard deviation of the pulse as a share of the range, > 0
  double signal_events = 0.1;      ///< mean photons of the pulse in an acquisition
  double background_events = 1.0;  ///< mean photons of the background in an acquisition
  std::uint32_t acquisitions = 1000;
  Kept kept = Kept::kAll;
  double dead_time = 0.0;  ///< as a share of the range, which ends where the next one begins

  /// A sensor with this pulse, one slot and this dead time, for which rivals are made.
  [[nodiscard]] SensorModel sensor() const;
};

/// Errors of several estimators on the same photons, as place_errors(). The first `laser_off_frames` of
/// `frames` frames have background only.
PlaceErrors flux_errors(const FluxPhotons& photons, const std::vector<PlaceEstimator>& estimators,
                        std::size_t pixels, std::uint64_t seed, int threads, std::size_t frames = 1,
                        std::size_t laser_off_frames = 0);

}  // namespace dtof
