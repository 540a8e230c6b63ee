// SPDX-License-Identifier: Apache-2.0
#include "design_judgement/design_judgement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "design_judgement/design_judgement_report.hpp"
#include "design_judgement/judgement_store.hpp"
#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// A small array under little light, so that read-outs differ.
DesignRequest small_request() {
  DesignRequest request;
  SensorModel& sensor = request.bench.sensor;
  sensor = parse_preset("thesis");
  sensor.columns = 16;
  sensor.rows = 16;
  sensor.acquisitions = 100;
  sensor.slots = 1;
  request.bench.scenes = {Scene::kRoom};
  request.bench.klux = {5.0};
  request.frames = 2;
  return request;
}

JudgementSettings small_design_judgement_study() {
  JudgementSettings settings;
  settings.sensors = 1;
  settings.sweep_pixels = 500.0;
  settings.final_pixels = 1000.0;
  settings.final_seeds = 3;
  settings.finalists = 3;
  return settings;
}

DesignOption option_of(const ReadoutParameters& parameters, double share) {
  DesignOption option;
  option.candidate.array = {.parameters = parameters, .rows = 16, .columns = 16};
  option.candidate.cost.mm2 = 0.5;
  LightScore light;
  light.above_3_percent = {share, {share, share}};
  option.screened.lights = {light};
  return option;
}

/// A search that recommends its option `chosen`.
DesignResult result_of(std::vector<DesignOption> options, std::size_t chosen) {
  DesignResult result;
  result.options = std::move(options);
  result.recommendation.within = {chosen};
  result.recommendation.chosen = chosen;
  return result;
}

TEST(DesignJudgement, FindsAPlantedBadRecommendation) {
  JudgementSettings settings = small_design_judgement_study();
  settings.design = [&](const DesignRequest& request) {
    const std::vector<DesignCandidate> grid = design_candidates(request);
    const auto found =
        std::ranges::find(grid, Readout::kEzPointer, [](const DesignCandidate& c) { return c.readout(); });
    return result_of({option_of(found->array.parameters, 0.1)}, 0);
  };
  const SensorJudgement judged = judge_sensor(settings, small_request(), 1);
  EXPECT_EQ(judged.verdict(), Verdict::kBeyond);
  EXPECT_THAT(judged.recommended.name, testing::StartsWith("ezpointer"));
  EXPECT_THAT(judged.best.name, Not(testing::StartsWith("ezpointer")));
  EXPECT_GT(judged.ratio.interval.low, 1.2);
  EXPECT_GT(judged.recommended.place, 3U);
  EXPECT_EQ(judged.lost, Lost::kNotRead);
  EXPECT_EQ(judged.kept, judged.grid);
  EXPECT_EQ(judged.read, 1U);
}

TEST(DesignJudgement, ARecommendationBeyondALimitIsBad) {
  JudgementSettings settings = small_design_judgement_study();
  DesignRequest request = small_request();
  std::vector<double> areas;
  for (const DesignCandidate& candidate : design_candidates(request)) {
    areas.push_back(candidate.cost.mm2);
  }
  std::ranges::sort(areas);
  request.limits.most_mm2 = areas[areas.size() / 4];
  settings.design = [](DesignRequest without_limit) {
    without_limit.limits = {};
    const std::vector<DesignCandidate> grid = design_candidates(without_limit);
    const auto largest =
        std::ranges::max_element(grid, {}, [](const DesignCandidate& c) { return c.cost.mm2; });
    return result_of({option_of(largest->array.parameters, 0.1)}, 0);
  };
  const SensorJudgement judged = judge_sensor(settings, request, 1);
  EXPECT_FALSE(judged.keeps_limits);
  EXPECT_EQ(judged.verdict(), Verdict::kBeyond);
  EXPECT_LT(judged.kept, judged.grid);
  EXPECT_LE(judged.best.mm2, request.limits.most_mm2);
}

TEST(DesignJudgement, SaysWhereTheSearchLostTheBest) {
  JudgementSettings settings = small_design_judgement_study();
  settings.final_seeds = 2;
  settings.finalists = 1000;  // all candidates, so that the best does not depend on the recommendation
  const auto judged_with = [&](const std::function<DesignResult(const DesignRequest&)>& design) {
    settings.design = design;
    return judge_sensor(settings, small_request(), 1);
  };
  // The first judgement tells which candidate is the best.
  const ReadoutParameters poor = design_candidates(small_request()).front().array.parameters;
  const std::string best_name =
      judged_with([&](const DesignRequest&) { return result_of({option_of(poor, 0.1)}, 0); }).best.name;
  ReadoutParameters best;
  for (const DesignCandidate& candidate : design_candidates(small_request())) {
    if (command_options(candidate.array.parameters, small_request().bench.sensor) ==
        "--readout " + best_name) {
      best = candidate.array.parameters;
    }
  }
  const SensorJudgement right =
      judged_with([&](const DesignRequest&) { return result_of({option_of(best, 0.1)}, 0); });
  EXPECT_EQ(right.lost, Lost::kNothing);
  EXPECT_EQ(right.verdict(), Verdict::kWithin);
  EXPECT_EQ(right.ratio.value, 1.0);
  EXPECT_EQ(right.ratio.interval, (Interval{1.0, 1.0}));

  const SensorJudgement in_final = judged_with([&](const DesignRequest&) {
    DesignResult result = result_of({option_of(poor, 0.3), option_of(best, 0.2)}, 0);
    result.recommendation.within = {1, 0};
    return result;
  });
  EXPECT_EQ(in_final.lost, Lost::kInFinal);
  EXPECT_EQ(in_final.search_best, 0.2);
  EXPECT_EQ(in_final.search_other, 0.3);

  const SensorJudgement in_screening = judged_with([&](const DesignRequest&) {
    ReadoutParameters other = best;
    ++other.count_width;
    DesignResult result = result_of({option_of(poor, 0.3), option_of(best, 0.2), option_of(other, 0.15)}, 0);
    result.recommendation.within = {2, 0};
    return result;
  });
  EXPECT_EQ(in_screening.lost, Lost::kInScreening);
  EXPECT_EQ(in_screening.search_best, 0.2);
  EXPECT_EQ(in_screening.search_other, 0.15);
}

TEST(DesignJudgement, DoesNotDependOnTheThreads) {
  JudgementSettings settings = small_design_judgement_study();
  const ReadoutParameters poor = design_candidates(small_request()).front().array.parameters;
  settings.design = [&](const DesignRequest&) { return result_of({option_of(poor, 0.1)}, 0); };
  settings.threads = 1;
  const SensorJudgement one = judge_sensor(settings, small_request(), 1);
  settings.threads = 3;
  EXPECT_EQ(judge_sensor(settings, small_request(), 1), one);
}

TEST(DesignJudgement, RatiosByHand) {
  const std::vector<double> best = {0.10, 0.12, 0.08};
  const std::vector<double> same_ratio = {0.11, 0.132, 0.088};
  const Estimate exact = share_ratio(same_ratio, best, 30'000);
  EXPECT_NEAR(exact.value, 1.1, 1e-12);
  EXPECT_NEAR(exact.interval.low, 1.1, 1e-9);
  const std::vector<double> chosen = {0.12, 0.11, 0.10};
  const Estimate ratio = share_ratio(chosen, best, 30'000);
  EXPECT_NEAR(ratio.value, 1.1, 1e-12);
  // Residuals 0.1, -0.22, 0.12: standard deviation 0.19079, t of two degrees of freedom 4.3027.
  EXPECT_NEAR(ratio.interval.high - ratio.value, 4.3027 * 0.19079 / 1.7320508, 1e-3);
  const std::vector<double> none = {0.0, 0.0, 0.0};
  EXPECT_EQ(share_ratio(none, none, 1000).value, 1.0) << "less than a pixel counts as one";
  EXPECT_NEAR(share_ratio(std::vector<double>{0.01, 0.01, 0.01}, none, 1000).value, 10.0, 1e-9);
}

TEST(DesignJudgement, VerdictsByHand) {
  SensorJudgement judgement;
  judgement.best.share = {0.1, {}};
  judgement.recommended.share = {0.11, {}};
  judgement.ratio = {1.05, {0.9, 1.2}};
  EXPECT_EQ(judgement.verdict(), Verdict::kWithin);
  judgement.ratio = {1.06, {1.04, 1.08}};
  EXPECT_EQ(judgement.verdict(), Verdict::kUndecided);
  judgement.ratio = {1.10, {1.06, 1.14}};
  EXPECT_EQ(judgement.verdict(), Verdict::kBeyond);
  judgement.recommended.share = {0.1009, {}};
  EXPECT_EQ(judgement.verdict(), Verdict::kWithin) << "0.09 % of the pixels more";
  judgement.ratio = {0.9, {0.8, 1.0}};
  judgement.keeps_limits = false;
  EXPECT_EQ(judgement.verdict(), Verdict::kBeyond);
}

SensorJudgement judgement_of(double ratio, double low, Lost lost) {
  SensorJudgement made;
  made.grid = 114;
  made.kept = 57;
  made.read = 60;
  made.recommended = {.name = "sifh --nb 5", .share = {0.0111, {0.010, 0.012}}, .mm2 = 0.31, .place = 4};
  made.best = {.name = "poolpointer", .share = {0.01, {0.009, 0.011}}, .mm2 = 0.35, .place = 1};
  made.ratio = {ratio, {low, 2.0 * ratio - low}};
  made.lost = lost;
  made.search_best = 0.0123;
  made.search_other = 0.0145;
  return made;
}

TEST(DesignJudgement, AStoredJudgementIsEqual) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "judgement.csv";
  const SensorJudgement judgement = judgement_of(1.0 / 3.0, 0.1, Lost::kInScreening);
  store_judgement(file, judgement);
  EXPECT_EQ(stored_judgement(file), judgement);
  std::filesystem::remove(file);
}

TEST(DesignJudgement, AnInterruptedRunGoesOnWithTheNextSensor) {
  JudgementSettings settings = small_design_judgement_study();
  settings.ranges = {.most_columns = 18, .most_rows = 14, .most_acquisitions = 300};
  settings.store = std::filesystem::path(testing::TempDir()) / "judged";
  std::filesystem::remove_all(settings.store);
  settings.design = [](const DesignRequest& request) {
    const ReadoutParameters first =
        kept_of(design_candidates(request), request.limits).front().array.parameters;
    return result_of({option_of(first, 0.1)}, 0);
  };
  std::vector<SensorJudgement> reported;
  settings.on_judged = [&](int, const SensorJudgement& judgement) { reported.push_back(judgement); };
  const std::vector<JudgedSensor> first = judge_designs(settings);
  settings.design = [](const DesignRequest&) -> DesignResult { throw std::runtime_error("judged again"); };
  const std::vector<JudgedSensor> again = judge_designs(settings);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again.front().judgement, first.front().judgement);
  EXPECT_EQ(again.front().sensor.toml, first.front().sensor.toml);
  ASSERT_EQ(reported.size(), 2U);
  EXPECT_EQ(reported.front(), reported.back());
  settings.sensors = 2;
  EXPECT_THROW(judge_designs(settings), std::runtime_error) << "the second sensor is new";
  std::filesystem::remove_all(settings.store);
}

TEST(DesignJudgement, TheReportBeginsWithTheAnswerAndGivesReasons) {
  std::vector<JudgedSensor> judged;
  for (const SensorJudgement& judgement :
       {judgement_of(1.0, 1.0, Lost::kNothing), judgement_of(1.08, 1.01, Lost::kInFinal),
        judgement_of(1.2, 1.1, Lost::kNotRead)}) {
    judged.push_back({.sensor = {}, .judgement = judgement});
    judged.back().sensor.request = small_request();
  }
  const std::string report =
      page_text("design_judgement",
                judgement_page(small_design_judgement_study(), judged, "dtof-study design-judgement"));
  EXPECT_THAT(report, HasSubstr("**For 1 of 3 random sensors"));
  EXPECT_THAT(
      report,
      HasSubstr("As good or not told from it by the interval: 2 of 3. Worse beyond the interval: 1."));
  EXPECT_THAT(report,
              HasSubstr("* 2 (undecided): sifh --nb 5 instead of poolpointer. Reason: in the search's "
                        "last frames the best had 1.230 % and the recommendation 1.450 %"));
  EXPECT_THAT(report,
              HasSubstr("* 3 (beyond): sifh --nb 5 instead of poolpointer. Reason: the search did not"));
  EXPECT_THAT(report, Not(HasSubstr("* 1 (")));
  EXPECT_THAT(report, HasSubstr("1.450 %; the smaller array won, because its share was small enough.\n"));
  EXPECT_THAT(report,
              HasSubstr("; default options. Of 114 candidates 57 keep the limits; the search read 60.\n"));
  EXPECT_THAT(report, HasSubstr("Command: `dtof-study design-judgement`"));
  EXPECT_EQ(judgement_csv(judged).cells().size(), 4U);
  const std::vector<PlotSeries> curves = judgement_curves(judged);
  EXPECT_THAT(curves.front().y, testing::Each(testing::DoubleNear(1.11, 1e-9)));
}

TEST(DesignJudgement, RefusesWhatMakesNoJudgement) {
  const auto refused = [](auto change, const char* reason) {
    JudgementSettings settings = small_design_judgement_study();
    change(settings);
    EXPECT_THAT([&] { (void)judge_designs(settings); }, ThrowsMessage<InputError>(HasSubstr(reason)));
  };
  refused([](JudgementSettings& s) { s.final_seeds = 1; }, "two seeds");
  refused([](JudgementSettings& s) { s.finalists = 0; }, "a finalist");
  refused([](JudgementSettings& s) { s.ranges.most_rows = 3; }, "12 rows");
}

}  // namespace
}  // namespace dtof
