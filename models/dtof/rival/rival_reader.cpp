// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/rival_reader.hpp"

#include <algorithm>
#include <stdexcept>

namespace dtof {

std::size_t most_frames(std::span<const std::unique_ptr<Rival>> rivals) {
  int most = 1;
  for (const std::unique_ptr<Rival>& rival : rivals) {
    most = std::max(most, rival->frames());
  }
  return static_cast<std::size_t>(most);
}

RivalReader::RivalReader(SensorModel sensor, const TargetMap& targets, double klux, std::uint64_t seed,
                         std::vector<std::uint32_t> frames, std::span<const std::unique_ptr<Rival>> rivals)
    : rivals_(rivals) {
  if (frames.size() != most_frames(rivals)) {
    throw std::logic_error("RivalReader: one number for each frame of a result");
  }
  const PhotonSource lit(sensor, targets, klux, seed, frames.front());
  for (const std::uint32_t frame : frames) {
    lit_.push_back(lit.at_frame(frame));
  }
  int most_dark = 0;
  for (const std::unique_ptr<Rival>& rival : rivals) {
    most_dark = std::max(most_dark, rival->laser_off_frames());
  }
  if (most_dark > 0) {
    sensor.signal_events_1m = 0.0;
    const PhotonSource dark(sensor, targets, klux, seed, frames.front());
    for (std::size_t f = 0; f + 1 < frames.size(); ++f) {
      dark_.push_back(dark.at_frame(frames[f]));
    }
  }
}

std::vector<std::vector<RivalWords>> RivalReader::column(int column) const {
  std::vector<ColumnStream> lit;
  std::vector<ColumnStream> dark;
  for (const PhotonSource& source : lit_) {
    lit.push_back(source.column(column));
  }
  for (const PhotonSource& source : dark_) {
    dark.push_back(source.column(column));
  }
  const int rows = lit_.back().rows();
  std::vector<std::vector<RivalWords>> words(rivals_.size());
  for (std::size_t r = 0; r < rivals_.size(); ++r) {
    const Rival& rival = *rivals_[r];
    const std::size_t first = lit.size() - static_cast<std::size_t>(rival.frames());
    const std::size_t first_lit = first + static_cast<std::size_t>(rival.laser_off_frames());
    for (int row = 0; row < rows; ++row) {
      std::vector<std::span<const Detection>> pixel;
      for (std::size_t f = first; f < lit.size(); ++f) {
        pixel.push_back((f < first_lit ? dark : lit)[f].row(row));
      }
      words[r].push_back(rival.read_pixel(pixel));
    }
  }
  return words;
}

}  // namespace dtof
