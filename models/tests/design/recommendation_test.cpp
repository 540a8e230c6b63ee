// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/recommendation.hpp"

#include <gmock/gmock.h>

#include <numeric>
#include <utility>
#include <vector>

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// An option of made-up worth: share of pixels off, area, frame's clocks.
DesignOption option(Readout readout, double share, double mm2, std::uint64_t clocks = 1'000'000) {
  DesignOption made;
  made.candidate.array.parameters = ReadoutParameters::defaults(readout);
  made.candidate.array.rows = 16;
  made.candidate.array.columns = 16;
  made.candidate.cost = {.mm2 = mm2, .fmax_mhz = 350.0, .bits_per_pixel = 1.0};
  made.candidate.clocks = clocks;
  LightScore light;
  light.klux = 50.0;
  light.above_3_percent = {share, {share - 0.005, share + 0.005}};
  made.screened.lights = {light};
  return made;
}

TEST(Recommendation, TheLimitOfAreaDecidesTheWinner) {
  const std::vector<DesignOption> options = {option(Readout::kPoolPointer, 0.01, 1.0),
                                             option(Readout::kEzPointer, 0.30, 0.5),
                                             option(Readout::kSifh, 0.20, 4.0)};
  DesignLimits limits;
  EXPECT_EQ(recommend(options, limits).chosen, 0U);
  EXPECT_EQ(recommend(options, limits).competitor, 2U);
  limits.most_mm2 = 0.9;
  EXPECT_EQ(recommend(options, limits).chosen, 1U);
  EXPECT_EQ(recommend(options, limits).competitor, std::nullopt);
  limits.most_mm2 = 0.4;
  EXPECT_EQ(recommend(options, limits).chosen, std::nullopt);
}

TEST(Recommendation, TheLimitsOfPowerFrameAndClockDecideToo) {
  std::vector<DesignOption> options = {option(Readout::kSifh, 0.01, 1.0, 12'000'000),
                                       option(Readout::kEzPointer, 0.30, 0.5)};
  options[1].candidate.array.pointer_ports = 1;  // needs less power
  DesignLimits limits;
  EXPECT_EQ(recommend(options, limits).chosen, 1U) << "27.5 frames/s are fewer than 30";
  limits.budget.frames_per_s = 27.0;
  EXPECT_EQ(recommend(options, limits).chosen, 0U);
  limits.most_mw = options[0].candidate.mw(limits.budget.clock_hz) * 0.99;
  EXPECT_EQ(recommend(options, limits).chosen, 1U);
  limits = {};
  limits.budget.clock_hz = 351e6;
  EXPECT_EQ(recommend(options, limits).chosen, std::nullopt);
}

TEST(Recommendation, OfReadoutsThatAreAsGoodTheSmallestIsTaken) {
  const std::vector<DesignOption> options = {option(Readout::kPoolPointer, 0.100, 1.0),
                                             option(Readout::kPoolPointerLean, 0.103, 0.7),
                                             option(Readout::kSifh, 0.110, 0.6)};
  const Recommendation found = recommend(options, {});
  EXPECT_EQ(found.chosen, 1U);
  EXPECT_EQ(found.competitor, 0U);
  EXPECT_THAT(found.within, ElementsAre(0, 1, 2));
}

/// The option with a score from frames of these shares.
DesignOption scored(Readout readout, double mm2, std::vector<double> frames) {
  DesignOption made =
      option(readout, std::reduce(frames.begin(), frames.end()) / static_cast<double>(frames.size()), mm2);
  made.screened.lights[0].above_3_of_frames = std::move(frames);
  made.score = made.screened;
  return made;
}

TEST(Recommendation, NoContestIfTheFramesSettleTheChoice) {
  // Equal noise in all: the residuals are the same in each frame but for 5 % of the noise.
  const DesignOption best = scored(Readout::kPoolPointer, 1.0, {0.09, 0.10, 0.11});
  EXPECT_THAT(contenders(std::vector{best}, {}), ElementsAre());
  EXPECT_THAT(contenders(std::vector{best, scored(Readout::kSifh, 0.5, {0.19, 0.20, 0.21})}, {}),
              ElementsAre());
  EXPECT_THAT(contenders(std::vector{best, scored(Readout::kSifh, 0.5, {0.091, 0.101, 0.111})}, {}),
              ElementsAre());
  EXPECT_THAT(contenders(std::vector{best, scored(Readout::kSifh, 2.0, {0.091, 0.101, 0.111})}, {}),
              ElementsAre());
}

TEST(Recommendation, ContendersAreThoseThatMoreFramesCouldChoose) {
  const std::vector<DesignOption> options = {
      scored(Readout::kPoolPointer, 1.0, {0.09, 0.10, 0.11}), scored(Readout::kSifh, 0.5, {0.11, 0.10, 0.11}),
      scored(Readout::kFifh, 2.0, {0.11, 0.10, 0.105}), scored(Readout::kEzPointer, 0.1, {0.29, 0.30, 0.31})};
  EXPECT_THAT(contenders(options, {}), UnorderedElementsAre(0, 1, 2))
      << "ezPointer's frames settle its place";
  EXPECT_THAT(contenders(std::vector{options[0], options[2]}, {}), UnorderedElementsAre(0, 1))
      << "the larger array could be the better one";
}

TEST(Recommendation, AShareOfOneFactorAboveTheLeastIsGoodEnough) {
  const DesignOption best = option(Readout::kPoolPointer, 0.1000, 1.0);
  EXPECT_EQ(recommend(std::vector{best, option(Readout::kSifh, 0.1049, 0.9)}, {}).chosen, 1U);
  EXPECT_EQ(recommend(std::vector{best, option(Readout::kSifh, 0.1051, 0.9)}, {}).chosen, 0U);
}

// A few pixels of a large array are no reason for an array of another size.
TEST(Recommendation, AThousandthOfThePixelsIsGoodEnough) {
  const DesignOption best = option(Readout::kCoarseHistogram, 0.0, 8.6);
  EXPECT_EQ(recommend(std::vector{best, option(Readout::kPoolPointer, 0.0009, 1.2)}, {}).chosen, 1U);
  EXPECT_EQ(recommend(std::vector{best, option(Readout::kPoolPointer, 0.0011, 1.2)}, {}).chosen, 0U);
  EXPECT_DOUBLE_EQ(good_share(0.0), 0.001);
  EXPECT_DOUBLE_EQ(good_share(0.02), 0.021);
  EXPECT_DOUBLE_EQ(good_share(0.1), 0.105);
}

TEST(Recommendation, FramesOfFewErrorsAreSettledByTheDifference) {
  const DesignOption large = scored(Readout::kCoarseHistogram, 8.6, {0.0, 0.0, 0.0, 0.0});
  EXPECT_THAT(
      contenders(std::vector{large, scored(Readout::kPoolPointer, 1.2, {0.0001, 0.0, 0.0002, 0.0})}, {}),
      IsEmpty());
  EXPECT_THAT(
      contenders(std::vector{large, scored(Readout::kPoolPointer, 1.2, {0.0002, 0.0, 0.0025, 0.001})}, {}),
      UnorderedElementsAre(0, 1));
}

TEST(Recommendation, FinalScoresDecideBetweenReadoutsAndScreenedOnesBetweenParameters) {
  std::vector<DesignOption> options = {option(Readout::kSifh, 0.20, 2.0), option(Readout::kSifh, 0.30, 1.0),
                                       option(Readout::kFifh, 0.25, 1.0)};
  EXPECT_THAT(finalists(options, {}), ElementsAre(0, 2));
  options[0].score = option(Readout::kSifh, 0.40, 2.0).screened;
  EXPECT_EQ(recommend(options, {}).chosen, 2U);
  EXPECT_THAT(finalists(options, {}), ElementsAre(0, 2));
}

// 0.2000 and 0.2040 are the same to one frame, whose interval is 0.01 wide. More frames tell.
TEST(Recommendation, BestAndSmallestParametersOfAReadoutGoToTheFinal) {
  std::vector<DesignOption> options = {option(Readout::kSifh, 0.2000, 2.0),
                                       option(Readout::kSifh, 0.2040, 1.0),
                                       option(Readout::kSifh, 0.2020, 1.5), option(Readout::kFifh, 0.4, 0.5)};
  EXPECT_THAT(finalists(options, {}), UnorderedElementsAre(0, 1, 3));
  EXPECT_EQ(recommend(options, {}).chosen, 1U) << "2 % more errors for half of the area";
  EXPECT_THAT(recommend(options, {}).within, ElementsAre(1, 3));
  options[0].score = option(Readout::kSifh, 0.1900, 2.0).screened;
  options[1].score = option(Readout::kSifh, 0.2040, 1.0).screened;
  EXPECT_EQ(recommend(options, {}).chosen, 0U);
  EXPECT_THAT(recommend(options, {}).within, ElementsAre(0, 3)) << "one set of parameters for each read-out";
  EXPECT_EQ(recommend(options, {}).competitor, 3U);
}

TEST(Recommendation, EachLimitChangesByTenPerCentToBothSides) {
  DesignLimits limits;
  EXPECT_EQ(limit_changes(limits).size(), 4U) << "frame rate and clock: there is always one";
  limits.most_mm2 = 2.0;
  const std::vector<LimitChange> changes = limit_changes(limits);
  ASSERT_EQ(changes.size(), 6U);
  EXPECT_EQ(changes[0].name, "area 10 % less");
  EXPECT_DOUBLE_EQ(changes[0].limits.most_mm2, 1.8);
  EXPECT_EQ(changes[1].name, "area 10 % more");
  EXPECT_DOUBLE_EQ(changes[1].limits.most_mm2, 2.2);
  EXPECT_DOUBLE_EQ(changes[1].limits.budget.clock_hz, limits.budget.clock_hz);
}

TEST(Recommendation, TenPerCentMoreAreaBringsAnotherWinner) {
  const std::vector<DesignOption> options = {option(Readout::kPoolPointer, 0.01, 1.05),
                                             option(Readout::kEzPointer, 0.30, 0.95)};
  DesignLimits limits;
  limits.most_mm2 = 1.0;
  EXPECT_EQ(recommend(options, limits).chosen, 1U);
  const std::vector<LimitChange> changes = limit_changes(limits);
  EXPECT_EQ(recommend(options, changes[0].limits).chosen, std::nullopt);
  EXPECT_EQ(recommend(options, changes[1].limits).chosen, 0U);
}

TEST(Recommendation, SaysWhichSingleLimitWouldDo) {
  const std::vector<DesignCandidate> candidates = {option(Readout::kPoolPointer, 0.01, 1.181).candidate,
                                                   option(Readout::kSifh, 0.01, 4.0).candidate};
  DesignLimits limits;
  limits.most_mm2 = 0.5;
  EXPECT_EQ(what_would_be_needed(candidates, limits),
            "no read-out keeps the limits; one of these would do: --max-mm2 1.19 (poolPointer)");
  limits.budget.frames_per_s = 1e6;
  EXPECT_THAT(what_would_be_needed(candidates, limits),
              HasSubstr("each alone would have to be at --max-mm2 1.19"));
  EXPECT_THAT(what_would_be_needed(candidates, limits), HasSubstr("--frame-rate 330 "));
}

}  // namespace
}  // namespace dtof
