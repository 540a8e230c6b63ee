// SPDX-License-Identifier: Apache-2.0
#include "reproduction/thesis_statements.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace dtof {
namespace {

using testing::HasSubstr;

Comparison figure(double value, double half_width, double limit) {
  return {"figure", {value, {value - half_width, value + half_width}}, limit};
}

AccuracyPoint point(Readout readout, double klux, double distance_m, double precision) {
  AccuracyPoint result{};
  result.estimator = readout_name(readout);
  result.title = readout_title(readout);
  result.klux = klux;
  result.distance_m = distance_m;
  result.relative_precision = {precision, {precision / 1.01, precision * 1.01}};
  return result;
}

// Every read-out at the precision that the thesis claims for it.
double claimed_precision(Readout readout, double klux, double distance_m) {
  const bool three_steps = readout == Readout::kThreeSteps;
  const bool histograms = readout == Readout::kSifh || readout == Readout::kFifh;
  const double rank = readout == Readout::kHisPointer ? 0.5 : readout == Readout::kEzPointer ? 0.7 : 1.0;
  double reach = 3.5;
  if (klux == 2.0) {
    reach = three_steps ? 3.0 : 5.0;
  } else if (klux == 14.0) {
    reach = three_steps ? 2.0 : 3.5;
  } else if (klux == 21.0) {
    reach = three_steps ? 1.0 : 3.0;
  } else if (klux == 25.0) {
    reach = readout == Readout::kEzPointer ? 3.0 : 2.5;
  } else {
    reach = 1.0;
  }
  if (distance_m > reach) {
    return readout == Readout::kEzPointer ? 0.04 : histograms ? 0.2 : 0.15;
  }
  return 0.025 * rank;
}

AccuracyStudy claimed_study(double klux, double scale = 1.0) {
  AccuracyStudy study;
  for (const Readout readout : thesis_readouts()) {
    for (const double distance : thesis_distances()) {
      study.points.push_back(
          point(readout, klux, distance, scale * claimed_precision(readout, klux, distance)));
    }
  }
  return study;
}

ThesisStudies claimed_studies() {
  ThesisStudies studies;
  for (const double klux : thesis_klux()) {
    studies.at_klux.emplace(klux, claimed_study(klux));
  }
  studies.tenth_at_50_klux = claimed_study(2.0);
  return studies;
}

TEST(Compare, IntervalDecides) {
  EXPECT_EQ(compare(figure(0.02, 0.005, 0.03), Side::kBelow), Verdict::kAgrees);
  EXPECT_EQ(compare(figure(0.04, 0.005, 0.03), Side::kBelow), Verdict::kDisagrees);
  EXPECT_EQ(compare(figure(0.02, 0.02, 0.03), Side::kBelow), Verdict::kOpen);
  EXPECT_EQ(compare(figure(0.02, 0.005, 0.03), Side::kAbove), Verdict::kDisagrees);
  EXPECT_EQ(compare(figure(0.04, 0.005, 0.03), Side::kAbove), Verdict::kAgrees);
}

AccuracyPoint seen(double precision, std::uint64_t frames, std::uint64_t far) {
  AccuracyPoint result = point(Readout::kThreeSteps, 14.0, 2.5, precision);
  result.frames = frames;
  result.far_before = result.far_after = far;
  result.relative_precision.with_unseen = Interval{precision / 1.01, 0.3};
  result.rmse_m = {0.05, {0.04, 0.06}, Interval{0.04, 1.0}};
  return result;
}

TEST(Compare, OutliersThatWereNotSeenAreAllowedFor) {
  // None in 1,000 frames: they may still be 0.37 %. None in 4,000: rarer than 0.1 %.
  EXPECT_EQ(compare(precision_against(seen(0.019, 1000, 0), 0.03), Side::kBelow), Verdict::kOpen);
  EXPECT_EQ(compare(precision_against(seen(0.019, 4000, 0), 0.03), Side::kBelow), Verdict::kAgrees);
  EXPECT_EQ(compare(precision_against(seen(0.019, 4000, 1), 0.03), Side::kBelow), Verdict::kOpen);
  EXPECT_EQ(compare(precision_against(seen(0.04, 1000, 1), 0.03), Side::kBelow), Verdict::kDisagrees);
  const Comparison rmse = rmse_against(seen(0.019, 1000, 3), 0.03);
  EXPECT_DOUBLE_EQ(rmse.value.value, 0.02);
  EXPECT_DOUBLE_EQ(rmse.value.with_unseen->high, 0.4);
  EXPECT_EQ(compare(rmse, Side::kBelow), Verdict::kOpen);
  EXPECT_EQ(compare(rmse_against(seen(0.019, 4000, 0), 0.03), Side::kBelow), Verdict::kAgrees);
}

TEST(Judgement, AllOf) {
  const Comparison low = figure(0.02, 0.005, 0.03);
  const Comparison high = figure(0.04, 0.005, 0.03);
  const Comparison unsure = figure(0.03, 0.005, 0.03);
  EXPECT_EQ(all_of(std::vector{low, low}, Side::kBelow).verdict, Verdict::kAgrees);
  EXPECT_EQ(all_of(std::vector{low, unsure}, Side::kBelow).verdict, Verdict::kOpen);
  const Judgement against = all_of(std::vector{low, high, unsure}, Side::kBelow);
  EXPECT_EQ(against.verdict, Verdict::kDisagrees);
  EXPECT_THAT(against.here, HasSubstr("1 of 3: figure 4.00 [3.50, 4.50] %"));
  EXPECT_THROW((void)all_of(std::vector<Comparison>{}, Side::kBelow), std::logic_error);
}

TEST(Judgement, AnyOf) {
  const Comparison low = figure(0.02, 0.005, 0.03);
  const Comparison high = figure(0.04, 0.005, 0.03);
  const Comparison unsure = figure(0.03, 0.005, 0.03);
  EXPECT_EQ(any_of(std::vector{low, high}, Side::kAbove).verdict, Verdict::kAgrees);
  EXPECT_EQ(any_of(std::vector{low, low}, Side::kAbove).verdict, Verdict::kDisagrees);
  EXPECT_EQ(any_of(std::vector{low, unsure}, Side::kAbove).verdict, Verdict::kOpen);
}

TEST(Judgement, BothTakesTheWorse) {
  const Judgement yes{Verdict::kAgrees, "a"};
  const Judgement open{Verdict::kOpen, "b"};
  const Judgement no{Verdict::kDisagrees, "c"};
  EXPECT_EQ(both(yes, open).verdict, Verdict::kOpen);
  EXPECT_EQ(both(no, open).verdict, Verdict::kDisagrees);
  EXPECT_EQ(both(yes, yes).here, "a; a");
}

TEST(CustomerLimit, ThesisSection34) {
  EXPECT_EQ(customer_limit(0.99), 0.10);
  EXPECT_EQ(customer_limit(1.0), 0.03);
}

TEST(PrecisionRatio, GeometricMean) {
  AccuracyStudy study;
  study.points = {point(Readout::kSifh, 14.0, 1.0, 0.02), point(Readout::kSifh, 14.0, 2.0, 0.08),
                  point(Readout::kSifh, 14.0, 4.0, 0.5),  point(Readout::kFifh, 14.0, 1.0, 0.01),
                  point(Readout::kFifh, 14.0, 2.0, 0.01), point(Readout::kFifh, 14.0, 4.0, 0.01)};
  const Estimate ratio = precision_ratio(study, "sifh", "fifh", 1.0, 2.0);
  EXPECT_NEAR(ratio.value, 4.0, 1e-12);
  // Four figures of 1 % each, two distances: 1 % in all.
  EXPECT_NEAR(std::log(ratio.interval.high / 4.0), std::log(1.01), 1e-12);
  EXPECT_THROW((void)precision_ratio(study, "sifh", "fifh", 8.0, 9.0), std::logic_error);
}

TEST(PrecisionStatements, AllAgreeWithWhatTheThesisClaims) {
  const ThesisStudies studies = claimed_studies();
  for (const ThesisStatement& statement : precision_statements()) {
    const Judgement judgement = statement.judge(studies);
    EXPECT_EQ(judgement.verdict, Verdict::kAgrees) << statement.text << ": " << judgement.here;
  }
}

TEST(PrecisionStatements, EveryRuleNamesWhatIsJudged) {
  for (const auto* statements : {&precision_statements(), &alternative_readings()}) {
    for (const ThesisStatement& statement : *statements) {
      EXPECT_THAT(statement.rule, HasSubstr(" m")) << statement.text;
    }
  }
  const auto beyond = std::ranges::find(
      precision_statements(), "14 klux: beyond 3.5 m no read-out is below 3 %", &ThesisStatement::text);
  ASSERT_NE(beyond, precision_statements().end());
  EXPECT_THAT(beyond->rule, HasSubstr("4, 4.5, 5 m"));
  EXPECT_THAT(beyond->rule, HasSubstr("nothing is said beyond 5 m"));
}

// One distance at which another read-out is the more precise contradicts, however good the mean is.
TEST(PrecisionStatements, TheMostPreciseIsJudgedAtEachDistance) {
  ThesisStudies studies = claimed_studies();
  for (AccuracyPoint& p : studies.at_klux.at(14.0).points) {
    if (p.estimator == "ezpointer" && p.distance_m == 0.2) {
      p.relative_precision = {0.005, {0.0049, 0.0051}};
    }
  }
  const auto statement = std::ranges::find(precision_statements(),
                                           "14 klux, 0.2 to 3 m: hisPointer is the most precise of the four",
                                           &ThesisStatement::text);
  const Judgement judgement = statement->judge(studies);
  EXPECT_EQ(judgement.verdict, Verdict::kDisagrees);
  EXPECT_THAT(judgement.here, HasSubstr("ezPointer / hisPointer at 0.2 m"));
}

TEST(PrecisionStatements, EachCanFail) {
  // Perfect and hopeless sensors contradict the statements between them.
  ThesisStudies perfect = claimed_studies();
  ThesisStudies hopeless = claimed_studies();
  ThesisStudies bent = claimed_studies();
  for (const double klux : thesis_klux()) {
    for (AccuracyPoint& p : perfect.at_klux.at(klux).points) {
      p = point(parse_readout(p.estimator), klux, p.distance_m, 0.001);
    }
    for (AccuracyPoint& p : hopeless.at_klux.at(klux).points) {
      p = point(parse_readout(p.estimator), klux, p.distance_m, 0.9);
    }
    for (AccuracyPoint& p : bent.at_klux.at(klux).points) {
      p.bias_m.value = p.distance_m > 1.5 ? -0.8 * (p.distance_m - 1.5) : 0.0;  // a pointer that stays behind
    }
  }
  for (AccuracyPoint& p : hopeless.tenth_at_50_klux.points) {
    p = point(parse_readout(p.estimator), 50.0, p.distance_m, 0.9);
  }
  for (const ThesisStatement& statement : precision_statements()) {
    const bool can_fail = statement.judge(perfect).verdict != Verdict::kAgrees ||
                          statement.judge(hopeless).verdict != Verdict::kAgrees ||
                          statement.judge(bent).verdict != Verdict::kAgrees;
    EXPECT_TRUE(can_fail) << statement.text;
  }
}

TEST(AlternativeReadings, CanAgreeAndFail) {
  ThesisStudies studies = claimed_studies();
  ThesisStudies hopeless = claimed_studies();
  for (const double klux : thesis_klux()) {
    for (AccuracyPoint& p : hopeless.at_klux.at(klux).points) {
      // The one with the least spread loses where the best is asked for.
      p = point(parse_readout(p.estimator), klux, p.distance_m, p.estimator == "hispointer" ? 0.95 : 0.9);
      p.rmse_m = {0.5 * p.distance_m, {0.4 * p.distance_m, 0.6 * p.distance_m}};
    }
  }
  ThesisStudies perfect = claimed_studies();
  for (const double klux : thesis_klux()) {
    for (AccuracyPoint& p : perfect.at_klux.at(klux).points) {
      p = point(parse_readout(p.estimator), klux, p.distance_m, p.estimator == "hispointer" ? 0.0005 : 0.001);
    }
  }
  for (const ThesisStatement& reading : alternative_readings()) {
    EXPECT_NE(reading.judge(hopeless).verdict == Verdict::kAgrees,
              reading.judge(perfect).verdict == Verdict::kAgrees)
        << reading.text;
  }
}

}  // namespace
}  // namespace dtof
