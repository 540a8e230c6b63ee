// SPDX-License-Identifier: Apache-2.0
// poolPointer with a prior: each frame begins with the candidates of the frame before.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/rtl/pool_surfaces.hpp"
#include "tests/rtl/pool_video.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

/// Surfaces of three columns and five rows, farther than the array in all directions.
class World {
 public:
  World(const RtlConfiguration& configuration, CounterRandom& random)
      : configuration_(configuration), random_(random) {
    for (double& depth : depths_) {
      depth = configuration.parameters.code_count() * random.uniform();
    }
  }

  /// From another place; in all clocks more background than signal, as where a prior helps.
  std::vector<ColumnStream> frame(int left, int top, std::uint32_t acquisitions) {
    std::vector<ColumnStream> columns(static_cast<std::size_t>(configuration_.sram_num));
    const int codes = configuration_.parameters.no_detection();
    for (std::size_t column = 0; column < columns.size(); ++column) {
      for (int row = 0; row < configuration_.pixels_per_sram; ++row) {
        const std::size_t tile =
            (static_cast<std::size_t>(left) + column) / 3 * 37 + static_cast<std::size_t>(top + row) / 5;
        const double depth = depths_[tile % depths_.size()];
        for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
          for (int photon = 0; photon < 2; ++photon) {
            const double place = random_.uniform() < 0.08 ? depth + codes * 0.02 * random_.uniform()
                                                          : codes * random_.uniform();
            if (random_.uniform() < 0.6) {
              columns[column].append(
                  {acquisition, static_cast<Timestamp>(std::min<int>(static_cast<int>(place), codes - 1))});
            }
          }
        }
        columns[column].finish_row();
      }
    }
    return columns;
  }

 private:
  const RtlConfiguration& configuration_;
  CounterRandom& random_;
  std::array<double, 101> depths_{};
};

class PoolPointerPrior : public testing::TestWithParam<RtlConfiguration> {};

INSTANTIATE_TEST_SUITE_P(Compiled, PoolPointerPrior,
                         testing::ValuesIn(configurations_with([](const RtlConfiguration& configuration) {
                           return configuration.parameters.pool.prior && configuration.pixels_per_sram <= 40;
                         })),
                         configuration_test_name);

TEST_P(PoolPointerPrior, VideosAgreeWithModel) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 45);
  PoolVideo video(GetParam());
  RtlRunOptions options = default_options(test_seed());
  options.prior = true;
  // Columns and rows from frame to frame: still, panned to either side, rolled, both.
  constexpr std::array<std::array<int, 2>, 5> kMoves = {{{0, 0}, {1, 0}, {-2, 0}, {0, 3}, {1, -1}}};
  for (const auto& [right, down] : kMoves) {
    World world(GetParam(), random);  // a cut
    const auto acquisitions = static_cast<std::uint32_t>(60 + pick(random, 200));
    for (int number = 0; number < 4; ++number) {
      SCOPED_TRACE(testing::Message() << "moved by " << right << ", " << down << ", frame " << number);
      ASSERT_TRUE(video.agrees(world.frame(20 + number * right, 20 + number * down, acquisitions),
                               acquisitions, options));
      options.reset_first = false;
    }
  }
  EXPECT_GT(video.changed(), 0) << "the prior changed nothing";
}

TEST_P(PoolPointerPrior, IsSwitchedFromFrameToFrame) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 46);
  PoolVideo video(GetParam());
  World world(GetParam(), random);
  RtlRunOptions options = default_options(test_seed());
  int number = 0;
  for (const bool prior : {true, true, false, true, true, false, false, true}) {
    options.prior = prior;
    // Frames without acquisitions use candidates, too, and leave them.
    const std::uint32_t acquisitions = number == 4 ? 0 : 60 + random() % 60;
    SCOPED_TRACE(testing::Message() << "frame " << number << ", prior " << prior);
    ASSERT_TRUE(video.agrees(world.frame(20, 20, acquisitions), acquisitions, options));
    options.reset_first = false;
    ++number;
  }
}

// Light in which short bins are full: the largest sums that a prior raises.
TEST_P(PoolPointerPrior, AgreesWithModelWhereBinsAreFull) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 49);
  PoolVideo video(GetParam());
  RtlRunOptions options = default_options(test_seed());
  options.prior = true;
  constexpr std::uint32_t kAcquisitions = 1500;
  for (int number = 0; number < 3; ++number) {
    SCOPED_TRACE(testing::Message() << "frame " << number);
    std::vector<ColumnStream> columns(static_cast<std::size_t>(GetParam().sram_num));
    for (ColumnStream& column : columns) {
      for (int row = 0; row < GetParam().pixels_per_sram; ++row) {
        for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
          column.append(
              {acquisition, static_cast<Timestamp>(pick(random, GetParam().parameters.no_detection()))});
        }
        column.finish_row();
      }
    }
    ASSERT_TRUE(video.agrees(columns, kAcquisitions, options));
    options.reset_first = false;
  }
}

// Frames cut off in any state leave nothing, whatever their words have in them.
TEST_P(PoolPointerPrior, IsForgottenAtReset) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 47);
  PoolVideo video(GetParam());
  World world(GetParam(), random);
  RtlRunOptions options = default_options(test_seed());
  options.prior = true;
  constexpr std::uint32_t kAcquisitions = 40;
  std::uint64_t length = 0;
  options.observer = [&](const RtlCycle& clock) { length = clock.cycle; };
  ASSERT_TRUE(video.agrees(world.frame(20, 20, kAcquisitions), kAcquisitions, options));
  options.observer = nullptr;
  options.reset_first = false;
  for (int number = 0; number < 12; ++number) {
    options.reset_at.reset();
    if (number % 2 == 0) {
      options.reset_at = random.bits64() % length;
    }
    SCOPED_TRACE(testing::Message() << "frame " << number);
    ASSERT_TRUE(video.agrees(world.frame(20, 20, kAcquisitions), kAcquisitions, options));
  }
}

TEST_P(PoolPointerPrior, AgreesWithModelWhateverSourceAndSinkDo) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 48);
  PoolVideo video(GetParam());
  RtlRunOptions options;
  for (int number = 0; number < 12; ++number) {
    options = default_options(random.bits64());
    options.pause_probability = random.uniform();
    options.empty_slot_probability = random.uniform();
    options.stall_probability = 0.9 * random.uniform();
    options.start_probability = random.uniform();
    options.reset_first = number == 0;
    options.prior = pick(random, 4) != 0;
    const std::uint32_t acquisitions = 1 + random() % 90;
    SCOPED_TRACE(testing::Message() << "frame " << number << ", prior " << options.prior);
    ASSERT_TRUE(
        video.agrees(adversarial_columns(GetParam(), acquisitions, random() % kStreamKinds.size(), random),
                     acquisitions, options));
  }
}

}  // namespace
}  // namespace dtof
