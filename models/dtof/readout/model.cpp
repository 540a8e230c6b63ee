// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/model.hpp"

#include <fmt/format.h>

#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {

void check_detections(std::span<const Detection> detections, int row, const ReadoutParameters& parameters,
                      std::uint32_t acquisitions) {
  if (detections.empty()) {
    return;
  }
  // Four at a time: this touches the row first, and should wait for nothing but memory.
  std::uint32_t seen_bits = 0;
  std::size_t i = 0;
  for (; i + 4 <= detections.size(); i += 4) {
    seen_bits |= (detections[i].timestamp | detections[i + 1].timestamp) |
                 (detections[i + 2].timestamp | detections[i + 3].timestamp);
  }
  for (; i < detections.size(); ++i) {
    seen_bits |= detections[i].timestamp;
  }
  if (seen_bits > static_cast<std::uint32_t>(parameters.no_detection())) {
    throw InputError(fmt::format("row {}: a timestamp is above {}, the largest code of NP = {}", row,
                                 parameters.no_detection(), parameters.np));
  }
  if (detections.back().acquisition >= acquisitions) {
    throw InputError(fmt::format("row {}: acquisition {} is outside the frame of {} acquisitions", row,
                                 detections.back().acquisition, acquisitions));
  }
}

std::vector<std::vector<PixelResult>> ReadoutModel::run_columns(int count, const ColumnReader& column,
                                                                std::uint32_t acquisitions) {
  std::vector<std::vector<PixelResult>> results;
  for (int i = 0; i < count; ++i) {
    results.push_back(run_column(column(i), acquisitions));
    if (results.back().size() != results.front().size()) {
      throw InputError(fmt::format("column {} has {} rows, column 0 has {}", i, results.back().size(),
                                   results.front().size()));
    }
  }
  return results;
}

std::vector<std::vector<PixelResult>> ReadoutModel::run_columns(std::span<const ColumnStream> columns,
                                                                std::uint32_t acquisitions) {
  return run_columns(static_cast<int>(columns.size()), reader_of(columns), acquisitions);
}

std::vector<std::vector<PixelResult>> ReadoutModel::run_raw_column(const ColumnStream& /*column*/,
                                                                   std::uint32_t /*acquisitions*/) {
  throw InputError("the read-out holds no whole histogram at a frame's end");
}

std::unique_ptr<ReadoutModel> make_readout_model(const ReadoutParameters& parameters) {
  parameters.validate();
  std::unique_ptr<ReadoutModel> model = make_ungated_model(parameters);
  return parameters.time_gate ? make_gated_model(parameters, std::move(model)) : std::move(model);
}

}  // namespace dtof
