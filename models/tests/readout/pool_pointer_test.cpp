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
#include <span>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/pool_reference.hpp"
#include "tests/readout/surface_streams.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

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
                         int engine_columns = 34, PoolReference::Open open = {}) {
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
    parameters.amplitude = open.amplitude;
    std::ranges::transform(open.taken, parameters.coarse_template.begin(),
                           [](int entry) { return static_cast<std::uint8_t>(entry); });
    const auto actual = read_array(array, np, static_cast<std::uint32_t>(acquisitions), parameters);
    std::vector<std::vector<PixelResult>> expected;
    for (std::size_t begin = 0; begin < array.size(); begin += static_cast<std::size_t>(engine_columns)) {
      const std::size_t end = std::min(array.size(), begin + static_cast<std::size_t>(engine_columns));
      const std::vector<ColumnStream> engine(array.begin() + static_cast<std::ptrdiff_t>(begin),
                                             array.begin() + static_cast<std::ptrdiff_t>(end));
      for (auto& column : PoolReference(engine, np, acquisitions, open).run()) {
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
    PoolReference::Open open{.coarse = 10, .track = 14, .lean = true, .second_target = trial % 2 == 0};
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
    PoolReference::Open open{
        .coarse = is_lean ? 10 : 14, .track = is_lean ? 14 : 20, .lean = is_lean, .second_target = true};
    const auto array = surfaces(10, 2, 1 + pick(draw, 7), 1 + pick(draw, 24), 0.1, 900, draw);
    const PoolNumbers usual = with_cells(is_lean ? Readout::kPoolPointerLean : Readout::kPoolPointer, 9);
    PoolNumbers compensated = usual;
    for (std::size_t i = 0; i < open.taken.size(); ++i) {
      const std::array<int, 4> kinds = {0, 255, pick(draw, 256), pick(draw, 16)};
      open.taken[i] = kinds[static_cast<std::size_t>(pick(draw, 4))];
      compensated.coarse_template[i] = static_cast<std::uint8_t>(open.taken[i]);
    }
    expect_as_reference(array, 10, 900, 4, open);
    changed += read_array(array, 10, 900, compensated) != read_array(array, 10, 900, usual) ? 1 : 0;
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
    const PoolReference::Open open{.coarse = 8 + pick(draw, 16),
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
  parameters.amplitude = true;
  std::size_t changed = 0;
  for (int video = 0; video < 6; ++video) {
    const int rows = 5 + pick(draw, 12);
    std::vector<PoolPrior> priors;
    std::array<PoolReference::Used, 2> used;
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
        PoolReference reference({array.begin() + static_cast<std::ptrdiff_t>(first),
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
  refused([](PoolNumbers& p) { p.track_share = 60; },
          "TRACK_SHARE must be at least 1, and at most 63 together with COARSE_SHARE, not 60");
}

}  // namespace
}  // namespace dtof
