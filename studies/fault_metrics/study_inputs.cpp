// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "dtof/core/error.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "fault_metrics/metric_study.hpp"
#include "subsystem/self_test_reference.hpp"

namespace dtof {
namespace {

constexpr double kKlux = 14.0;
constexpr std::uint32_t kMostAcquisitions = 65535;
constexpr std::uint32_t kSelfTestSeed = 1;

/// Place `index` of `count` places that are spread over `all`, or that are neighbours in its middle.
int place(int index, int count, int all, bool spread) {
  return spread ? (2 * index + 1) * all / (2 * count) : (all - count) / 2 + index;
}

/// Pixels that are spread over the room; neighbours from its middle if a read-out's pixels depend on each
/// other.
std::vector<ColumnStream> room_streams(const GateNetlist& netlist, std::uint32_t acquisitions,
                                       std::uint64_t seed) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = acquisitions;
  const TargetMap targets = make_scene(Scene::kRoom, {.columns = kFullColumns, .rows = kFullRows});
  const PhotonSource source(sensor, targets, kKlux, seed);
  const bool spread = netlist_configuration(netlist).parameters.columns_together() == 1;
  std::vector<ColumnStream> columns(static_cast<std::size_t>(netlist.columns));
  for (int column = 0; column < netlist.columns; ++column) {
    const int from = place(column, netlist.columns, kFullColumns, spread);
    for (int row = 0; row < netlist.rows; ++row) {
      const ColumnStream pixel = source.column_rows(from, {place(row, netlist.rows, kFullRows, spread), 1});
      columns[static_cast<std::size_t>(column)].append_row(pixel.row(0));
    }
  }
  return columns;
}

}  // namespace

StudyInputs study_inputs(const GateNetlist& netlist, std::uint32_t acquisitions, std::uint64_t seed) {
  if (acquisitions < 2 || acquisitions > kMostAcquisitions) {
    throw InputError(fmt::format("{} acquisitions; a frame has 2 to {}", acquisitions, kMostAcquisitions));
  }
  const RtlConfiguration configuration = netlist_configuration(netlist);
  StudyInputs inputs;
  inputs.room = frame_input(configuration, room_streams(netlist, acquisitions, seed), acquisitions);
  inputs.self_test.acquisitions = acquisitions;
  SelfTestLines lines(configuration, kSelfTestSeed);
  for (std::size_t i = 0; i < inputs.room.lines.size(); ++i) {
    inputs.self_test.lines.push_back(lines.next());
  }
  return inputs;
}

}  // namespace dtof
