// SPDX-License-Identifier: Apache-2.0
#include "tests/demonstrator/generated_photons.hpp"

#include <algorithm>

namespace dtof {

GeneratedPhotons::GeneratedPhotons(int np, int columns, int rows) : np_(np), columns_(columns) {
  const int codes = 1 << np;
  const int first = codes / 8;
  const int step = (codes - 2 * first) / (columns * rows);
  for (int pixel = 0; pixel < columns * rows; ++pixel) {
    targets_.push_back(first + pixel * step);
  }
}

std::vector<ColumnStream> GeneratedPhotons::acquire(std::uint32_t acquisitions) {
  constexpr int kReach = 31;
  const auto columns = static_cast<std::size_t>(columns_);
  const int none = (1 << np_) - 1;
  // Acquisitions follow each other; a column stream has them pixel by pixel.
  std::vector<std::vector<Detection>> pixels(targets_.size());
  for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
    for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
      const auto bits = [this](unsigned from, unsigned count) {
        return static_cast<int>((random_ >> from) & ((1U << count) - 1));
      };
      int place = targets_[pixel] + bits(2, 5) + bits(7, 5) - kReach;
      if (bits(0, 2) != 0 || place < 0 || place > none) {
        place = none;
      }
      const int background = bits(12, 1) != 0 ? bits(13, static_cast<unsigned>(np_)) : none;
      for (const int code : {std::min(place, background), std::max(place, background)}) {
        pixels[pixel].push_back({acquisition, static_cast<Timestamp>(code)});
      }
      random_ ^= random_ << 13U;
      random_ ^= random_ >> 17U;
      random_ ^= random_ << 5U;
    }
  }
  std::vector<ColumnStream> streams(columns);
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel) {
    streams[pixel % columns].append_row(pixels[pixel]);
  }
  return streams;
}

}  // namespace dtof
