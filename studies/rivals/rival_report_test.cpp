// SPDX-License-Identifier: Apache-2.0
#include "rivals/rival_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <span>
#include <string>
#include <vector>

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using Kind = ComparedRow::Kind;

SceneScore score(std::uint64_t pixels, double above_3_percent, double above_10_percent = 0.0) {
  SceneScore score;
  score.all = {pixels, above_3_percent, above_10_percent, 0.0};
  return score;
}

/// Two scenes with depth and a flat; a read-out of 300 bits, a rival of 200, and a reference.
ComparedScores made_up(double readout, double rival) {
  ComparedScores scores({"room", "poles", "flat 3 m", "flat 4 m"}, {{"pointer", Kind::kReadout, 300.0},
                                                                    {"counter", Kind::kRival, 200.0},
                                                                    {"ideal", Kind::kReference, {}}});
  for (const double drift : {0.0, 0.01}) {
    for (std::size_t scene = 0; scene < 4; ++scene) {
      scores.add(scene, 0, score(1000, readout + drift));
      scores.add(scene, 1, score(1000, rival + drift, 0.01));
      scores.add(scene, 2, score(1000, 0.0));
    }
  }
  return scores;
}

TEST(ComparedScores, TheIntervalHoldsTheSeedsSpread) {
  const ComparedScores scores = made_up(0.30, 0.10);
  const ComparedFigure& figure = compared_figures()[0];
  EXPECT_THAT(scores.scenes_with_depth(), ElementsAre(0, 1));
  EXPECT_EQ(scores.pixels({0, 1}, figure), 4000U);
  const Estimate share = scores.estimate({0, 1}, 0, figure);
  EXPECT_NEAR(share.value, 0.305, 1e-12);
  // Two seeds 0.01 apart: Student's t with one degree of freedom, 12.7 standard errors of 0.005.
  EXPECT_NEAR(share.interval.high - share.value, 0.0635, 1e-3);
  EXPECT_EQ(scores.estimate({0}, 0, compared_figures().back()).value, 0.0) << "no single pixels";
}

TEST(ComparedScores, WeighsScenesByTheirPixels) {
  ComparedScores scores({"room", "poles"}, {{"pointer", Kind::kReadout, 300.0}});
  scores.add(0, 0, score(3000, 0.1));
  scores.add(1, 0, score(1000, 0.5));
  EXPECT_NEAR(scores.estimate({0, 1}, 0, compared_figures()[0]).value, 0.2, 1e-12);
}

TEST(ComparedScores, EachFigureIsOfItsOwnPixels) {
  ComparedScores scores({"room"}, {{"pointer", Kind::kReadout, 300.0}});
  SceneScore parts = score(1000, 0.01, 0.02);
  parts.edges = {100, 0.03, 0.04, 0.0};
  parts.rest = {900, 0.05, 0.06, 0.0};
  parts.dims = {200, 0.07, 0.08, 0.0};
  parts.singles = {50, 0.09, 0.10, 0.0};
  scores.add(0, 0, parts);
  std::vector<double> shares;
  for (const ComparedFigure& figure : compared_figures()) {
    shares.push_back(scores.estimate({0}, 0, figure).value);
  }
  EXPECT_THAT(shares, ElementsAre(0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.10));
}

TEST(RivalReport, AReferenceIsOnNoFrontEvenWithBits) {
  ComparedScores scores({"room"},
                        {{"pointer", Kind::kReadout, 300.0}, {"whole histogram", Kind::kReference, 200.0}});
  scores.add(0, 0, score(1000, 0.2));
  scores.add(0, 1, score(1000, 0.1));
  EXPECT_THAT(accuracy_front(scores, {0}, compared_figures()[0]), ElementsAre(0));
}

TEST(RivalReport, TheFrontIsOfReadoutsAndRivalsWithBits) {
  const ComparedFigure& figure = compared_figures()[0];
  EXPECT_THAT(accuracy_front(made_up(0.30, 0.10), {0, 1}, figure), ElementsAre(1));
  EXPECT_THAT(accuracy_front(made_up(0.05, 0.10), {0, 1}, figure), ElementsAre(1, 0));
  EXPECT_THAT(rivals_on_a_front({{14.0, made_up(0.05, 0.10)}, {50.0, made_up(0.30, 0.10)}}),
              ElementsAre("counter"));
  EXPECT_THAT(front_table(made_up(0.05, 0.10)).markdown(), HasSubstr("| read-out"));
}

TEST(RivalReport, SentencesFollowTheFigures) {
  const auto sentence = [](double readout, double rival) {
    const std::map<double, ComparedScores> lights = {{50.0, made_up(readout, rival)}};
    return comparison_sentence(lights, "counter", "pointer");
  };
  EXPECT_EQ(sentence(0.30, 0.10),
            "counter compared with pointer (200 and 300 bits a pixel), pixels with an error above 3 %: 50 "
            "klux 10.50 against 30.50 % (fewer).");
  EXPECT_THAT(sentence(0.10, 0.30), HasSubstr("(more)"));
  EXPECT_THAT(sentence(0.10, 0.11), HasSubstr("(no certain difference)"));
  // Half an interval is 0.0635: each share is outside the other's, but they overlap.
  EXPECT_THAT(sentence(0.30, 0.20), HasSubstr("(no certain difference)"));
  EXPECT_THAT(sentence(0.20, 0.30), HasSubstr("(no certain difference)"));
  EXPECT_EQ(comparison_sentence({{50.0, made_up(0.1, 0.1)}}, "counter", "none"), "");
}

TEST(RivalReport, AWallIsJudgedWithoutItsMediansBias) {
  WallCounts counts;
  // A constant bias of 1 m is taken away; the median is 3.0, and 3.1 and 3.4 are off by 3.3 % and 13 %.
  add_unbiased(counts, 3.0, std::vector<double>{4.0, 4.0, 4.0, 4.1, 4.4});
  EXPECT_EQ(counts.pixels, 5U);
  EXPECT_EQ(counts.above_3_percent, 2U);
  EXPECT_EQ(counts.above_10_percent, 1U);
  add_unbiased(counts, 3.0, std::vector<double>{1.0});
  EXPECT_EQ(counts.pixels, 6U);
  EXPECT_EQ(counts.above_3_percent, 2U);
}

TEST(RivalReport, ClaimsStandBesideWhatWasMeasured) {
  const std::vector<CheckedClaim> claims = {
      {"counter", {{10.0, 1.0}, {60.0, 1.0}}, {1000, 105, 10}, {1000, 105, 10}},
      {"adder", {{10.0, 1.0}, {10.0, 1.0}}, {1000, 95, 12}, {1000, 105, 10}}};
  const std::string table = claim_table(claims).csv();
  EXPECT_THAT(table, HasSubstr("counter,10 / 1,10.50 "));
  EXPECT_THAT(table, HasSubstr("yes / yes,60 / 1,"));
  EXPECT_THAT(table, HasSubstr("no / yes\nadder"));
  EXPECT_EQ(claim_sentence(claims), "7 of 8 shares agree; rivals with a share that does not agree: counter.");
  EXPECT_EQ(claim_sentence(std::span(claims).subspan(1)), "4 of 4 shares agree.");
}

TEST(RivalReport, TheFileHasEverySceneAndAllTogether) {
  const std::string csv = compared_csv({{50.0, made_up(0.30, 0.10)}}).csv();
  EXPECT_THAT(csv, HasSubstr("\n50,all,counter,rival,200,4000,0.105000,"));
  EXPECT_THAT(csv, HasSubstr("\n50,flat 3 m,ideal,reference,,2000,0.000000,"));
  EXPECT_THAT(overall_table(made_up(0.30, 0.10)).markdown(), HasSubstr("30.50 +-6.35"));
  EXPECT_THAT(scene_by_scene_table(made_up(0.30, 0.10)).markdown(), HasSubstr("10.50 / 1.00"));
  EXPECT_THAT(csv, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace dtof
