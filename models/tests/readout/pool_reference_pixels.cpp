// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "tests/readout/pool_reference.hpp"

namespace dtof {
namespace {

int floor_divide(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

int PoolReference::cells(int x, int from) { return floor_divide(x - from, 512); }

bool PoolReference::thinned(int a, int x) {
  constexpr std::array<int, 8> kLate = {0, 4, 2, 6, 1, 5, 3, 7};
  const int sixteens = a / 16;
  return sixteens % 4 == 0 && kLate[static_cast<std::size_t>(sixteens / 4 % 8)] + x / 8192 < 7;
}

template <typename Test>
int PoolReference::take(int a, const std::vector<int>& times, Test inside) {
  const int first_choice = preferred(a, times);
  for (const int x : times) {
    if (!inside(first_choice) && inside(x)) {
      return x;
    }
  }
  return first_choice;
}

int PoolReference::label_of(const Group& g, int x) {
  for (std::size_t k = 0; k < g.cell.size(); ++k) {
    if (near_candidate(g, static_cast<int>(k), x)) {
      return static_cast<int>(k);
    }
  }
  return -1;
}

bool PoolReference::near_candidate(const Group& g, int k, int x) {
  const int d = cells(x, 512 * g.cell[static_cast<std::size_t>(k)]);
  return d >= -4 && d <= 3;
}

void PoolReference::track(Pixel& pixel, const Group& g, int a, const std::vector<int>& times) const {
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

std::vector<int> PoolReference::own_evidence(Place place) {
  std::vector<int> e = pixels_.at(place).score;
  for (std::size_t k = 2; k < e.size(); ++k) {
    e[k] -= group(place).b / 8;
  }
  return e;
}

std::pair<std::size_t, std::size_t> PoolReference::best_two(const std::vector<int>& values) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < values.size(); ++k) {
    order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return values[i] > values[j]; });
  return {order[0], order[1]};
}

std::vector<std::vector<int>> PoolReference::beliefs(const std::vector<std::vector<int>>& evidence,
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

int PoolReference::beyond(const std::vector<std::vector<int>>& evidence,
                          const std::vector<std::vector<int>>& position, const std::vector<int>& lambda,
                          int pixel, std::size_t label, int direction) {
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

int PoolReference::best_step(const std::vector<int>& value, const std::vector<int>& from, int to,
                             int lambda) {
  int best = -1000000;
  for (std::size_t k = 0; k < value.size(); ++k) {
    best = std::max(best, value[k] - (std::abs(from[k] - to) > 2048 ? lambda : 0));
  }
  return best;
}

void PoolReference::choose(int c) {
  std::vector<std::vector<int>> evidence;
  std::vector<std::vector<int>> position;
  std::vector<int> lambda;
  for (int r = 0; r < rows_; ++r) {
    const Group& g = group({c, r});
    std::vector<int> e = own_evidence({c, r});
    for (std::size_t k = 0; k < e.size(); ++k) {
      const bool uses_left = c > 0 && (pixels_.at({c - 1, r}).sure || !open_.left_needs_margin);
      if (uses_left && std::abs(g.cell[k] - pixels_.at({c - 1, r}).chosen) > 4) {
        e[k] -= 2 + 3 * g.b / 16;
      }
      if (c + 1 < columns_) {
        const std::vector<int> of_neighbour = own_evidence({c + 1, r});
        const auto [p, q] = best_two(of_neighbour);
        const std::vector<int>& cell = group({c + 1, r}).cell;
        const int most = 1 + 3 * g.b / 16;
        if (std::abs(cell[p] - g.cell[k]) > 4) {
          e[k] -=
              std::abs(cell[q] - g.cell[k]) > 4 ? most : std::min(of_neighbour[p] - of_neighbour[q], most);
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

template <typename Position>
std::vector<PoolReference::Place> PoolReference::near_places(Place place, Position position) {
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

template <typename Position>
int PoolReference::towards_neighbours(Place place, Position position) {
  int sum = 0;
  for (const Place at : near_places(place, position)) {
    sum += position(pixels_.at(at)) - position(pixels_.at(place));
  }
  return sum >= 0 ? sum / 4 : -(-sum / 4);
}

void PoolReference::point_lean(Pixel& pixel, const Group& g, int a, const std::vector<int>& times) const {
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

void PoolReference::point(Pixel& pixel, int a, const std::vector<int>& times) const {
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

void PoolReference::decide(int c) {
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

int PoolReference::confidence(Place place) {
  const Pixel& pixel = pixels_.at(place);
  const Group& g = group(place);
  const int own = std::abs(pixel.margin);
  if (open_.lean) {
    return own;
  }
  const std::vector<int> weights =
      open_.prior ? std::vector{0, 22, 32, 64} : std::vector{0, 13, 16, 20, 24, 29, 35, 64};
  const int weight = std::min(weights[static_cast<std::size_t>(pixel.significance)], 4 * own);
  const int alone = own < 12 ? 0 : 12;
  if (g.tilted) {
    return weight > alone ? weight : alone;
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
  const int evidence = weight + std::min(127, above / sky->parts[0] + above / sky->parts[1]);
  return evidence > alone ? evidence : alone;
}

int PoolReference::counts(int n) const {
  int sum = 0;
  for (int reached = 0; reached < n; ++reached) {
    const int eighths = 8 * reached / (open_.lean ? 16 : 128);
    sum += eighths < 4 ? 1 : eighths < 6 ? 4 : 16;
  }
  return sum;
}

PixelResult PoolReference::result(Place place) {
  const Pixel& pixel = pixels_.at(place);
  int position = pixel.winner;
  if (open_.smooth) {
    position += towards_neighbours(place, [](const Pixel& other) { return other.winner; });
  }
  const int scale = 1 << (16 - np_);
  const auto limited = [&](int x) { return std::clamp(x - scale / 2, 0, 65536 - scale - 1); };
  const int word = limited(position);
  return {static_cast<std::uint16_t>(word / scale),
          static_cast<std::uint16_t>(word % scale),
          static_cast<std::uint16_t>(confidence(place)),
          static_cast<std::uint16_t>(open_.second_target ? limited(pixel.loser) : 0),
          static_cast<std::uint16_t>(open_.amplitude && pixel.margin >= 0 ? counts(pixel.n) : 0),
          static_cast<std::uint16_t>(open_.amplitude ? group(place).b : 0)};
}

}  // namespace dtof
