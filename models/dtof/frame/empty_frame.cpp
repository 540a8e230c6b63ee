// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/empty_frame.hpp"

#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/target_map.hpp"
#include "dtof/readout/pool_template.hpp"

namespace dtof {
namespace {

constexpr int kEmptyColumns = 2;
constexpr int kEmptyRows = 160;
constexpr std::uint32_t kEmptyFrame = 1'000'000;  // no scene's

}  // namespace

std::vector<ColumnStream> empty_columns(const SensorModel& sensor, std::uint64_t seed) {
  const PhotonSource source(sensor, TargetMap(kEmptyColumns, kEmptyRows, {0.0, 0.0}), 0.0, seed, kEmptyFrame);
  std::vector<ColumnStream> columns;
  columns.reserve(kEmptyColumns);
  for (int column = 0; column < kEmptyColumns; ++column) {
    columns.push_back(source.column(column));
  }
  return columns;
}

bool has_own_light(const SensorModel& sensor) {
  return sensor.surroundings.cover_glass.events > 0.0 || sensor.surroundings.fog.extinction_per_m > 0.0;
}

PoolTemplate template_of(const SensorModel& sensor, const ReadoutParameters& parameters) {
  return measured_template(empty_columns(sensor), sensor.acquisitions, parameters);
}

}  // namespace dtof
