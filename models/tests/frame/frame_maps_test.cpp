// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/frame_maps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace dtof {
namespace {

using testing::ElementsAre;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

TEST(FrameMaps, WithoutATableAreThoseOfTheEquation) {
  // 45 ns in 1024 codes, a pulse of 2 ns (Eq. 3.11): c/2 (45 ns / 1024 (code + 0.5) - 2 ns).
  const std::array<PixelResult, 3> results = {
      {{.code = 0, .confidence = 1}, {.code = 500, .confidence = 1}, {.code = 600, .confidence = 1}}};
  const std::array<float, 3> truth = {0.5F, 3.0F, kUnknown};
  const FrameMaps maps = frame_maps(results, ReadoutParameters::defaults(Readout::kSifh, 10), SensorModel(),
                                    std::nullopt, truth);
  EXPECT_EQ(maps.depth[0], 0.0F);  // before the pulse of a target at 0 m
  EXPECT_NEAR(maps.depth[1], 2.99712, 1e-5);
  EXPECT_NEAR(maps.error[0], -0.29650 - 0.5, 1e-5);
  EXPECT_NEAR(maps.error[1], -0.00288, 1e-5);
  EXPECT_TRUE(std::isnan(maps.error[2]));
  EXPECT_EQ(maps.figures.before.count(), 2U);
  EXPECT_NEAR(maps.mean_square, 0.5 * (0.79650 * 0.79650 + 0.00288 * 0.00288), 1e-5);
}

TEST(FrameMaps, AResultWithoutConfidenceHasNoDistance) {
  const std::array<PixelResult, 3> results = {
      {{.code = 500, .confidence = 0}, {.code = 500, .confidence = 1}, {.code = 500, .confidence = 0}}};
  const std::array<float, 3> truth = {3.0F, 3.0F, kUnknown};
  for (const Readout readout : kAllReadouts) {
    SCOPED_TRACE(readout_name(readout));
    ReadoutParameters parameters = ReadoutParameters::defaults(readout, 10);
    const FrameMaps maps = frame_maps(results, parameters, SensorModel(), std::nullopt, truth);
    for (const std::size_t unknown : {std::size_t{0}, std::size_t{2}}) {
      EXPECT_TRUE(std::isnan(maps.depth[unknown]));
      EXPECT_TRUE(std::isnan(maps.error[unknown]));
    }
    EXPECT_NEAR(maps.depth[1], 2.99712, 1e-5);
    // The pixel that is not judged does not count, the other one does, in either way.
    EXPECT_EQ(maps.figures.without_distance, 1U);
    EXPECT_EQ(maps.figures.errors.count(), 2U);
    if (is_pointer_readout(readout)) {
      parameters.confidence_width = 0;  // no result says that it has no distance
      const FrameMaps bare = frame_maps(results, parameters, SensorModel(), std::nullopt, truth);
      EXPECT_NEAR(bare.depth[0], 2.99712, 1e-5);
      EXPECT_EQ(bare.figures.without_distance, 0U);
    }
  }
}

TEST(FrameMaps, ResultsAtTheFirstReturnAreCounted) {
  FrameMaps maps;
  maps.depth = {1.02F, 1.05F, 3.0F, kUnknown, 1.0F};
  count_first_returns(std::vector<float>{1.0F, 1.0F, 1.0F, 1.0F, kUnknown}, maps);
  EXPECT_EQ(maps.figures.behind_another, 4U);
  EXPECT_EQ(maps.figures.at_first_return, 1U);
  FrameFigures both = maps.figures;
  both.merge(maps.figures);
  EXPECT_EQ(both.behind_another, 8U);
  EXPECT_EQ(both.at_first_return, 2U);
  FrameMaps without;
  count_first_returns({}, without);
  EXPECT_EQ(without.figures.behind_another, 0U);
}

TEST(Figures, AreOfTheJudgedPixelsOfAllFrames) {
  FrameFigures figures;
  figures.errors.add(1.0, 1.05);
  figures.before.add(0.1);
  FrameFigures other;
  other.errors.add(2.0, 1.95);
  other.before.add(0.1);
  other.without_distance = 1;
  figures.merge(other);
  EXPECT_THAT(figure_names(true), ElementsAre("rmse mm", "bias mm", "bias before table mm", "above 3 %",
                                              "above 10 %", "no distance"));
  EXPECT_THAT(figure_values(figures, true), ElementsAre("50", "0", "100", "50.00 %", "0.00 %", "50.00 %"));
  EXPECT_THAT(figure_values(figures, false), ElementsAre("50", "0", "50.00 %", "0.00 %", "50.00 %"));
  EXPECT_THAT(figure_values(FrameFigures(), false), ElementsAre("-", "-", "-", "-", "-"));
}

}  // namespace
}  // namespace dtof
