// SPDX-License-Identifier: Apache-2.0
#include "commands/filtered_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/host/host_filter.hpp"
#include "dtof/metrics/depth.hpp"

namespace dtof {

void check_filtered_region(const Region& region, bool filter) {
  const auto apart = std::ranges::adjacent_find(region.columns, [](int a, int b) { return b != a + 1; });
  if (filter && apart != region.columns.end()) {
    throw InputError("--host-filter uses each pixel's neighbours: --columns must be one range");
  }
}

FrameMaps filtered_maps(const MeasuredFrame& frame, const TabledReadout& readout,
                        const FramePipeline& pipeline) {
  const SensorModel& sensor = pipeline.scene().model();
  const std::vector<float>& truth = pipeline.truth().metres;
  FrameMaps maps = frame.maps;
  std::vector<double> metres(maps.depth.begin(), maps.depth.end());
  filter_depth(metres, static_cast<int>(pipeline.region().columns.size()),
               pulse_distance_m(sensor.pulse_fwhm_s));
  const std::vector<double> positions = pipeline.positions(frame.run.results, readout.parameters);
  const DepthScale scale(sensor.integration_time_s, readout.parameters.np, sensor.pulse_fwhm_s);
  maps.figures.errors = {};
  maps.figures.without_distance = 0;
  RunningMoments errors;
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const bool known = !std::isnan(metres[i]);
    const double before = readout.table ? readout.table->distance(positions[i]) : scale.depth(positions[i]);
    const double distance = known ? metres[i] : before;
    maps.depth[i] = static_cast<float>(metres[i]);
    maps.error[i] = static_cast<float>(metres[i]) - truth[i];
    if (!std::isnan(truth[i])) {
      maps.figures.errors.add(truth[i], distance);
      maps.figures.without_distance += known ? 0 : 1;
      errors.add(distance - truth[i]);
    }
  }
  maps.mean_square = errors.mean_square();
  return maps;
}

}  // namespace dtof
