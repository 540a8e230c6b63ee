// SPDX-License-Identifier: Apache-2.0
#include "common/engine_frame.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "dtof/readout/model.hpp"

namespace dtof {

int engine_columns_judged() { return ReadoutParameters::defaults(Readout::kPoolPointer).columns_together(); }
int engine_columns_read() {
  return ReadoutParameters::defaults(Readout::kPoolPointerLean).columns_together();
}

TargetMap middle_of(Scene scene, const SensorModel& sensor, int rows) {
  SceneParameters parameters;
  parameters.columns = sensor.columns;
  parameters.rows = sensor.rows;
  parameters.reflectivity = sensor.default_reflectivity;
  const TargetMap whole = make_scene(scene, parameters);
  TargetMap middle(engine_columns_read(), rows);
  const int left = (whole.columns() - middle.columns()) / 2;
  const int top = (whole.rows() - middle.rows()) / 2;
  for (int column = 0; column < middle.columns(); ++column) {
    for (int row = 0; row < rows; ++row) {
      middle.at(column, row) = whole.at(left + column, top + row);
    }
  }
  return middle;
}

std::vector<EngineResults> read_engine(const PhotonSource& source,
                                       std::span<const ReadoutParameters> readouts, std::uint32_t dropped) {
  const int judged = engine_columns_judged();
  const std::uint32_t acquisitions = source.acquisitions() - dropped;
  const auto kept = [&](int column) {
    return dropped == 0 ? source.column(column) : without_first(source.column(column), dropped);
  };
  std::vector<EngineResults> results(readouts.size());
  std::vector<std::pair<std::size_t, std::unique_ptr<ReadoutModel>>> alone;
  for (std::size_t r = 0; r < readouts.size(); ++r) {
    std::unique_ptr<ReadoutModel> model = make_readout_model(readouts[r]);
    if (readouts[r].columns_together() == 1) {
      alone.emplace_back(r, std::move(model));
      continue;
    }
    ColumnStream stream;
    results[r] = model->run_columns(
        std::min(readouts[r].columns_together(), source.columns()),
        [&](int column) -> const ColumnStream& { return stream = kept(column); }, acquisitions);
  }
  for (int column = 0; column < judged && !alone.empty(); ++column) {
    const ColumnStream stream = kept(column);
    for (const auto& [r, model] : alone) {
      results[r].push_back(model->run_column(stream, acquisitions));
    }
  }
  return results;
}

}  // namespace dtof
