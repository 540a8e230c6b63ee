// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>

#include "dtof/core/error.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "rtl/error.hpp"
#include "rtl/registry.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {
namespace {

constexpr int kSceneColumns = 200;
constexpr int kSceneRows = 160;
constexpr double kKlux = 14.0;
constexpr std::uint32_t kMostAcquisitions = 65535;

/// Column `index` of the array, spread over the scene.
int scene_column(int index) { return (2 * index + 1) * kSceneColumns / (2 * kFaultColumns); }

constexpr RowRange kSceneRange = {(kSceneRows - kFaultRows) / 2, kFaultRows};

std::vector<ColumnStream> streams(const PhotonSource& source) {
  std::vector<ColumnStream> columns;
  columns.reserve(kFaultColumns);
  for (int column = 0; column < kFaultColumns; ++column) {
    columns.push_back(source.column_rows(scene_column(column), kSceneRange));
  }
  return columns;
}

DepthScale depth_scale(int np) {
  const SensorModel sensor = parse_preset("thesis");
  return {sensor.integration_time_s, np, sensor.pulse_fwhm_s};
}

ReadoutParameters parameters_of(Readout readout) {
  ReadoutParameters parameters = ReadoutParameters::defaults(readout);
  parameters.pool.engine_columns = kFaultEngineColumns;
  return parameters;
}

}  // namespace

FaultScene make_fault_scene(std::uint32_t acquisitions, std::uint64_t seed) {
  if (acquisitions < 1 || acquisitions > kMostAcquisitions) {
    throw InputError(fmt::format("{} acquisitions; a frame has 1 to {}", acquisitions, kMostAcquisitions));
  }
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = acquisitions;
  SensorModel next_sensor = sensor;
  next_sensor.acquisitions = std::max(acquisitions / 3, 1U);
  const TargetMap targets = make_scene(Scene::kRoom, {.columns = kSceneColumns, .rows = kSceneRows});
  FaultScene scene{.acquisitions = sensor.acquisitions,
                   .next_acquisitions = next_sensor.acquisitions,
                   .frame = streams(PhotonSource(sensor, targets, kKlux, seed)),
                   .next = streams(PhotonSource(next_sensor, targets, kKlux, seed, 1)),
                   .distances_m = {}};
  for (int row = 0; row < kFaultRows; ++row) {
    for (int column = 0; column < kFaultColumns; ++column) {
      scene.distances_m.push_back(targets.at(scene_column(column), kSceneRange.first + row).depth_m);
    }
  }
  return scene;
}

FaultSubject::FaultSubject(Readout readout, const FaultScene& scene)
    : scene_(scene),
      configuration_(find_rtl_configuration(parameters_of(readout), kFaultRows, kFaultColumns)),
      scale_(depth_scale(configuration_.parameters.np)),
      expected_(model(scene.frame, scene.acquisitions)),
      expected_next_(model(scene.next, scene.next_acquisitions)) {
  RtlReadout rtl(configuration_);
  RtlRunOptions options;
  options.observer = [&](const RtlCycle& clock) {
    clocks_[static_cast<std::size_t>(clock.state)].push_back(clock.cycle);
  };
  if (rtl.run(scene.frame, scene.acquisitions, options).results != expected_) {
    throw RtlError(fmt::format("{}: differs from its model without a fault", configuration_.to_string()));
  }
}

std::vector<PixelResult> FaultSubject::model(std::span<const ColumnStream> columns,
                                             std::uint32_t acquisitions) const {
  std::vector<PixelResult> results(columns.size() * static_cast<std::size_t>(kFaultRows));
  const std::vector<std::vector<PixelResult>> read =
      make_readout_model(parameters())->run_columns(columns, acquisitions);
  for (std::size_t column = 0; column < columns.size(); ++column) {
    for (std::size_t row = 0; row < read[column].size(); ++row) {
      results[row * columns.size() + column] = read[column][row];
    }
  }
  return results;
}

double FaultSubject::depth(const PixelResult& result) const {
  return scale_.depth(code_position(result, parameters().fraction_bits));
}

}  // namespace dtof
