// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "tests/readout/pool_reference.hpp"

namespace dtof {

PoolReference::PoolReference(const std::vector<ColumnStream>& columns, int np, int acquisitions, Open open,
                             Used before)
    : before_(std::move(before)),
      columns_(static_cast<int>(columns.size())),
      rows_(columns.front().rows()),
      np_(np),
      all_(acquisitions),
      open_(open) {
  const int scale = 1 << (16 - np);
  for (int c = 0; c < columns_; ++c) {
    for (int r = 0; r < rows_; ++r) {
      Pixel& pixel = pixels_[{c, r}];
      pixel.score.assign(static_cast<std::size_t>(labels()), 0);
      for (const Detection& d : columns[static_cast<std::size_t>(c)].row(r)) {
        if (d.timestamp != (1 << np) - 1) {
          std::vector<int>& times = pixel.seen[static_cast<int>(d.acquisition)];
          if (times.size() < 2) {
            times.push_back(d.timestamp * scale + scale / 2);
          }
        }
      }
    }
  }
}

std::vector<std::vector<PixelResult>> PoolReference::run() {
  coarse();
  for (auto& [place, group] : groups_) {
    decode(place, group);
  }
  for (auto& [place, pixel] : pixels_) {
    for (const auto& [a, times] : pixel.seen) {
      if (a >= coarse_end() && a < track_end()) {
        track(pixel, group(place), a, times);
      }
    }
  }
  for (int c = 0; c < columns_; ++c) {
    choose(c);
  }
  for (auto& [place, pixel] : pixels_) {
    for (const auto& [a, times] : pixel.seen) {
      if (a >= track_end()) {
        open_.lean ? point_lean(pixel, group(place), a, times) : point(pixel, a, times);
      }
    }
  }
  for (int c = 0; c < columns_; ++c) {
    decide(c);
  }
  std::vector<std::vector<PixelResult>> results(static_cast<std::size_t>(columns_));
  for (const auto& [place, pixel] : pixels_) {
    results[static_cast<std::size_t>(place.column)].push_back(result(place));
  }
  return results;
}

PoolReference::Used PoolReference::used() const {
  Used used;
  for (const auto& [place, pixel] : pixels_) {
    used[{place.column / 2, place.row / group_rows()}].insert(pixel.chosen);
  }
  return used;
}

int PoolReference::preferred(int a, const std::vector<int>& times) {
  return a % 2 == 1 && times.size() == 2 ? times[1] : times[0];
}

void PoolReference::coarse() {
  for (const auto& [place, pixel] : pixels_) {
    (void)group(place);  // one without a timestamp is a group, too
  }
  for (int a = 0; a < coarse_end(); ++a) {
    if ((a + 1) % 64 == 0) {
      for (auto& [place, swept] : groups_) {
        sweep(swept);
      }
      continue;
    }
    for (int c = 0; c < columns_; ++c) {
      for (int r = 0; r < rows_; r += 2) {
        // Even acquisitions are the even row's turn, if it has a timestamp.
        for (const int row : {r + a % 2, r + 1 - a % 2}) {
          const auto pixel = pixels_.find({c, row});
          if (pixel != pixels_.end() && pixel->second.seen.contains(a)) {
            Group& counting = group({c, r});
            int& bin = counting.h[static_cast<std::size_t>(preferred(a, pixel->second.seen[a]) / 2048)];
            bin = counting.frozen ? bin : std::min(127, bin + 1);
            break;
          }
        }
      }
    }
  }
}

void PoolReference::sweep(Group& swept) {
  std::vector<int> ascending = swept.h;
  std::sort(ascending.begin(), ascending.end());
  if (swept.frozen || ascending.back() != 127) {
    return;
  }
  swept.frozen = ascending.front() < 32;
  for (int& bin : swept.h) {
    bin -= swept.frozen ? 0 : 32;
  }
}

void PoolReference::decode(Place place, Group& own) {
  std::vector<Group*> beside;
  int missing = 0;
  for (const Place at : {Place{place.column, place.row - 1}, Place{place.column, place.row + 1},
                         Place{place.column - 1, place.row}, Place{place.column + 1, place.row}}) {
    const auto found = groups_.find(at);
    beside.push_back(found == groups_.end() ? &own : &found->second);
    missing += found == groups_.end() ? 1 : 0;
  }
  std::array<int, 4> octets{};
  std::vector<int> w;
  std::vector<int> raise;
  for (std::size_t i = 0; i < 32; ++i) {
    octets[i / 8] += own.h[i];
    if (i < 31) {
      w.push_back(0);
      for (const std::size_t j : {i, i + 1}) {
        int sum = 3 * own.h[j];
        for (const Group* other : beside) {
          sum += other->h[j];
        }
        w.back() += std::max(0, sum - 4 * open_.taken[j]);
      }
      bool wanted = false;
      for (const int cell : before_[place]) {
        wanted = wanted || (cell >= 4 * static_cast<int>(i) + 2 && cell <= 4 * static_cast<int>(i) + 6);
      }
      raise.push_back(wanted ? 28 : 0);
      w.back() += raise.back();
    }
  }
  own.b = 5 * *std::min_element(octets.begin(), octets.end()) / 128;
  own.b = open_.lean ? own.b / 4 * 4 + 2 : own.b;
  own.tilted = 2 * octets[0] - 32 > *std::min_element(octets.begin(), octets.end()) * 3;
  std::vector<int> earlier = w;
  std::vector<int> free_pairs(31);
  std::iota(free_pairs.begin(), free_pairs.end(), 0);
  std::erase_if(free_pairs, [&](int i) {
    bool hidden = false;
    for (int bin = std::max(i - 2, 0); bin <= std::min(i + 1, 6); ++bin) {
      hidden = hidden || open_.taken[static_cast<std::size_t>(bin)] > 127;
    }
    return hidden;
  });
  int least = 1 << 20;
  for (const int i : free_pairs) {
    least = std::min(least, w[static_cast<std::size_t>(i)]);
  }
  const auto value = [&](int i) { return i < 0 || i > 30 ? 0 : w[static_cast<std::size_t>(i)]; };
  for (int k = 0; k < labels(); ++k) {
    const int peak = *std::max_element(free_pairs.begin(), free_pairs.end(),
                                       [&](int i, int j) { return value(i) < value(j); });
    const int difference = value(peak + 1) - value(peak - 1);
    const int height = value(peak) - std::min(value(peak + 1), value(peak - 1));
    int cell = 4 * peak + 4;
    if (height > 0 && 2 * difference > height) {
      ++cell;
    } else if (height > 0 && -2 * difference > height) {
      --cell;
    }
    own.cell.push_back(cell);
    own.significance.push_back(
        significance(w, earlier, peak, missing, raise[static_cast<std::size_t>(peak)]));
    earlier = w;
    const int leak = (value(peak) - least) / 8;
    for (const int i : {peak - 2, peak + 2}) {
      if (i >= 0 && i <= 30 && value(peak) > least) {
        w[static_cast<std::size_t>(i)] = std::max(0, value(i) - leak);
      }
    }
    std::erase_if(free_pairs, [&](int i) { return std::abs(i - peak) <= 1; });
  }
}

int PoolReference::lg(int x) {
  int e = 0;
  while (x >> (e + 1) != 0) {
    ++e;
  }
  return 8 * e + x * 8 / (1 << e) - 8;
}

int PoolReference::significance(const std::vector<int>& w, const std::vector<int>& earlier, int peak,
                                int missing, int raise) const {
  // The pairs beyond the peak are those before the last candidate's leakage was taken.
  std::vector<int> sides;
  for (const int away : {-4, -3, 3, 4}) {
    const int at = peak + away;
    const bool inside = away < 0 ? peak >= 4 : peak <= 26;
    sides.push_back(!inside    ? 0
                    : away < 0 ? w[static_cast<std::size_t>(at)]
                               : earlier[static_cast<std::size_t>(at)]);
  }
  const int low = sides[0] + sides[1];
  const int high = sides[2] + sides[3];
  const int around = peak < 4 ? high * 9 / 4 : peak > 26 ? 2 * low : low + high;
  const int height = 4 * (w[static_cast<std::size_t>(peak)] - raise) - around;
  if (height < 1) {
    return 0;
  }
  const int long_frame = all_ > 3333 ? (lg(all_) - 93) / 2 : 0;
  const int above = 2 * lg(height) - lg(around * 9 / 8 + 64) - 36 - long_frame - 4 * missing;
  const int z = above < 0 ? 0 : std::min(7, above / 4);
  return open_.prior ? (z < 3 ? 0 : (z - 1) / 2) : z;
}

}  // namespace dtof
