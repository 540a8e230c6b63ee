// SPDX-License-Identifier: Apache-2.0
#include "playground/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/frame/frame_maps.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {

PlaygroundSession::PlaygroundSession(const PlaygroundRequest& request, const PlaygroundFiles& files)
    : engine_({.threads = kOneThread, .observer = [](std::size_t, std::size_t) {}}),
      photons_(files.recording.empty() ? make_scene_photons(request, files, engine_)
                                       : make_recorded_photons(request, files, engine_)),
      brightness_(photons_->brightness()) {
  for (const std::string& name : request.readouts) {
    readouts_.push_back(default_parameters(parse_readout(name), photons_->sensor()));
  }
  read_.resize(readouts_.size());
  results_.assign(readouts_.size(), std::vector<PixelResult>(truth_m().size()));
}

void PlaygroundSession::calibrate() { photons_->calibrate(readouts_); }

void PlaygroundSession::read_column(int column) {
  const auto width = static_cast<std::size_t>(columns());
  for (std::size_t r = 0; r < readouts_.size(); ++r) {
    if ((column + 1) % readouts_[r].columns_together() != 0 && column + 1 < columns()) {
      continue;
    }
    std::vector<int> together(static_cast<std::size_t>(column + 1 - read_[r]));
    std::iota(together.begin(), together.end(), read_[r]);
    const std::size_t first = static_cast<std::size_t>(read_[r]);
    const std::size_t count = together.size();
    const std::vector<PixelResult> results = photons_->read(readouts_[r], std::move(together));
    for (std::size_t i = 0; i < results.size(); ++i) {
      results_[r][i / count * width + first + i % count] = results[i];
    }
    read_[r] = column + 1;
  }
  // A page has little memory.
  for (const int all_read = std::ranges::min(read_); dropped_ < all_read; ++dropped_) {
    photons_->drop(dropped_);
  }
}

PlaygroundFrame PlaygroundSession::frame(std::size_t readout) const {
  PlaygroundFrame frame;
  frame.results = results_.at(readout);
  FrameMaps maps = photons_->judge(frame.results, readout);
  frame.figures = figure_values(maps.figures, true);
  frame.depth_m = std::move(maps.depth);
  frame.error_m = std::move(maps.error);
  return frame;
}

void PlaygroundSession::require_pixel(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns() || row >= rows()) {
    throw InputError(fmt::format("there is no pixel in column {}, row {}", column, row));
  }
}

std::vector<Detection> PlaygroundSession::pixel(int column, int row) const {
  require_pixel(column, row);
  const ColumnStream stream = photons_->source().column_rows(column, {row, 1});
  const auto detections = stream.row(0);
  return {detections.begin(), detections.end()};
}

std::unique_ptr<PixelTrace> PlaygroundSession::trace(int column, int row) const {
  require_pixel(column, row);
  return std::make_unique<PixelTrace>(photons_->source(), engine_, column, row);
}

}  // namespace dtof
