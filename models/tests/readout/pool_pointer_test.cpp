// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_pointer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// ---- An independent reference, as slow and as close to docs/reference/poolpointer.md as possible --------
//
// A dictionary from (column, row) to a pixel, plain numbers where the model has named parameters, no cells
// where positions do, and every chain solved anew for every label of every pixel.

struct Place {
  int column;
  int row;
  bool operator<(const Place& other) const {
    return column != other.column ? column < other.column : row < other.row;
  }
};

struct Pixel {
  std::map<int, std::vector<int>> seen;  // acquisition: positions of the first one or two timestamps
  std::vector<int> score;
  int leader = 0;
  int offset = 0;
  int chosen = 0;
  bool sure = false;
  int alone = 0;  // where its leader's pointer would start without its neighbours
  int n = 0, pa = 0, pb = 0;
  int ka = 0, kb = 0;  // lean: whose candidates they are
  int winner = 0, loser = 0, margin = 0;
  int significance = 0;
};

struct Group {
  std::vector<int> h = std::vector<int>(32, 0);
  std::vector<int> cell;
  int b = 0;
  bool frozen = false;
  bool tilted = false;
  std::vector<int> significance;  // of each candidate
};

int floor_divide(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

class Reference {
 public:
  /// What the definition leaves open.
  struct Open {
    int coarse = 14;  // 64ths
    int track = 30;
    bool left_needs_margin = false;
    bool smooth = true;
    bool lean = false;  ///< the numbers of poolPointer lean
    bool second_target = false;
    int cell = 512;               ///< positions of a settled pointer's cell
    bool prior = false;           ///< the array has PRIOR = 1
    std::array<int, 32> taken{};  ///< fours that a bin's sum loses
  };

  /// By group, the cells that its pixels chose.
  using Used = std::map<Place, std::set<int>>;

  /// One engine: columns from left to right. `before`: of the last frame.
  Reference(const std::vector<ColumnStream>& columns, int np, int acquisitions, Open open, Used before = {})
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

  std::vector<std::vector<PixelResult>> run() {
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

  /// Behind run().
  [[nodiscard]] Used used() const {
    Used used;
    for (const auto& [place, pixel] : pixels_) {
      used[{place.column / 2, place.row / group_rows()}].insert(pixel.chosen);
    }
    return used;
  }

 private:
  [[nodiscard]] int coarse_end() const { return all_ * open_.coarse / 64; }
  [[nodiscard]] int track_end() const { return all_ * (open_.coarse + open_.track) / 64; }

  [[nodiscard]] int labels() const { return open_.lean ? 4 : 5; }
  [[nodiscard]] int group_rows() const { return open_.lean ? 8 : 4; }

  Group& group(Place place) { return groups_[{place.column / 2, place.row / group_rows()}]; }

  static int preferred(int a, const std::vector<int>& times) {
    return a % 2 == 1 && times.size() == 2 ? times[1] : times[0];
  }

  void coarse() {
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

  static void sweep(Group& swept) {
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

  void decode(Place place, Group& own) {
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

  /// 2^-3 (8 e + m), m the next three bits of x behind its first one.
  static int lg(int x) {
    int e = 0;
    while (x >> (e + 1) != 0) {
      ++e;
    }
    return 8 * e + x * 8 / (1 << e) - 8;
  }

  [[nodiscard]] int significance(const std::vector<int>& w, const std::vector<int>& earlier, int peak,
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

  /// True if a position counts for no label, because background comes early.
  static bool thinned(int a, int x) {
    constexpr std::array<int, 8> kLate = {0, 4, 2, 6, 1, 5, 3, 7};
    const int sixteens = a / 16;
    return sixteens % 4 == 0 && kLate[static_cast<std::size_t>(sixteens / 4 % 8)] + x / 8192 < 7;
  }

  /// Distance from a position in whole cells, towards minus infinity.
  static int cells(int x, int from) { return floor_divide(x - from, 512); }

  template <typename Test>
  static int take(int a, const std::vector<int>& times, Test inside) {
    const int first_choice = preferred(a, times);
    for (const int x : times) {
      if (!inside(first_choice) && inside(x)) {
        return x;
      }
    }
    return first_choice;
  }

  /// The first candidate whose window has a position; -1 if none has.
  static int label_of(const Group& g, int x) {
    for (std::size_t k = 0; k < g.cell.size(); ++k) {
      if (near_candidate(g, static_cast<int>(k), x)) {
        return static_cast<int>(k);
      }
    }
    return -1;
  }
  static bool near_candidate(const Group& g, int k, int x) {
    const int d = cells(x, 512 * g.cell[static_cast<std::size_t>(k)]);
    return d >= -4 && d <= 3;
  }

  void track(Pixel& pixel, const Group& g, int a, const std::vector<int>& times) const {
    if (g.b > 3 && thinned(a, preferred(a, times))) {
      return;
    }
    const int x = take(a, times, [&](int time) { return label_of(g, time) >= 0; });
    auto& score = pixel.score;
    const auto lead = static_cast<std::size_t>(pixel.leader);
    const int e = cells(preferred(a, times), 512 * g.cell[lead] + 64 * pixel.offset);
    const int step = score[lead] < 3 ? 4 : score[lead] < 8 ? 2 : 1;
    if (open_.lean) {
      // There is no offset, and who leads is asked in choose.
    } else if (e >= 1 && e <= 7) {
      pixel.offset = std::min(31, pixel.offset + step);
    } else if (e >= -8 && e <= -2) {
      pixel.offset = std::max(-32, pixel.offset - step);
    }
    const int label = label_of(g, x);
    if (label < 0) {
      return;
    }
    const auto k = static_cast<std::size_t>(label);
    if (score[k] == 15) {
      for (std::size_t other = 0; other < score.size(); ++other) {
        score[other] = other == k ? 15 : std::max(0, score[other] - 1);
      }
    } else {
      ++score[k];
    }
    if (!open_.lean && score[k] > score[lead]) {
      pixel.leader = label;
      pixel.offset = 0;
    }
  }

  /// Evidence of a pixel's scores alone.
  std::vector<int> own_evidence(Place place) {
    std::vector<int> e = pixels_.at(place).score;
    for (std::size_t k = 2; k < e.size(); ++k) {
      e[k] -= group(place).b / 8;
    }
    return e;
  }

  static std::pair<std::size_t, std::size_t> best_two(const std::vector<int>& values) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < values.size(); ++k) {
      order.push_back(k);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return values[i] > values[j]; });
    return {order[0], order[1]};
  }

  /// By pixel and label, the best sum over all assignments of the other pixels, found by walking outwards
  /// from the pixel.
  static std::vector<std::vector<int>> beliefs(const std::vector<std::vector<int>>& evidence,
                                               const std::vector<std::vector<int>>& position,
                                               const std::vector<int>& lambda) {
    std::vector<std::vector<int>> best(evidence.size());
    for (std::size_t fixed = 0; fixed < evidence.size(); ++fixed) {
      for (std::size_t label = 0; label < evidence[fixed].size(); ++label) {
        best[fixed].push_back(evidence[fixed][label] +
                              beyond(evidence, position, lambda, static_cast<int>(fixed), label, -1) +
                              beyond(evidence, position, lambda, static_cast<int>(fixed), label, +1));
      }
    }
    return best;
  }

  /// Best sum of all pixels on one side of a pixel that has a label; they pay their own lambdas towards it.
  static int beyond(const std::vector<std::vector<int>>& evidence,
                    const std::vector<std::vector<int>>& position, const std::vector<int>& lambda, int pixel,
                    std::size_t label, int direction) {
    const int end = direction < 0 ? 0 : static_cast<int>(evidence.size()) - 1;
    if (pixel == end) {
      return 0;
    }
    std::vector<int> value(evidence[static_cast<std::size_t>(end)]);
    for (int at = end; at != pixel + direction; at -= direction) {
      const auto from = static_cast<std::size_t>(at);
      const auto to = static_cast<std::size_t>(at - direction);
      std::vector<int> next(evidence[to]);
      for (std::size_t l = 0; l < next.size(); ++l) {
        next[l] += best_step(value, position[from], position[to][l], lambda[from]);
      }
      value = next;
    }
    const int neighbour = pixel + direction;
    const auto next_to = static_cast<std::size_t>(neighbour);
    return best_step(value, position[next_to], position[static_cast<std::size_t>(pixel)][label],
                     lambda[next_to]);
  }
  static int best_step(const std::vector<int>& value, const std::vector<int>& from, int to, int lambda) {
    int best = -1000000;
    for (std::size_t k = 0; k < value.size(); ++k) {
      best = std::max(best, value[k] - (std::abs(from[k] - to) > 2048 ? lambda : 0));
    }
    return best;
  }

  void choose(int c) {
    std::vector<std::vector<int>> evidence;
    std::vector<std::vector<int>> position;
    std::vector<int> lambda;
    for (int r = 0; r < rows_; ++r) {
      const Group& g = group({c, r});
      std::vector<int> e = own_evidence({c, r});
      for (std::size_t k = 0; k < e.size(); ++k) {
        const bool heard = c > 0 && (pixels_.at({c - 1, r}).sure || !open_.left_needs_margin);
        if (heard && std::abs(g.cell[k] - pixels_.at({c - 1, r}).chosen) > 4) {
          e[k] -= 2 + 3 * g.b / 16;
        }
        if (c + 1 < columns_) {
          const std::vector<int> told = own_evidence({c + 1, r});
          const auto [p, q] = best_two(told);
          const std::vector<int>& cell = group({c + 1, r}).cell;
          const int most = 1 + 3 * g.b / 16;
          if (std::abs(cell[p] - g.cell[k]) > 4) {
            e[k] -= std::abs(cell[q] - g.cell[k]) > 4 ? most : std::min(told[p] - told[q], most);
          }
        }
      }
      evidence.push_back(e);
      position.emplace_back();
      for (const int cell : g.cell) {
        position.back().push_back(512 * cell);
      }
      lambda.push_back(2 + 5 * g.b / 16);
    }
    const auto belief = beliefs(evidence, position, lambda);
    for (int r = 0; r < rows_; ++r) {
      Pixel& pixel = pixels_.at({c, r});
      const Group& g = group({c, r});
      const auto [a, b] = best_two(belief[static_cast<std::size_t>(r)]);
      const auto start = [&](std::size_t k) {
        return 512 * g.cell[k] + (static_cast<int>(k) == pixel.leader ? 64 * pixel.offset : 0);
      };
      pixel.chosen = g.cell[a];
      pixel.n = std::min(open_.lean ? 7 : 63,
                         belief[static_cast<std::size_t>(r)][a] - belief[static_cast<std::size_t>(r)][b]);
      pixel.sure = pixel.n > 0;
      pixel.alone = start(a);
      pixel.pa = pixel.alone;
      pixel.pb = floor_divide(start(b), 512);
      pixel.ka = static_cast<int>(a);
      pixel.kb = static_cast<int>(b);
    }
    for (int r = 0; r < rows_ && !open_.lean; ++r) {
      pixels_.at({c, r}).pa += towards_neighbours({c, r}, [](const Pixel& pixel) { return pixel.alone; });
    }
  }

  /// Those above, below and to the left that are near.
  template <typename Position>
  std::vector<Place> near_places(Place place, Position position) {
    const bool small = group(place).b < 6 || std::abs(pixels_.at(place).margin) > 63;
    const int reach = open_.cell == 1024 ? 2048 : small ? 1024 : 1536;
    std::vector<Place> near;
    for (const Place at : {Place{place.column, place.row - 1}, Place{place.column, place.row + 1},
                           Place{place.column - 1, place.row}}) {
      if (pixels_.contains(at) && std::abs(position(pixels_.at(at)) - position(pixels_.at(place))) <= reach) {
        near.push_back(at);
      }
    }
    return near;
  }

  /// By how much a position moves towards those of the pixels above, below and to the left.
  template <typename Position>
  int towards_neighbours(Place place, Position position) {
    int sum = 0;
    for (const Place at : near_places(place, position)) {
      sum += position(pixels_.at(at)) - position(pixels_.at(place));
    }
    return sum >= 0 ? sum / 4 : -(-sum / 4);
  }

  /// Moves lean's pointer: the rival stays at its candidate, and the pointer leaves its own candidate by at
  /// most half a coarse bin.
  void point_lean(Pixel& pixel, const Group& g, int a, const std::vector<int>& times) const {
    const int centre = 512 * g.cell[static_cast<std::size_t>(pixel.ka)];
    int x = preferred(a, times);
    if (a % 2 == 0 && times.size() == 2 && label_of(g, x) < 0) {
      x = times[1];
    }
    const int distance = x - pixel.pa;
    const int cell = pixel.n >= 12 ? open_.cell : 512;
    const bool hit = distance >= -5 * cell && distance < 5 * cell;
    const bool rival = !hit && near_candidate(g, pixel.kb, x);
    const int n = pixel.n;
    if (rival && n == 0) {
      std::swap(pixel.ka, pixel.kb);
      pixel.pa = 512 * g.cell[static_cast<std::size_t>(pixel.ka)];
      pixel.n = 1;
      return;
    }
    if (distance >= -8 * cell && distance < 8 * cell) {
      const std::map<int, int> gears = {{3, 512}, {7, 256}, {11, 128}, {13, 64}, {14, 32}, {15, 16}};
      constexpr std::array<int, 8> kWeight = {1, 3, 4, 4, 4, 3, 2, 1};
      const int away = distance >= 0 ? distance / cell : (-distance - 1) / cell;
      const int product = gears.lower_bound(n)->second * kWeight[static_cast<std::size_t>(away)];
      const int move = (product + 16 * (a % 4) + a / 4 % 16) / 64 * 16;
      pixel.pa = std::clamp(distance >= 0 ? pixel.pa + move : pixel.pa - move, centre - 2048, centre + 2032);
    }
    const int every = n < 8 ? 1 : n < 12 ? 4 : 16;
    if (a % every == 0 && !thinned(a, x)) {
      pixel.n = hit ? std::min(15, n + 1) : rival ? n - 1 : n;
    }
  }

  void point(Pixel& pixel, int a, const std::vector<int>& times) const {
    const auto inside = [&](int time) {
      const int away = time / 512 - pixel.pa / 512;
      return away >= -8 && away <= 7;
    };
    const int x = take(a, times, inside);
    const int distance = x - pixel.pa;
    const int cell = pixel.n >= 16 ? open_.cell : 512;
    const bool hit = distance >= -5 * cell && distance < 5 * cell;
    const int f = x / 512 - pixel.pb;
    const bool rival = !hit && f >= -6 && f <= 5;
    const int n = pixel.n;
    if (rival && n == 0) {
      const int old = pixel.pa;
      pixel.pa = 512 * pixel.pb + 256;
      pixel.pb = old / 512;
      pixel.n = 1;
      return;
    }
    if (distance >= -8 * cell && distance < 8 * cell) {
      const std::map<int, int> gears = {{7, 256}, {15, 128}, {31, 64}, {63, 32}, {79, 16},
                                        {99, 8},  {115, 4},  {123, 2}, {127, 1}};
      constexpr std::array<int, 8> kWeight = {1, 3, 4, 4, 4, 3, 2, 1};
      const int away = distance >= 0 ? distance / cell : (-distance - 1) / cell;
      const int product = gears.lower_bound(n)->second * kWeight[static_cast<std::size_t>(away)];
      // Positions are even: what is below two of them is dithered by the acquisition's low bits.
      const int move = (product + 2 * (a % 4) + a / 4 % 2) / 8 * 2;
      pixel.pa = std::clamp(distance >= 0 ? pixel.pa + move : pixel.pa - move, 0, 65534);
    }
    if (rival && f != 0) {
      pixel.pb += f > 0 ? 1 : -1;
    }
    const int every = n < 64 ? 1 : n < 96 ? 4 : 16;
    if (a % every == 0 && !thinned(a, x)) {
      pixel.n = hit ? std::min(127, n + 1) : rival ? n - 1 : n;
    }
  }

  void decide(int c) {
    std::vector<std::vector<int>> evidence;
    std::vector<std::vector<int>> position;
    for (int r = 0; r < rows_; ++r) {
      const Pixel& pixel = pixels_.at({c, r});
      evidence.push_back({pixel.n, 0});
      if (open_.lean) {
        position.push_back(
            {std::clamp(pixel.pa, 0, 65535), 512 * group({c, r}).cell[static_cast<std::size_t>(pixel.kb)]});
      } else {
        position.push_back({pixel.pa, 512 * pixel.pb + 256});
      }
    }
    const auto belief = beliefs(evidence, position, std::vector<int>(static_cast<std::size_t>(rows_), 2));
    for (int r = 0; r < rows_; ++r) {
      Pixel& pixel = pixels_.at({c, r});
      const auto i = static_cast<std::size_t>(r);
      pixel.margin = belief[i][0] - belief[i][1];
      pixel.winner = position[i][pixel.margin < 0 ? 1 : 0];
      pixel.loser = position[i][pixel.margin < 0 ? 0 : 1];
      const Group& g = group({c, r});
      for (std::size_t k = 0; k < g.cell.size(); ++k) {
        if (std::abs(floor_divide(pixel.winner, 512) - g.cell[k]) <= 4) {
          pixel.significance = std::max(pixel.significance, g.significance[k]);
        }
      }
    }
  }

  int confidence(Place place) {
    const Pixel& pixel = pixels_.at(place);
    const Group& g = group(place);
    const int own = std::abs(pixel.margin);
    if (open_.lean) {
      return own;
    }
    const std::vector<int> weights =
        open_.prior ? std::vector{0, 22, 32, 64} : std::vector{0, 13, 16, 20, 24, 29, 35, 64};
    const int weight = std::min(weights[static_cast<std::size_t>(pixel.significance)], 4 * own);
    if (g.tilted) {
      return weight;
    }
    int pooled = own;
    for (const Place at : near_places(place, [](const Pixel& other) { return other.winner; })) {
      pooled += std::abs(pixels_.at(at).margin);
    }
    struct Sky {
      int below;  // B
      int mean;
      std::vector<int> parts;
    };
    const std::vector<Sky> skies = {{4, 18, {4, 8}},      {8, 10, {4, 8}},     {12, 14, {4, 16}},
                                    {16, 22, {8, 16}},    {20, 36, {8, 512}},  {24, 64, {16, 64}},
                                    {28, 128, {16, 512}}, {32, 200, {32, 64}}, {40, 255, {32, 64}}};
    const auto sky = std::find_if(skies.begin(), skies.end(), [&](const Sky& s) { return g.b < s.below; });
    const int above = std::max(0, pooled - sky->mean);
    return weight + std::min(127, above / sky->parts[0] + above / sky->parts[1]);
  }

  PixelResult result(Place place) {
    const Pixel& pixel = pixels_.at(place);
    int position = pixel.winner;
    if (open_.smooth) {
      position += towards_neighbours(place, [](const Pixel& other) { return other.winner; });
    }
    const int scale = 1 << (16 - np_);
    const auto limited = [&](int x) { return std::clamp(x - scale / 2, 0, 65536 - scale - 1); };
    const int word = limited(position);
    return {static_cast<std::uint16_t>(word / scale), static_cast<std::uint16_t>(word % scale),
            static_cast<std::uint16_t>(confidence(place)),
            static_cast<std::uint16_t>(open_.second_target ? limited(pixel.loser) : 0)};
  }

  Used before_;
  int columns_;
  int rows_;
  int np_;
  int all_;
  Open open_;
  std::map<Place, Pixel> pixels_;
  std::map<Place, Group> groups_;
};

std::vector<std::vector<PixelResult>> read_array(std::span<const ColumnStream> array, int np,
                                                 std::uint32_t acquisitions, const PoolNumbers& parameters) {
  return run_pool_pointer(static_cast<int>(array.size()), reader_of(array), np, acquisitions, parameters);
}

PoolNumbers with_cells(Readout readout, int cell_shift) {
  ReadoutParameters parameters = ReadoutParameters::defaults(readout);
  parameters.pool.cell_shift = cell_shift;
  return pool_pointer_parameters(parameters);
}

PoolNumbers lean() { return with_cells(Readout::kPoolPointerLean, 9); }

void expect_as_reference(const std::vector<ColumnStream>& array, int np, int acquisitions,
                         int engine_columns = 34, Reference::Open open = {}) {
  for (const bool smooth : {false, true}) {
    open.smooth = smooth;
    PoolNumbers parameters =
        with_cells(open.lean ? Readout::kPoolPointerLean : Readout::kPoolPointer,
                   static_cast<int>(std::bit_width(static_cast<unsigned>(open.cell))) - 1);
    parameters.engine_columns = engine_columns;
    parameters.smooth = smooth;
    parameters.left_needs_margin = open.left_needs_margin ? 1 : 0;
    parameters.coarse_share = open.coarse;
    parameters.track_share = open.track;
    parameters.second_target = open.second_target;
    std::ranges::transform(open.taken, parameters.coarse_template.begin(),
                           [](int entry) { return static_cast<std::uint8_t>(entry); });
    const auto actual = read_array(array, np, static_cast<std::uint32_t>(acquisitions), parameters);
    std::vector<std::vector<PixelResult>> expected;
    for (std::size_t begin = 0; begin < array.size(); begin += static_cast<std::size_t>(engine_columns)) {
      const std::size_t end = std::min(array.size(), begin + static_cast<std::size_t>(engine_columns));
      const std::vector<ColumnStream> engine(array.begin() + static_cast<std::ptrdiff_t>(begin),
                                             array.begin() + static_cast<std::ptrdiff_t>(end));
      for (auto& column : Reference(engine, np, acquisitions, open).run()) {
        expected.push_back(std::move(column));
      }
    }
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t column = 0; column < expected.size(); ++column) {
      ASSERT_EQ(actual[column].size(), expected[column].size());
      for (std::size_t row = 0; row < expected[column].size(); ++row) {
        const PixelResult& want = expected[column][row];
        const PixelResult& got = actual[column][row];
        ASSERT_EQ(got, want) << "NP " << np << ", S1 " << smooth << ", " << array.size()
                             << " columns, engine of " << engine_columns << ", " << acquisitions
                             << " acquisitions, column " << column << ", row " << row << ": expected "
                             << want.code << '+' << want.fraction << " (" << want.confidence << "; "
                             << want.second << "), got " << got.code << '+' << got.fraction << " ("
                             << got.confidence << "; " << got.second << ')';
      }
    }
  }
}

/// A pixel with a pulse at `code` (none: -1) over background in each of `slots` slots.
std::vector<Detection> pulse(int np, int slots, int code, double signal, double background, int acquisitions,
                             CounterRandom& random) {
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
std::vector<ColumnStream> surfaces(int np, int slots, int columns, int rows, double background,
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

class PoolPointer : public testing::Test {
 protected:
  PoolPointer() : trace_(__FILE__, __LINE__, test_seed_message()) {}
  static CounterRandom random(std::uint32_t test) {
    return {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0x2000U + test, 0};
  }

 private:
  testing::ScopedTrace trace_;
};

TEST_F(PoolPointer, WordsFitTheMemory) {
  // A word of the pair's SRAM: two pixels of two columns, a part of a group's histogram, or two group words.
  struct Case {
    PoolNumbers parameters;
    int pixel_bits, word_bits, bins_of_a_word, words, most_bits_per_pixel;
  };
  for (const Case& c : {Case{{}, 29, 2 * 58, 16, 100, 40}, Case{lean(), 16, 2 * 32, 8, 90, 18}}) {
    const PoolPointerParameters common = c.parameters.common();
    EXPECT_EQ(common.word_bits(), c.pixel_bits);
    EXPECT_LE(4 * c.pixel_bits, c.word_bits);
    EXPECT_LE(2 * (7 * c.parameters.labels + common.background_bits()), c.word_bits);
    EXPECT_LE(c.bins_of_a_word * c.parameters.count_width, c.word_bits);
    EXPECT_GE(c.bins_of_a_word * c.parameters.group_rows / 2, 32);
    EXPECT_EQ(160 / 2 + 160 / c.parameters.group_rows / 2, c.words);
    EXPECT_LE(c.word_bits * c.words, c.most_bits_per_pixel * 2 * 160);
  }
}

TEST_F(PoolPointer, EveryKindOfStreamAsReference) {
  CounterRandom draw = random(1);
  ReadoutParameters shape = ReadoutParameters::defaults(Readout::kPoolPointer);
  for (const StreamKind kind : kStreamKinds) {
    SCOPED_TRACE(std::string(stream_name(kind)));
    for (const auto& [columns, rows] :
         {std::pair(1, 1), std::pair(2, 7), std::pair(3, 9), std::pair(5, 16)}) {
      shape.slots = 2 + pick(draw, 3);
      const int acquisitions = 1 + pick(draw, 500);
      std::vector<ColumnStream> array(static_cast<std::size_t>(columns));
      for (ColumnStream& column : array) {
        for (int row = 0; row < rows; ++row) {
          column.append_row(make_stream(kind, shape, static_cast<std::uint32_t>(acquisitions), draw));
        }
      }
      expect_as_reference(array, 10, acquisitions);
    }
  }
}

TEST_F(PoolPointer, SurfacesAsReference) {
  CounterRandom draw = random(2);
  constexpr std::array<double, 5> kBackgrounds = {0.0, 0.01, 0.07, 0.3, 0.6};
  for (int trial = 0; trial < 40; ++trial) {
    const int np = pick(draw, 2) == 0 ? 10 : 8 + pick(draw, 7);
    const int engine = 2 * (1 + pick(draw, 3));  // often several engines, the last one narrower
    expect_as_reference(surfaces(np, 2 + pick(draw, 3), 1 + pick(draw, 9), 1 + pick(draw, 24),
                                 kBackgrounds[static_cast<std::size_t>(pick(draw, 5))], 900, draw),
                        np, 900, engine);
  }
}

TEST_F(PoolPointer, LeanAsReference) {
  CounterRandom draw = random(8);
  constexpr std::array<double, 4> kBackgrounds = {0.0, 0.02, 0.3, 0.6};
  for (int trial = 0; trial < 40; ++trial) {
    const int np = pick(draw, 2) == 0 ? 10 : 8 + pick(draw, 7);
    Reference::Open open{.coarse = 10, .track = 14, .lean = true, .second_target = trial % 2 == 0};
    if (trial % 4 == 3) {
      open.coarse = 1 + pick(draw, 30);
      open.track = 1 + pick(draw, 30);
    }
    expect_as_reference(surfaces(np, 2 + pick(draw, 3), 1 + pick(draw, 9), 1 + pick(draw, 24),
                                 kBackgrounds[static_cast<std::size_t>(pick(draw, 4))], 900, draw),
                        np, 900, 2 * (1 + pick(draw, 3)), open);
  }
  // Two surfaces as bright as each other, one of them at an end of the range, which its pointer oversteps.
  for (const int end : {0, 1022}) {
    std::vector<ColumnStream> array(4);
    for (ColumnStream& column : array) {
      for (int row = 0; row < 24; ++row) {
        std::vector<Detection> stream;
        for (std::uint32_t a = 0; a < 400; ++a) {
          const int code = std::abs(end - pick(draw, 12));
          stream.push_back({a, static_cast<Timestamp>(pick(draw, 2) == 0 ? 500 + pick(draw, 12) : code)});
        }
        column.append_row(stream);
      }
    }
    expect_as_reference(array, 10, 400, 34, {.coarse = 10, .track = 14, .lean = true, .second_target = true});
  }
}

// Windows for short and for long pulses: pointers that settle, many of them soon.
TEST_F(PoolPointer, OtherCellsAsReference) {
  CounterRandom draw = random(9);
  constexpr std::array<double, 3> kBackgrounds = {0.01, 0.2, 0.5};
  std::size_t changed = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const bool is_lean = trial % 2 == 1;
    const Readout readout = is_lean ? Readout::kPoolPointerLean : Readout::kPoolPointer;
    const int np = trial % 3 == 0 ? 10 : 8 + pick(draw, 9);
    const auto array = surfaces(np, 2 + pick(draw, 3), 1 + pick(draw, 7), 1 + pick(draw, 24),
                                kBackgrounds[static_cast<std::size_t>(pick(draw, 3))], 900, draw);
    const auto usual = read_array(array, np, 900, with_cells(readout, 9));
    for (const int shift : {8, 10}) {
      expect_as_reference(array, np, 900, 4,
                          {.coarse = is_lean ? 10 : 14,
                           .track = is_lean ? 14 : 20,
                           .lean = is_lean,
                           .second_target = trial % 4 < 2,
                           .cell = 1 << shift});
      changed += read_array(array, np, 900, with_cells(readout, shift)) != usual ? 1 : 0;
    }
  }
  EXPECT_GT(changed, 40U) << "the cells changed nothing";
}

TEST_F(PoolPointer, TemplatesAsReference) {
  CounterRandom draw = random(12);
  std::size_t changed = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const bool is_lean = trial % 2 == 1;
    Reference::Open open{
        .coarse = is_lean ? 10 : 14, .track = is_lean ? 14 : 20, .lean = is_lean, .second_target = true};
    const auto array = surfaces(10, 2, 1 + pick(draw, 7), 1 + pick(draw, 24), 0.1, 900, draw);
    const PoolNumbers usual = with_cells(is_lean ? Readout::kPoolPointerLean : Readout::kPoolPointer, 9);
    PoolNumbers told = usual;
    for (std::size_t i = 0; i < open.taken.size(); ++i) {
      const std::array<int, 4> kinds = {0, 255, pick(draw, 256), pick(draw, 16)};
      open.taken[i] = kinds[static_cast<std::size_t>(pick(draw, 4))];
      told.coarse_template[i] = static_cast<std::uint8_t>(open.taken[i]);
    }
    expect_as_reference(array, 10, 900, 4, open);
    changed += read_array(array, 10, 900, told) != read_array(array, 10, 900, usual) ? 1 : 0;
  }
  EXPECT_GT(changed, 12U) << "the templates changed nothing";
}

// A bin that is filled by what is in front of the sensor alone is no candidate, whatever it counts.
TEST_F(PoolPointer, TemplateHidesCrosstalk) {
  CounterRandom draw = random(13);
  constexpr int kAcquisitions = 1000;
  constexpr int kTarget = 600;
  std::vector<ColumnStream> array(4);
  for (ColumnStream& column : array) {
    for (int row = 0; row < 16; ++row) {
      std::vector<Detection> stream;
      for (std::uint32_t a = 0; a < kAcquisitions; ++a) {
        if (draw.uniform() < 0.3) {
          stream.push_back({a, static_cast<Timestamp>(40 + pick(draw, 20))});
        }
        if (draw.uniform() < 0.1) {
          stream.push_back({a, static_cast<Timestamp>(kTarget + pick(draw, 20))});
        }
      }
      column.append_row(stream);
    }
  }
  PoolNumbers parameters;
  const auto share_at_target = [&] {
    int right = 0;
    for (const auto& column : read_array(array, 10, kAcquisitions, parameters)) {
      right += static_cast<int>(std::ranges::count_if(
          column, [](const PixelResult& result) { return std::abs(result.code - kTarget - 10) < 20; }));
    }
    return right;
  };
  EXPECT_EQ(share_at_target(), 0);
  parameters.coarse_template[1] = 255;
  EXPECT_EQ(share_at_target(), 64);
}

// The numbers and switches that are still being chosen.
TEST_F(PoolPointer, OtherSharesAndSwitchesAsReference) {
  CounterRandom draw = random(6);
  for (int trial = 0; trial < 24; ++trial) {
    const Reference::Open open{.coarse = 8 + pick(draw, 16),
                               .track = 8 + pick(draw, 24),
                               .left_needs_margin = trial % 2 == 1,
                               .smooth = true,
                               .second_target = trial % 3 != 1};
    const double background = trial % 3 == 0 ? 0.02 : 0.3;
    expect_as_reference(surfaces(10, 2, 1 + pick(draw, 9), 1 + pick(draw, 24), background, 700, draw), 10,
                        700, 2 * (1 + pick(draw, 3)), open);
  }
}

// A pixel that is sure of nothing may be kept from telling the next column something.
TEST_F(PoolPointer, NothingDetectedIsNoConfidence) {
  std::vector<ColumnStream> array(3);
  for (ColumnStream& column : array) {
    for (int row = 0; row < 8; ++row) {
      column.finish_row();
    }
  }
  PoolNumbers parameters;
  parameters.left_needs_margin = 1;
  for (const auto& column : read_array(array, 10, 3333, parameters)) {
    EXPECT_THAT(column, testing::Each(PixelResult{31, 32, 0}));
  }
}

// Frames of a scene that moves by two columns, and is another one in the end.
TEST_F(PoolPointer, VideosAsReference) {
  CounterRandom draw = random(7);
  constexpr int kAcquisitions = 500;
  constexpr int kColumns = 7;
  PoolNumbers parameters;
  parameters.engine_columns = 4;
  parameters.keeps_prior = true;
  std::size_t changed = 0;
  for (int video = 0; video < 6; ++video) {
    const int rows = 5 + pick(draw, 12);
    std::vector<PoolPrior> priors;
    std::array<Reference::Used, 2> used;
    const auto wide = surfaces(10, 2, kColumns + 4, rows, 0.5, 3 * kAcquisitions, draw);
    for (int frame = 0; frame < 4; ++frame) {
      SCOPED_TRACE(testing::Message() << "video " << video << ", frame " << frame);
      std::vector<ColumnStream> array(kColumns);
      for (int column = 0; column < kColumns; ++column) {
        for (int row = 0; row < rows; ++row) {
          // The frame's own part of the long stream; the last frame is upside down.
          const int from = frame == 3 ? rows - 1 - row : row;
          std::vector<Detection> pixel;
          for (Detection detection : wide[static_cast<std::size_t>(column + 2 * (frame % 3))].row(from)) {
            const auto part = static_cast<int>(detection.acquisition) / kAcquisitions;
            detection.acquisition %= kAcquisitions;
            if (part == frame % 3) {
              pixel.push_back(detection);
            }
          }
          array[static_cast<std::size_t>(column)].append_row(pixel);
        }
      }
      const auto actual =
          run_pool_pointer(kColumns, reader_of(std::span(array)), 10, kAcquisitions, parameters, &priors);
      const auto alone = read_array(array, 10, kAcquisitions, parameters);
      if (frame == 0) {
        EXPECT_EQ(actual, alone);
      }
      changed += actual != alone ? 1 : 0;
      for (std::size_t engine = 0; engine < used.size(); ++engine) {
        const std::size_t first = engine * 4;
        const std::size_t end = std::min<std::size_t>(first + 4, kColumns);
        Reference reference({array.begin() + static_cast<std::ptrdiff_t>(first),
                             array.begin() + static_cast<std::ptrdiff_t>(end)},
                            10, kAcquisitions, {.prior = true}, used[engine]);
        const auto expected = reference.run();
        used[engine] = reference.used();
        for (std::size_t column = 0; column < expected.size(); ++column) {
          ASSERT_EQ(actual[first + column], expected[column]) << "engine " << engine << ", column " << column;
        }
      }
    }
  }
  EXPECT_GT(changed, 6U) << "the prior changed nothing";
}

// All gears, the dither below a position's unit and the counts that are slowed down.
TEST_F(PoolPointer, LongFramesAsReference) {
  CounterRandom draw = random(3);
  std::vector<ColumnStream> array(3);
  for (ColumnStream& column : array) {
    for (int row = 0; row < 6; ++row) {
      column.append_row(pulse(10, 2, 300 + 20 * row, 0.8, 0.1, 3333, draw));
    }
  }
  expect_as_reference(array, 10, 3333);
  std::vector<PoolColumn> events;
  for (const ColumnStream& column : array) {
    events.push_back(pool_column_events(column, 10, 3333));
  }
  for (const PoolWinners& column : read_engine(events, 3333, {})) {
    for (const PoolWinner& winner : column) {
      EXPECT_GE(winner.margin, 116) << "the finest gears were not reached";
    }
  }
}

// Bins that fill: in light alone all of them, so that sweeps make room; of a strong pulse only its own, so
// that a sweep freezes the group.
TEST_F(PoolPointer, FullBinsAsReference) {
  CounterRandom draw = random(10);
  constexpr int kAcquisitions = 4000;
  for (const auto& [signal, background] :
       {std::pair(0.0, 0.95), std::pair(0.03, 0.9), std::pair(0.9, 0.02)}) {
    std::vector<ColumnStream> array(3);
    for (ColumnStream& column : array) {
      for (int row = 0; row < 9; ++row) {
        column.append_row(pulse(10, 2, 300 + 20 * row, signal, background, kAcquisitions, draw));
      }
    }
    for (const bool lean : {false, true}) {
      expect_as_reference(array, 10, kAcquisitions, 34, {.coarse = 40, .track = 12, .lean = lean});
    }
  }
}

TEST_F(PoolPointer, ShortFramesAsReference) {
  CounterRandom draw = random(4);
  const ReadoutParameters shape = ReadoutParameters::defaults(Readout::kPoolPointer);
  for (const int acquisitions : {1, 2, 3, 4, 5, 8, 9}) {
    std::vector<ColumnStream> array(5);
    for (ColumnStream& column : array) {
      for (int row = 0; row < 10; ++row) {
        column.append_row(
            make_stream(StreamKind::kUniform, shape, static_cast<std::uint32_t>(acquisitions), draw));
      }
    }
    expect_as_reference(array, 10, acquisitions);
  }
}

TEST_F(PoolPointer, NothingDetected) {
  std::vector<ColumnStream> array(3);
  for (ColumnStream& column : array) {
    for (int row = 0; row < 20; ++row) {
      column.finish_row();
    }
  }
  // Every candidate is as good, and the lowest is the border of the first two coarse bins. The first column
  // is sure of nothing; those after it follow its choice.
  for (const std::uint32_t acquisitions : {0U, 1U, 3333U}) {
    const auto results = read_array(array, 10, acquisitions, {});
    EXPECT_THAT(results[0], testing::Each(PixelResult{31, 32, 0}));
    for (const PixelResult& result : results[2]) {
      EXPECT_EQ(result.code, 31);
      EXPECT_EQ(result.fraction, 32);
    }
  }
  EXPECT_TRUE(read_array({}, 10, 100, {}).empty());
}

// A column's results depend on its engine's columns only.
TEST_F(PoolPointer, EnginesAreIndependent) {
  CounterRandom draw = random(5);
  const auto array = surfaces(10, 2, 8, 16, 0.2, 900, draw);
  PoolNumbers parameters;
  parameters.engine_columns = 4;
  const auto together = read_array(array, 10, 900, parameters);
  for (const std::size_t begin : {0U, 4U}) {
    const auto alone = read_array(std::span(array).subspan(begin, 4), 10, 900, parameters);
    for (std::size_t column = 0; column < 4; ++column) {
      EXPECT_EQ(alone[column], together[begin + column]);
    }
  }
  parameters.engine_columns = 8;
  EXPECT_NE(read_array(array, 10, 900, parameters), together) << "the border made no difference";
}

TEST_F(PoolPointer, RefusesMalformedStreamsAndParameters) {
  std::vector<ColumnStream> array(2);
  array[0].append_row(std::vector<Detection>{{5, 3}});
  array[1].finish_row();
  EXPECT_THAT([&] { (void)read_array(array, 10, 5, {}); },
              ThrowsMessage<InputError>(HasSubstr("row 0: acquisition 5 is outside")));
  EXPECT_THAT([&] { (void)read_array(array, 7, 6, {}); },
              ThrowsMessage<InputError>(HasSubstr("NP must be 8 to 16, not 7")));
  array[1].finish_row();
  EXPECT_THAT([&] { (void)read_array(array, 10, 6, {}); },
              ThrowsMessage<InputError>(HasSubstr("column 1 has 2 rows, column 0 has 1")));
  std::vector<PoolPrior> priors(2);
  const auto read_video = [&] {
    (void)run_pool_pointer(1, reader_of(std::span(array).first(1)), 10, 6, {}, &priors);
  };
  EXPECT_THAT(read_video, ThrowsMessage<InputError>(HasSubstr("priors of 2 engines for an array of 1")));
  priors = {PoolPrior(3)};
  EXPECT_THAT(read_video, ThrowsMessage<InputError>(HasSubstr("a prior of 3 groups for an engine of 1")));
  const auto refused = [&](auto spoil, const char* message) {
    PoolNumbers parameters;
    spoil(parameters);
    EXPECT_THAT([&] { parameters.validate(); }, ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refused([](PoolNumbers& p) { p.engine_columns = 3; },
          "ENGINE_COLUMNS must be even and at least 2, for two columns share an SRAM, not 3");
  refused([](PoolNumbers& p) { p.group_rows = 3; }, "GROUP_SIZE must be a power of two from 4 to 32, not 3");
  refused([](PoolNumbers& p) { p.count_width = 8; },
          "32 bins of COUNT_WIDTH and a bit more must fit the words of GROUP_SIZE rows, not 8");
  refused([](PoolNumbers& p) { p.rival_moves = 0; }, "OFFSET_BITS must be 0 if RIVAL_MOVES is 0, not 6");
  refused([](PoolNumbers& p) { p.cell_shift = 7; }, "CELL_SHIFT must be 8 to 10, not 7");
  refused([](PoolNumbers& p) { p.labels = 9; }, "LABELS must be 2 to 8, not 9");
  refused([](PoolNumbers& p) { p.track_share = 60; }, "TRACK_SHARE must be 1 to 49, not 60");
}

}  // namespace
}  // namespace dtof
