// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/random.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {

/// A pixel with a pulse at `code` (none: -1) over background in each of `slots` slots.
inline std::vector<Detection> pulse(int np, int slots, int code, double signal, double background,
                                    int acquisitions, CounterRandom& random) {
  const int codes = 1 << np;
  std::vector<Detection> stream;
  for (int a = 0; a < acquisitions; ++a) {
    std::vector<int> times;
    for (int slot = 0; slot < slots; ++slot) {
      if (random.uniform() < background) {
        times.push_back(pick(random, codes));
      } else if (code >= 0 && random.uniform() < signal) {
        double gauss = -6.0;
        for (int i = 0; i < 12; ++i) {
          gauss += random.uniform();
        }
        times.push_back(
            std::clamp(static_cast<int>(std::lround(code + 0.019 * codes * gauss)), 0, codes - 1));
      }
    }
    std::ranges::sort(times);
    for (const int time : times) {
      stream.push_back({static_cast<std::uint32_t>(a), static_cast<Timestamp>(time)});
    }
  }
  return stream;
}

/// Patches of surfaces, slanted in both directions, with holes.
inline std::vector<ColumnStream> surfaces(int np, int slots, int columns, int rows, double background,
                                          int acquisitions, CounterRandom& random) {
  const int codes = 1 << np;
  struct Patch {
    int left, top, right, bottom, base, across, down;
  };
  std::vector<Patch> patches = {
      {0, 0, columns, rows, pick(random, codes), pick(random, 21) - 10, pick(random, 21) - 10}};
  for (int i = 0; i < 4; ++i) {
    const int left = pick(random, columns);
    const int top = pick(random, rows);
    patches.push_back({left, top, left + 1 + pick(random, columns), top + 1 + pick(random, rows),
                       pick(random, codes), pick(random, 21) - 10, pick(random, 21) - 10});
  }
  const double signal = 0.01 + 0.2 * random.uniform();
  std::vector<ColumnStream> array(static_cast<std::size_t>(columns));
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r < rows; ++r) {
      int code = 0;
      for (const Patch& patch : patches) {
        if (c >= patch.left && c < patch.right && r >= patch.top && r < patch.bottom) {
          code = std::clamp(patch.base + patch.across * c + patch.down * r, 0, codes - 1);
        }
      }
      code = pick(random, 12) == 0 ? -1 : code;
      array[static_cast<std::size_t>(c)].append_row(
          pulse(np, slots, code, signal, background, acquisitions, random));
    }
  }
  return array;
}

}  // namespace dtof
