// SPDX-License-Identifier: Apache-2.0
#include "frame/frame_maps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace dtof {
namespace {

using testing::ElementsAre;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

TEST(TrueDepth, IsThatOfTheRegionAndUnknownWithoutATarget) {
  TargetMap targets(3, 2);
  for (int column = 0; column < 3; ++column) {
    targets.at(column, 1) = {.depth_m = 1.0 + column, .reflectivity = 0.5};
  }
  const std::array<int, 2> columns = {0, 2};
  EXPECT_THAT(true_depth(targets, columns, {.first = 1, .count = 1}), ElementsAre(1.0F, 3.0F));
  EXPECT_THAT(true_depth(targets, columns, {.first = 0, .count = 1}),
              ElementsAre(testing::IsNan(), testing::IsNan()));
}

TEST(FrameMaps, WithoutATableAreThoseOfTheEquation) {
  // 45 ns in 1024 codes, a pulse of 2 ns (Eq. 3.11): c/2 (45 ns / 1024 (code + 0.5) - 2 ns).
  const std::array<PixelResult, 3> results = {{{.code = 0}, {.code = 500}, {.code = 600}}};
  const std::array<float, 3> truth = {0.5F, 3.0F, kUnknown};
  const FrameMaps maps = frame_maps(results, ReadoutParameters::defaults(Readout::kSifh, 10), SensorModel(),
                                    std::nullopt, truth);
  EXPECT_EQ(maps.depth[0], 0.0F);  // before the pulse of a target at 0 m
  EXPECT_NEAR(maps.depth[1], 2.99712, 1e-5);
  EXPECT_NEAR(maps.error[0], -0.29650 - 0.5, 1e-5);
  EXPECT_NEAR(maps.error[1], -0.00288, 1e-5);
  EXPECT_TRUE(std::isnan(maps.error[2]));
  EXPECT_EQ(maps.before.count(), 2U);
}

TEST(Figures, LeaveOutWhatIsUnknown) {
  const std::array<float, 3> truth = {1.0F, 2.0F, kUnknown};
  const std::array<float, 3> error = {0.05F, -0.05F, kUnknown};
  ErrorStatistics statistics;
  EXPECT_NEAR(add_errors(truth, error, statistics), 0.0025, 1e-8);
  RunningMoments before;
  before.add(0.1);
  EXPECT_THAT(figure_names(true),
              ElementsAre("rmse mm", "bias mm", "bias before table mm", "above 3 %", "above 10 %"));
  EXPECT_THAT(figure_values(statistics, before, true), ElementsAre("50", "0", "100", "50.00 %", "0.00 %"));
  EXPECT_THAT(figure_values(statistics, before, false), ElementsAre("50", "0", "50.00 %", "0.00 %"));
  EXPECT_THAT(figure_values(ErrorStatistics(), before, false), ElementsAre("-", "-", "-", "-"));
}

}  // namespace
}  // namespace dtof
