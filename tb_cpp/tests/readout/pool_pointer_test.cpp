// SPDX-License-Identifier: Apache-2.0
#include "readout/pool_pointer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/parameters.hpp"
#include "core/random.hpp"
#include "readout/model.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

// ---- An independent reference, as slow and as close to docs/reference/poolpointer.md as possible ---------

struct Event {
  int acquisition;
  int x;  // units: 65536 is the range
};

struct Pixel {
  std::vector<Event> events;
  std::array<int, 8> score{};
  int lead = 0;
  int offset = 0;
  int a = 0, b = 0, count = 0;  // labels only matter where the rival does not move
  int pa = 0, pb = 0;           // positions, the rival's in units of 512
};

struct Group {
  std::vector<int> h = std::vector<int>(32, 0);
  std::vector<int> cell;
  int background = 0;
  int score_max = 0;
};

class Reference {
 public:
  Reference(const ReadoutParameters& parameters, const ColumnStream& column, int acquisitions)
      : p_(parameters.pool), np_(parameters.np), acquisitions_(acquisitions) {
    const int scale = 1 << (16 - np_);
    for (int row = 0; row < column.rows(); ++row) {
      Pixel pixel;
      std::map<int, std::vector<int>> seen;  // by acquisition
      for (const Detection& d : column.row(row)) {
        if (d.timestamp != parameters.no_detection()) {
          seen[static_cast<int>(d.acquisition)].push_back(d.timestamp * scale + scale / 2);
        }
      }
      for (const auto& [acquisition, times] : seen) {
        const bool second = acquisition % 2 == 1 && times.size() > 1;
        pixel.events.push_back({acquisition, times[second ? 1 : 0]});
      }
      pixels_.push_back(pixel);
    }
    groups_.resize((pixels_.size() + static_cast<std::size_t>(p_.group_size) - 1) /
                   static_cast<std::size_t>(p_.group_size));
    bin_max_ = (1 << parameters.count_width) - 1;
    background_divisor_ = 1 << parameters.count_width;
  }

  std::vector<PixelResult> run() {
    const int coarse_end = acquisitions_ * p_.coarse_share / 64;
    const int track_end = acquisitions_ * (p_.coarse_share + p_.track_share) / 64;
    const int late = track_end + (acquisitions_ - track_end) * 5 / 8;
    for (std::size_t r = 0; r < pixels_.size(); r += 2) {
      std::map<int, int> even = times(r);
      std::map<int, int> odd = r + 1 < pixels_.size() ? times(r + 1) : std::map<int, int>();
      for (int a = 0; a < coarse_end; ++a) {
        const auto& wanted = a % 2 == 0 ? even : odd;
        const auto& other = a % 2 == 0 ? odd : even;
        const auto& from = wanted.contains(a) ? wanted : other;
        if (from.contains(a)) {
          int& bin = group(r).h[static_cast<std::size_t>(from.at(a) / 2048)];
          bin = std::min(bin + 1, bin_max_);
        }
      }
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      decode(g);
    }
    for (std::size_t r = 0; r < pixels_.size(); ++r) {
      for (const Event& e : pixels_[r].events) {
        if (e.acquisition >= coarse_end && e.acquisition < track_end) {
          track(pixels_[r], group(r), e.x);
        }
      }
    }
    choose();
    for (std::size_t r = 0; r < pixels_.size(); ++r) {
      for (const Event& e : pixels_[r].events) {
        if (e.acquisition >= track_end) {
          point(pixels_[r], group(r), e, e.acquisition >= late);
        }
      }
    }
    return decide();
  }

 private:
  std::map<int, int> times(std::size_t row) const {
    std::map<int, int> found;
    for (const Event& e : pixels_[row].events) {
      found[e.acquisition] = e.x;
    }
    return found;
  }

  Group& group(std::size_t row) { return groups_[row / static_cast<std::size_t>(p_.group_size)]; }

  void decode(std::size_t g) {
    Group& own = groups_[g];
    const Group& up = groups_[g == 0 ? 0 : g - 1];
    const Group& down = groups_[std::min(g + 1, groups_.size() - 1)];
    std::vector<int> quarters;
    for (std::size_t q = 0; q < 4; ++q) {
      quarters.push_back(0);
      for (std::size_t i = 0; i < 8; ++i) {
        quarters.back() += own.h[8 * q + i];
      }
    }
    own.background = 5 * *std::min_element(quarters.begin(), quarters.end()) / background_divisor_;
    const bool bright = own.background >= p_.bright_from;
    own.score_max = (1 << (bright ? p_.bright_score_bits : p_.dark_score_bits)) - 1;
    std::vector<int> w;
    std::vector<int> o;
    for (std::size_t i = 0; i + 1 < 32; ++i) {
      o.push_back(own.h[i] + own.h[i + 1]);
      w.push_back(3 * own.h[i] + up.h[i] + down.h[i] + 3 * own.h[i + 1] + up.h[i + 1] + down.h[i + 1]);
    }
    const int floor = *std::min_element(o.begin(), o.end());
    std::vector<bool> used(31, false);
    for (int k = 0; k < (bright ? p_.bright_labels : p_.dark_labels); ++k) {
      const std::vector<int>& s = k < 3 ? w : o;
      int peak = -1;
      for (int i = 30; i >= 0; --i) {
        if (!used[static_cast<std::size_t>(i)] &&
            (peak < 0 || s[static_cast<std::size_t>(i)] >= s[static_cast<std::size_t>(peak)])) {
          peak = i;
        }
      }
      const auto at = [&](int i) { return i < 0 || i > 30 ? 0 : s[static_cast<std::size_t>(i)]; };
      const int d = at(peak + 1) - at(peak - 1);
      const int height = at(peak) - std::min(at(peak + 1), at(peak - 1));
      int shift = 0;
      if (height > 0 && 2 * std::abs(d) > height) {
        shift = d > 0 ? 1 : -1;
      }
      own.cell.push_back(4 * (peak + 1) + shift);
      const int own_part = std::max(0, o[static_cast<std::size_t>(peak)] - floor) / 4;
      const int pooled_part = std::max(0, w[static_cast<std::size_t>(peak)] - 5 * floor) / 4;
      for (const int i : {peak - 2, peak + 2}) {
        if (i >= 0 && i < 31) {
          const auto j = static_cast<std::size_t>(i);
          o[j] = std::max(0, o[j] - own_part);
          w[j] = std::max(0, w[j] - pooled_part);
        }
      }
      for (const int i : {peak - 1, peak, peak + 1}) {
        if (i >= 0 && i < 31) {
          used[static_cast<std::size_t>(i)] = true;
        }
      }
    }
  }

  void track(Pixel& pixel, const Group& g, int x) const {
    if (p_.offset_bits > 0) {
      const int half = 1 << (p_.offset_bits - 1);
      const int d = x - 512 * g.cell[static_cast<std::size_t>(pixel.lead)] - 64 * pixel.offset;
      if (d >= 512 && d < 4096 && pixel.offset < half - 1) {
        ++pixel.offset;
      } else if (d < -512 && d >= -4096 && pixel.offset > -half) {
        --pixel.offset;
      }
    }
    for (std::size_t k = 0; k < g.cell.size(); ++k) {
      const int d = x / 512 - g.cell[k];
      if (d < -5 || d > 4) {
        continue;
      }
      if (pixel.score[k] == g.score_max) {
        for (std::size_t j = 0; j < g.cell.size(); ++j) {
          if (j != k && pixel.score[j] > 0) {
            --pixel.score[j];
          }
        }
      } else {
        ++pixel.score[k];
      }
      if (p_.offset_bits > 0 && pixel.score[k] > pixel.score[static_cast<std::size_t>(pixel.lead)]) {
        pixel.lead = static_cast<int>(k);
        pixel.offset = 0;
      }
      return;
    }
  }

  /// Best total over all paths through each label, by dynamic programming per fixed label.
  static std::vector<std::vector<int>> max_marginals(const std::vector<std::vector<int>>& evidence,
                                                     const std::vector<std::vector<int>>& position,
                                                     const std::vector<int>& lambda) {
    const std::size_t n = evidence.size();
    std::vector<std::vector<int>> best(n);
    for (std::size_t fixed = 0; fixed < n; ++fixed) {
      for (std::size_t label = 0; label < evidence[fixed].size(); ++label) {
        // Walk away from the fixed pixel: the pixel that sends towards it pays its own penalty.
        int total = evidence[fixed][label];
        for (const int direction : {-1, 1}) {
          std::vector<std::size_t> side;
          for (int i = static_cast<int>(fixed) + direction; i >= 0 && i < static_cast<int>(n);
               i += direction) {
            side.push_back(static_cast<std::size_t>(i));
          }
          std::vector<int> value;  // of the sub-chain beyond, for each label of side[i]
          for (std::size_t s = side.size(); s-- > 0;) {
            const std::size_t at = side[s];
            std::vector<int> here = evidence[at];
            if (s + 1 < side.size()) {
              add_best(here, position[at], value, position[side[s + 1]], lambda[side[s + 1]]);
            }
            value = here;
          }
          if (!side.empty()) {
            std::vector<int> own = {0};
            add_best(own, {position[fixed][label]}, value, position[side[0]], lambda[side[0]]);
            total += own[0];
          }
        }
        best[fixed].push_back(total);
      }
    }
    return best;
  }
  static void add_best(std::vector<int>& here, const std::vector<int>& position,
                       const std::vector<int>& beyond, const std::vector<int>& beyond_position, int lambda) {
    for (std::size_t l = 0; l < here.size(); ++l) {
      int best = -1000000;
      for (std::size_t k = 0; k < beyond.size(); ++k) {
        const bool far = std::abs(beyond_position[k] - position[l]) > 2048;
        best = std::max(best, beyond[k] - (far ? lambda : 0));
      }
      here[l] += best;
    }
  }

  void choose() {
    std::vector<std::vector<int>> evidence;
    std::vector<std::vector<int>> position;
    std::vector<int> lambda;
    for (std::size_t r = 0; r < pixels_.size(); ++r) {
      const Group& g = group(r);
      evidence.emplace_back();
      position.emplace_back();
      for (std::size_t k = 0; k < g.cell.size(); ++k) {
        evidence.back().push_back(pixels_[r].score[k] - (k < 2 ? 0 : g.background / 4));
        position.back().push_back(512 * g.cell[k]);
      }
      lambda.push_back(2 + g.background / 4);
    }
    const auto belief = max_marginals(evidence, position, lambda);
    for (std::size_t r = 0; r < pixels_.size(); ++r) {
      Pixel& pixel = pixels_[r];
      const auto winner = std::max_element(belief[r].begin(), belief[r].end());
      pixel.a = static_cast<int>(winner - belief[r].begin());
      auto others = belief[r];
      others[static_cast<std::size_t>(pixel.a)] = -1000000;
      const auto second = std::max_element(others.begin(), others.end());
      pixel.b = static_cast<int>(second - others.begin());
      pixel.count = std::min(*winner - *second, (1 << p_.count_bits) / 2 - 1);
      const auto start = [&](int label) {
        return 512 * group(r).cell[static_cast<std::size_t>(label)] +
               (label == pixel.lead ? 64 * pixel.offset : 0);
      };
      pixel.pa = start(pixel.a);
      pixel.pb = start(pixel.b) / 512;
    }
  }

  /// Where the rival is: the middle of its unit, or its candidate.
  [[nodiscard]] int rival_position(const Pixel& pixel, const Group& g) const {
    return p_.rival_moves ? 512 * pixel.pb + 256 : 512 * g.cell[static_cast<std::size_t>(pixel.b)];
  }

  void point(Pixel& pixel, const Group& g, const Event& event, bool late) const {
    static const std::vector<int> weights = {1, 2, 3, 4, 4, 3, 2, 1};
    const int da = event.x - pixel.pa;
    const int db = event.x / 512 - pixel.pb;
    const bool a_hit = da >= -2560 && da < 2560;
    bool b_hit = db >= -5 && db <= 4;
    if (!p_.rival_moves) {
      const int d = event.x - rival_position(pixel, g);
      b_hit = d >= -2560 && d < 2560;
    }
    b_hit = b_hit && !a_hit;
    const int c = pixel.count;
    int step = 0;
    if (p_.count_bits <= 4) {
      step = c < 4 ? 512 : c < 8 ? 256 : c < 12 ? 128 : c < 14 ? 64 : c < 15 ? 32 : 16;
    } else {
      step = c < 8     ? 256
             : c < 16  ? 128
             : c < 32  ? 64
             : c < 64  ? 32
             : c < 80  ? 16
             : c < 100 ? 8
             : c < 116 ? 4
             : c < 124 ? 2
                       : 1;
    }
    if (late) {
      step = std::min(step, 64);
    }
    const int unit = 1 << p_.pointer_shift;
    int moved = pixel.pa;
    if (da >= -4096 && da < 4096) {
      const int weight = weights[static_cast<std::size_t>(da >= 0 ? da / 512 : (-da - 1) / 512)];
      const int a = event.acquisition;
      int move = (step * weight + a % 4 * unit + a / 4 % unit) / 4;
      move -= move % unit;
      moved += da < 0 ? -move : move;
      const int home = 512 * g.cell[static_cast<std::size_t>(pixel.a)];
      const int low = p_.rival_moves ? 0 : home - 2048;
      const int high = (p_.rival_moves ? 65536 : home + 2048) - unit;
      moved = std::min(std::max(moved, low), high);
    }
    const int all = 1 << p_.count_bits;
    const int every = c < all / 2 ? 1 : c < all / 4 * 3 ? 4 : 16;
    const bool counted = event.acquisition % every == 0;
    if (b_hit && c == 0) {
      const int old = pixel.pa;
      pixel.pa = rival_position(pixel, g);
      pixel.pb = old / 512;
      std::swap(pixel.a, pixel.b);
      pixel.count = 1;
      return;
    }
    pixel.pa = moved;
    if (b_hit && db != 0) {
      pixel.pb += db > 0 ? 1 : -1;
    }
    if (counted && a_hit) {
      pixel.count = std::min(c + 1, all - 1);
    } else if (counted && b_hit) {
      pixel.count = c - 1;
    }
  }

  std::vector<PixelResult> decide() {
    std::vector<std::vector<int>> evidence;
    std::vector<std::vector<int>> position;
    std::vector<int> lambda;
    for (std::size_t r = 0; r < pixels_.size(); ++r) {
      const Pixel& pixel = pixels_[r];
      const Group& g = group(r);
      evidence.push_back({pixel.count, 0});
      position.push_back({pixel.pa, rival_position(pixel, g)});
      lambda.push_back(4 + g.background / 8);
    }
    const auto belief = max_marginals(evidence, position, lambda);
    const int scale = 1 << (16 - np_);
    std::vector<PixelResult> results;
    for (std::size_t r = 0; r < pixels_.size(); ++r) {
      const int margin = belief[r][0] - belief[r][1];
      const auto limited = [&](int label) {
        const int x = position[r][static_cast<std::size_t>(label)] - scale / 2;
        return std::min(std::max(x, 0), 65536 - scale - 1);
      };
      const int winner = margin < 0 ? 1 : 0;
      const int word = limited(winner);
      results.push_back({static_cast<std::uint16_t>(word / scale), static_cast<std::uint16_t>(word % scale),
                         static_cast<std::uint16_t>(std::abs(margin)),
                         static_cast<std::uint16_t>(p_.second_target ? limited(1 - winner) : 0)});
    }
    return results;
  }

  PoolPointerParameters p_;
  int np_;
  int acquisitions_;
  int bin_max_ = 0;
  int background_divisor_ = 1;
  std::vector<Pixel> pixels_;
  std::vector<Group> groups_;
};

void expect_as_reference(const ReadoutParameters& parameters, const ColumnStream& column,
                         std::uint32_t acquisitions) {
  const std::vector<PixelResult> expected =
      Reference(parameters, column, static_cast<int>(acquisitions)).run();
  const std::vector<PixelResult> actual = make_readout_model(parameters)->run_column(column, acquisitions);
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t row = 0; row < expected.size(); ++row) {
    ASSERT_EQ(actual[row], expected[row])
        << parameters.to_string() << ", " << acquisitions << " acquisitions, row " << row << ": expected "
        << expected[row].code << '+' << expected[row].fraction << " (" << expected[row].confidence
        << "), got " << actual[row].code << '+' << actual[row].fraction << " (" << actual[row].confidence
        << ')';
  }
}

/// Pixels with a pulse at `codes[row]` (none: -1) over background.
ColumnStream pulses(const ReadoutParameters& parameters, const std::vector<int>& codes, double signal,
                    double background, std::uint32_t acquisitions, CounterRandom& random) {
  ColumnStream column;
  const double sigma = 0.019 * parameters.code_count();
  for (const int code : codes) {
    for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
      std::vector<int> events;
      for (int slot = 0; slot < parameters.slots; ++slot) {
        if (random.uniform() < background) {
          events.push_back(pick(random, parameters.code_count()));
        } else if (code >= 0 && random.uniform() < signal) {
          double gauss = -6.0;
          for (int i = 0; i < 12; ++i) {
            gauss += random.uniform();
          }
          events.push_back(std::clamp(static_cast<int>(std::lround(code + sigma * gauss)), 0,
                                      parameters.code_count() - 1));
        }
      }
      std::ranges::sort(events);
      for (const int event : events) {
        column.append({acquisition, static_cast<Timestamp>(event)});
      }
    }
    column.finish_row();
  }
  return column;
}

CounterRandom test_random(std::uint32_t test, Readout readout) {
  return {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0x1000U + test,
          static_cast<std::uint32_t>(readout)};
}

double position(const ReadoutParameters& parameters, const PixelResult& result) {
  return result.code + std::ldexp(result.fraction, -parameters.fraction_bits);
}

class PoolPointer : public testing::TestWithParam<Readout> {
 protected:
  PoolPointer() : trace_(__FILE__, __LINE__, test_seed_message()) {}
  ReadoutParameters parameters_ = ReadoutParameters::defaults(GetParam());

 private:
  testing::ScopedTrace trace_;
};

TEST_P(PoolPointer, MemoryIsWithinTheBudget) {
  const bool lean = GetParam() == Readout::kPoolPointerLean;
  const PoolPointerParameters& pool = parameters_.pool;
  EXPECT_EQ(pool.word_bits(), lean ? 16 : 29);
  // The coarse histogram uses the pixels' words.
  EXPECT_LE(static_cast<int>(kCoarseBins) * parameters_.count_width, pool.group_size * pool.word_bits());
  // Two pixels a memory word, 7 bits a centre and 6 bits background a group word, for 160 pixels.
  const int group_word_bits = 7 * std::max(pool.dark_labels, pool.bright_labels) + 6;
  const int width = std::max(2 * pool.word_bits(), group_word_bits);
  EXPECT_EQ(width, lean ? 34 : 58);
  const int words = 160 / 2 + 160 / pool.group_size;
  EXPECT_EQ(words, lean ? 90 : 100);
  EXPECT_LE(width * words, 160 * (lean ? 20 : 37));
}

TEST_P(PoolPointer, EveryKindOfStreamAsReference) {
  CounterRandom random = test_random(1, GetParam());
  for (const StreamKind kind : kStreamKinds) {
    SCOPED_TRACE(std::string(stream_name(kind)));
    for (const int rows : {1, 7, 19, 32}) {
      const auto acquisitions = static_cast<std::uint32_t>(1 + pick(random, 500));
      ColumnStream column;
      for (int row = 0; row < rows; ++row) {
        column.append_row(make_stream(kind, parameters_, acquisitions, random));
      }
      expect_as_reference(parameters_, column, acquisitions);
    }
  }
}

TEST_P(PoolPointer, ScenesAsReference) {
  CounterRandom random = test_random(2, GetParam());
  constexpr std::array<double, 4> kBackgrounds = {0.01, 0.07, 0.3, 0.6};
  for (int trial = 0; trial < 24; ++trial) {
    ReadoutParameters parameters = parameters_;
    parameters.slots = 2 + pick(random, 3);
    std::vector<int> codes(static_cast<std::size_t>(1 + pick(random, 40)));
    int surface = pick(random, 1024);
    for (int& code : codes) {
      if (pick(random, 3) == 0) {
        surface = pick(random, 1024);
      }
      surface = std::clamp(surface + pick(random, 41) - 20, 0, 1023);
      code = pick(random, 10) == 0 ? -1 : surface;
    }
    const ColumnStream column = pulses(parameters, codes, 0.01 + 0.3 * random.uniform(),
                                       kBackgrounds[static_cast<std::size_t>(pick(random, 4))], 800, random);
    expect_as_reference(parameters, column, 800);
  }
}

TEST_P(PoolPointer, ParameterSweepAsReference) {
  CounterRandom random = test_random(3, GetParam());
  for (int trial = 0; trial < 60;) {
    const int np = 8 + pick(random, 5);
    ReadoutParameters parameters = ReadoutParameters::defaults(GetParam(), np);
    PoolPointerParameters& pool = parameters.pool;
    parameters.count_width = 4 + pick(random, 5);
    pool.group_size = 4 << pick(random, 4);
    pool.second_target = trial % 2 == 0;
    pool.dark_labels = 2 + pick(random, 7);
    pool.bright_labels = 2 + pick(random, 7);
    pool.dark_score_bits = 1 + pick(random, 4);
    pool.bright_score_bits = 1 + pick(random, 4);
    pool.bright_from = pick(random, 20);
    pool.offset_bits = pick(random, 2) == 1 ? 2 + pick(random, 4) : 0;
    pool.count_bits = pick(random, 2) == 1 ? 4 : 7;
    pool.pointer_shift = pick(random, pool.count_bits == 4 ? 5 : 3);
    pool.rival_moves = pick(random, 2) == 1;
    pool.coarse_share = 4 + pick(random, 24);
    pool.track_share = 4 + pick(random, 24);
    if (!pool.histogram_fits(parameters.count_width)) {
      continue;
    }
    ++trial;
    std::vector<int> codes;
    for (int row = 1 + pick(random, 30); row > 0; --row) {
      codes.push_back(pick(random, parameters.code_count()));
    }
    const ColumnStream column = pulses(parameters, codes, 0.2, 0.5 * random.uniform(), 300, random);
    expect_as_reference(parameters, column, 300);
  }
}

// Steps of a few units and less, whose parts below a unit are dithered by four bits of the acquisition.
TEST_P(PoolPointer, FineGearsAsReference) {
  CounterRandom random = test_random(5, GetParam());
  const std::vector<int> codes = {300, 301, 302, 309, 640, 640, 640, 640};
  for (const bool rival_moves : {false, true}) {
    for (int shift = 0; shift <= 2; ++shift) {
      ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
      parameters.pool.pointer_shift = shift;
      parameters.pool.rival_moves = rival_moves;
      const ColumnStream column = pulses(parameters, codes, 0.8, 0.1, 3333, random);
      expect_as_reference(parameters, column, 3333);
      for (const PixelResult& result : make_readout_model(parameters)->run_column(column, 3333)) {
        EXPECT_GE(result.confidence, 116) << "the finest gears were not reached";
      }
    }
  }
}

TEST_P(PoolPointer, ShortFrames) {
  CounterRandom random = test_random(4, GetParam());
  for (const std::uint32_t acquisitions : {1U, 2U, 3U, 4U, 5U, 8U, 9U}) {
    ColumnStream column;
    for (int row = 0; row < 20; ++row) {
      column.append_row(make_stream(StreamKind::kUniform, parameters_, acquisitions, random));
    }
    expect_as_reference(parameters_, column, acquisitions);
  }
  ColumnStream empty;
  for (int row = 0; row < 20; ++row) {
    empty.finish_row();
  }
  // Nothing detected: every candidate is as good, and the lowest is the border of the first two coarse bins.
  for (const std::uint32_t acquisitions : {0U, 1U, 3333U}) {
    EXPECT_THAT(make_readout_model(parameters_)->run_column(empty, acquisitions),
                Each(PixelResult{31, 32, 0}));
  }
  EXPECT_TRUE(make_readout_model(parameters_)->run_column(ColumnStream(), 100).empty());
}

TEST_P(PoolPointer, SaturatesAndClamps) {
  for (const int code : {0, 1, 500, 1021, 1022}) {
    ColumnStream column;
    for (int row = 0; row < 17; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < 3000; ++acquisition) {
        column.append({acquisition, static_cast<Timestamp>(code)});
        column.append({acquisition, static_cast<Timestamp>(code)});
      }
      column.finish_row();
    }
    expect_as_reference(parameters_, column, 3000);
    for (const PixelResult& result : make_readout_model(parameters_)->run_column(column, 3000)) {
      // Within the pointer's resolution and reach of the outermost candidates.
      EXPECT_NEAR(position(parameters_, result), code, 1.0);
    }
  }
}

TEST_P(PoolPointer, FindsOneSurfaceInStrongLight) {
  CounterRandom random = test_random(6, GetParam());
  const std::vector<int> codes(48, 640);
  const ColumnStream column = pulses(parameters_, codes, 0.03, 0.25, 3333, random);
  for (const PixelResult& result : make_readout_model(parameters_)->run_column(column, 3333)) {
    EXPECT_NEAR(position(parameters_, result), 640.0, 25.0);
  }
}

TEST_P(PoolPointer, OnePixelIsReadAlone) {
  CounterRandom random = test_random(7, GetParam());
  const ColumnStream alone = pulses(parameters_, {300}, 0.3, 0.05, 1000, random);
  const PixelResult result = make_readout_model(parameters_)->run_column(alone, 1000).front();
  EXPECT_NEAR(position(parameters_, result), 300.0, 10.0);
}

TEST_P(PoolPointer, IsDeterministicAndKeepsNoState) {
  CounterRandom random = test_random(8, GetParam());
  const ColumnStream first = pulses(parameters_, std::vector<int>(20, 200), 0.2, 0.2, 600, random);
  const ColumnStream second = pulses(parameters_, std::vector<int>(33, 700), 0.2, 0.2, 600, random);
  const auto model = make_readout_model(parameters_);
  const std::vector<PixelResult> before = model->run_column(first, 600);
  (void)model->run_column(second, 600);
  EXPECT_EQ(model->run_column(first, 600), before);
}

TEST_P(PoolPointer, RefusesMalformedStreamsAndParameters) {
  ColumnStream column;
  column.append_row(std::vector<Detection>{{5, 3}});
  EXPECT_THAT([&] { (void)make_readout_model(parameters_)->run_column(column, 5); },
              ThrowsMessage<InputError>(HasSubstr("row 0: acquisition 5 is outside")));
  ColumnStream high;
  high.append_row(std::vector<Detection>{{0, 1024}});
  EXPECT_THAT([&] { (void)make_readout_model(parameters_)->run_column(high, 5); },
              ThrowsMessage<InputError>(HasSubstr("row 0: a timestamp is above 1023")));
  const auto refused = [&](auto spoil, const char* message) {
    ReadoutParameters parameters = parameters_;
    spoil(parameters);
    EXPECT_THAT([&] { (void)make_readout_model(parameters); }, ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refused([](ReadoutParameters& p) { p.nb = 6; }, "NB must be 5, not 6");
  refused([](ReadoutParameters& p) { p.np = 7; }, "NP must be 8 to 16, not 7");
  refused([](ReadoutParameters& p) { p.fraction_bits = 4; }, "FRACTION_BITS must be 16 - NP, not 4");
  refused([](ReadoutParameters& p) { p.count_width = 9; }, "COUNT_WIDTH must be 4 to 8, not 9");
  refused([](ReadoutParameters& p) { p.pool.group_size = 0; },
          "GROUP_SIZE must be a power of two from 4 to 64, not 0");
  refused([](ReadoutParameters& p) { p.pool.group_size = 12; },
          "GROUP_SIZE must be a power of two from 4 to 64, not 12");
  refused([](ReadoutParameters& p) { p.pool.pointer_shift = 5; },
          "POINTER_SHIFT must be 0 to 2, or 0 to 4 if ADVANTAGE_WIDTH is 4, not 5");
  refused([](ReadoutParameters& p) { p.pool.dark_labels = 9; }, "DARK_LABELS must be 2 to 8, not 9");
  refused([](ReadoutParameters& p) { p.pool.dark_score_bits = 0; }, "DARK_SCORE_BITS must be 1 to 4, not 0");
  refused([](ReadoutParameters& p) { p.pool.bright_score_bits = 0; },
          "BRIGHT_SCORE_BITS must be 1 to 4, not 0");
  refused([](ReadoutParameters& p) { p.pool.count_bits = 2; }, "ADVANTAGE_WIDTH must be 4 or 7, not 2");
  refused([](ReadoutParameters& p) { p.pool.track_share = 60; }, "TRACK_SHARE must be 1 to");
}

INSTANTIATE_TEST_SUITE_P(Products, PoolPointer,
                         testing::Values(Readout::kPoolPointer, Readout::kPoolPointerLean),
                         [](const auto& suite) {
                           return suite.param == Readout::kPoolPointer ? "full" : "lean";
                         });

TEST(PoolPointerCandidates, FollowPulsesInTheGroup) {
  const PoolPointerParameters parameters = PoolPointerParameters::defaults(Readout::kPoolPointer);
  CoarseHistogram histogram{};
  histogram.fill(1);
  histogram[4] = 100;  // split evenly over 4 and 5
  histogram[5] = 100;
  histogram[20] = 60;  // nearly alone
  histogram[21] = 10;
  const PoolGroup group = decode_group(histogram, histogram, histogram, 7, parameters);
  EXPECT_EQ(group.labels, parameters.dark_labels);
  EXPECT_EQ(group.background, 0);
  EXPECT_EQ(group.centre_cell[0], 20);  // border of bins 4 and 5
  EXPECT_EQ(group.centre_cell[1], 83);  // pair (20, 21), pulled towards 20
}

TEST(PoolPointerChain, NeighboursCarryAWeakPixelAndAStrongOneStays) {
  const auto node = [](int near_evidence, int far_evidence) {
    return ChainNode{2, 4, {1000, 20000}, {near_evidence, far_evidence}};
  };
  const std::vector<ChainNode> weak = {node(9, 0), node(0, 5), node(9, 0)};
  EXPECT_GT(chain_beliefs(weak)[1][0], chain_beliefs(weak)[1][1]);
  const std::vector<ChainNode> strong = {node(9, 0), node(0, 9), node(9, 0)};
  EXPECT_LT(chain_beliefs(strong)[1][0], chain_beliefs(strong)[1][1]);
}

}  // namespace
}  // namespace dtof
