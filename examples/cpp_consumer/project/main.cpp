// SPDX-License-Identifier: Apache-2.0
// A wall at 2 m through hisPointer's model: ends with status 1 if it is not seen there.
#include <cmath>
#include <cstdio>

#include "dtof/metrics/depth.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

int main() {
  constexpr double kDistance = 2.0;
  const dtof::SensorModel sensor = dtof::parse_preset("thesis");
  const dtof::PhotonSource photons(
      sensor, dtof::TargetMap(1, 20, {.depth_m = kDistance, .reflectivity = 1.0}), 2.0, 1);
  const auto model = dtof::make_readout_model(dtof::default_parameters(dtof::Readout::kHisPointer, sensor));
  const dtof::DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  double sum = 0.0;
  const auto results = model->run_column(photons.column(0), photons.acquisitions());
  for (const dtof::PixelResult& result : results) {
    sum += scale.depth(result.code);
  }
  const double mean = sum / static_cast<double>(results.size());
  std::printf("wall at %g m, measured %.3f m\n", kDistance, mean);
  return std::abs(mean - kDistance) < 0.05 * kDistance ? 0 : 1;
}
