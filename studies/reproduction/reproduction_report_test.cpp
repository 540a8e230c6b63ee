// SPDX-License-Identifier: Apache-2.0
#include "reproduction/reproduction_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

AccuracyPoint measured_point(Readout readout, double klux, double distance_m, double precision) {
  AccuracyPoint p{};
  p.estimator = readout_name(readout);
  p.title = readout_title(readout);
  p.klux = klux;
  p.distance_m = distance_m;
  p.frames = 4000;
  p.relative_precision = {precision, {precision / 1.01, precision * 1.01}};
  const double rmse = 1.5 * precision * distance_m;
  p.rmse_m = {rmse, {rmse / 1.01, rmse * 1.01}};
  p.slope = Estimate{1.0, {0.9, 1.1}};
  return p;
}

AccuracyStudy study(const std::vector<Readout>& readouts, double klux, const std::vector<double>& distances,
                    double precision) {
  AccuracyStudy result;
  for (const Readout readout : readouts) {
    for (const double distance : distances) {
      result.points.push_back(measured_point(readout, klux, distance, precision));
    }
  }
  return result;
}

ThesisStudies studies(double precision) {
  ThesisStudies result;
  for (const double klux : thesis_klux()) {
    result.at_klux.emplace(klux, study(thesis_readouts(), klux, thesis_distances(), precision));
  }
  result.tenth_at_50_klux = study(thesis_readouts(), 50.0, thesis_distances(), precision);
  return result;
}

HistogramPeaks peaks(double count, double bin, std::uint64_t fakes) {
  HistogramPeaks result;
  result.count = {count - 1.0, count, count + 1.0};
  result.bin = {bin - 1.0, bin, bin + 1.0};
  result.fake_share = estimate_rare_share(fakes, 1000);
  result.one_frame = {1.0, 2.0, 1.0};
  return result;
}

PileUp pile_up_of(double lost, double width) {
  PileUp result;
  result.arriving = {100.0};
  result.delivered = {100.0 * (1.0 - lost)};
  result.arriving_fwhm_ns = 2.0;
  result.delivered_fwhm_ns = width;
  return result;
}

// Figures with which the sentences below come out one way.
Reproduction figures() {
  Reproduction r;
  r.sensor = parse_preset("thesis");
  r.studies = studies(0.02);
  r.whole_frame = peaks(29.0, 197.0, 0);
  r.half_frame = peaks(17.0, 195.0, 0);
  r.long_frame = peaks(230.0, 197.0, 0);
  r.sunny = peaks(9.0, 400.0, 470);
  r.indoors = peaks(10.0, 500.0, 2);
  r.far = peaks(8.0, 600.0, 300);
  r.pile_up_near = pile_up_of(0.7, 1.2);
  r.pile_up_far = pile_up_of(0.1, 1.9);
  r.sides.as_counted = {0.7, {0.69, 0.71}};
  r.sides.turned = {0.5, {0.49, 0.51}};
  r.fine.bin = {190.0, 195.0, 200.0};
  for (const int guard : {0, 46}) {
    FilteredCounts filter;
    filter.guard = guard;
    filter.kept = guard == 0 ? Spread{0.3, 0.4, 0.5} : Spread{0.99, 1.0, 1.0};
    r.filters.push_back(filter);
    r.guards.push_back(
        {guard_title(guard), study({Readout::kHisPointer}, 14.0, {0.5, 1.0}, guard == 0 ? 0.05 : 0.02)});
  }
  const std::vector<std::string> methods = {"none",        "binning",          "binning, eight slots", "gate",
                                            "narrow gate", "coincidence 1 ns", "coincidence 2 ns"};
  for (const std::string& name : methods) {
    r.methods.push_back({name, study(thesis_readouts(), 50.0, {3.0}, name == "none" ? 0.05 : 0.04)});
  }
  r.method_frames = 4000;
  r.assumptions = {{"preset", studies(0.02)}, {"four slots", studies(0.01)}};
  r.steps = {{"step of 1 bin (thesis)", study({Readout::kEzPointer}, 14.0, {0.2, 0.3}, 0.1)},
             {"step of 2 bins", study({Readout::kEzPointer}, 14.0, {0.2, 0.3}, 0.15)}};
  r.rates.push_back({0.3, 0.15, studies(0.02)});
  r.lights = {study(thesis_readouts(), 50.0, {2.5, 3.0}, 0.04),
              study(thesis_readouts(), 46.0, {2.5, 3.0}, 0.02)};
  r.light_frames = 4000;
  for (const double klux : {14.0, 50.0}) {
    r.convergence.push_back(study({Readout::kEzPointer, Readout::kHisPointer}, klux, {3.0, 5.0}, 0.025));
  }
  for (const std::uint32_t acquisitions : {3333U, 33'333U}) {
    r.pulses.push_back({acquisitions, study({Readout::kEzPointer}, 14.0, {3.0, 5.0}, 0.02)});
    r.pulses.back().study.points.back().bias_m.value = acquisitions == 3333U ? -1.67 : -0.02;
  }
  r.array_sizes = {32'000.0, 3200.0};
  r.margins = {{"ezpointer", "ezPointer", 32'000.0, 0.9, 1.2}, {"ezpointer", "ezPointer", 3200.0, 0.5, 0.6}};
  r.small_arrays = {{"3200 sensors", study(thesis_readouts(), 50.0, {1.0}, 0.01)}};
  return r;
}

std::string text_of(const Reproduction& r) {
  return page_text("reproduction", render_reproduction(r, "the command").page);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;  // a mismatch does not print the whole report
}

// README's words on pile-up are read from this file by the statement's name.
TEST(ReproductionReport, StatementsAreQuotedOnceInTheCsv) {
  const std::string csv = render_reproduction(figures(), "").statements_csv;
  EXPECT_THAT(csv, HasSubstr("\nFig. 2.4,\"pile-up takes counts and narrows the pulse, at 0.2 m more than"));
  EXPECT_THAT(csv, testing::Not(HasSubstr("\"\"\"")));
}

struct Change {
  const char* what;
  void (*change)(Reproduction&);
  const char* before;  // a sentence, or part of a row
  const char* after;
};

TEST(ReproductionReport, EverySentenceFollowsItsFigures) {
  const std::vector<Change> changes = {
      {"statements", [](Reproduction& r) { r.studies = studies(0.5); },
       "| 14 klux: beyond 3.5 m no read-out is below 3 %",
       "| yes    | nearest to its limit: three steps at 4"},
      {"Fig. 2.4", [](Reproduction& r) { r.pile_up_near = pile_up_of(0.0, 2.0); }, "lost: 70 % and 10 %",
       "lost: 0 % and 10 %"},
      {"Fig. 3.5", [](Reproduction& r) { r.half_frame = peaks(25.0, 195.0, 0); }, "16 to 18 counts",
       "24 to 26 counts"},
      {"Fig. 3.6",
       [](Reproduction& r) {
         r.sides.turned = {0.6, {0.59, 0.61}};
       },
       "50.0 [49.0, 51.0] % turned", "60.0 [59.0, 61.0] % turned"},
      {"Fig. 3.9",
       [](Reproduction& r) {
         r.fine.bin = {200.0, 205.0, 210.0};
       },
       "bin 190 to 200", "bin 200 to 210"},
      {"Fig. 3.11",
       [](Reproduction& r) {
         r.guards.front().measured = study({Readout::kHisPointer}, 14.0, {0.5, 1.0}, 0.01);
       },
       "do not overlap, at: 0.5 m, 1 m.", "do not overlap, at: none."},
      {"Fig. 3.13b", [](Reproduction& r) { r.indoors = peaks(10.0, 500.0, 400); }, "0.2 [0.0, 0.7]",
       "40.0 [37.0, 43.1]"},
      {"Fig. 3.15", [](Reproduction& r) { r.far = peaks(8.0, 600.0, 2); },
       "30.0 [27.2, 32.9] % of frames there", "0.2 [0.0, 0.7] % of frames there"},
      {"methods",
       [](Reproduction& r) { r.methods[1].measured = study(thesis_readouts(), 50.0, {3.0}, 0.06); },
       "* binning: rmse falls for ezPointer, SiFH, FiFH, three steps, hisPointer; rises for none",
       "* binning: rmse falls for none; rises for ezPointer"},
      {"slots of the TDC", [](Reproduction& r) { r.sensor.slots = 8; }, "the TDC has 2 slots",
       "the TDC has 8 slots"},
      {"assumptions", [](Reproduction& r) { r.assumptions[1].measured = studies(0.03); },
       "do not overlap, with: four slots; above with: none",
       "do not overlap, with: none; above with: four slots"},
      {"steps",
       [](Reproduction& r) {
         r.steps[1].measured = study({Readout::kEzPointer}, 14.0, {0.2, 0.3}, 0.05);
       },
       "1.50 times the spread", "0.50 times the spread"},
      {"lights",
       [](Reproduction& r) {
         r.lights[1] = study(thesis_readouts(), 46.0, {2.5, 3.0}, 0.04);
       },
       "|       50 |     50 |", "|       46 |     46 |"},
      {"what precision hides",
       [](Reproduction& r) {
         for (AccuracyStudy& convergence : r.convergence) {
           for (AccuracyPoint& p : convergence.points) {
             p.rmse_m.value = 0.01 * p.distance_m;
           }
         }
       },
       "ezPointer at 14 klux. At 2 of 2 distances", "ezPointer at 14 klux. At 0 of 2 distances"},
      {"pulses", [](Reproduction& r) { r.pulses.back().study.points.back().bias_m.value = -1.6; },
       "-0.02 m with 33333 acquisitions", "-1.60 m with 33333 acquisitions"},
      {"arrays", [](Reproduction& r) { r.margins.front().by_rmse = 0.9; }, "3200 (not 32000)",
       "at least 32000"}};
  for (const Change& change : changes) {
    SCOPED_TRACE(change.what);
    Reproduction r = figures();
    const std::string before = text_of(r);
    EXPECT_TRUE(contains(before, change.before)) << change.before;
    change.change(r);
    const std::string after = text_of(r);
    EXPECT_TRUE(contains(after, change.after)) << change.after;
    if (std::string(change.what) != "statements") {
      EXPECT_FALSE(contains(after, change.before)) << change.before;
    }
  }
}

TEST(ReproductionReport, CountsItsVerdicts) {
  const Reproduction r = figures();
  std::array<int, 3> counts{};
  for (const JudgedStatement& statement : judged_statements(r)) {
    ++counts[static_cast<std::size_t>(statement.judgement.verdict)];
    EXPECT_FALSE(statement.rule.empty()) << statement.text;
  }
  EXPECT_THAT(front_page(render_reproduction(r, "")),
              HasSubstr("**" + std::to_string(counts[0]) + " statements agree, " + std::to_string(counts[1]) +
                        " do not, " + std::to_string(counts[2]) + " stay open.**"));
}

TEST(ReproductionReport, TheFrontPageSaysHowItWasMeasured) {
  EXPECT_THAT(front_page(render_reproduction(figures(), "")), StartsWith(R"(# Reproduction of the thesis

This page compares accuracy statements of the thesis with this project's models: preset thesis (0.3 / R^2 signal events per pulse, 0.15 background events at 14 klux, 3333 acquisitions), 1000 frames per point, seed 1, look-up tables of calibration run 1. Relative precision is the thesis's own measure (Eq. 3.14).

"Agrees" follows from the rule beside it. *Yes*: the 95 % intervals of all figures in the rule lie wholly on the right side of the limit. *No*: one interval lies wholly on the wrong side. *Open*: an interval contains the limit; then 10000 frames are judged where they were run. If one to nine outliers were seen, an interval allows for outliers that were not seen, up to the range of the sensor. If none was seen, outliers are rarer than 0.1 %, and the verdict is about results without outliers ([docs/reference/accuracy.md](../docs/reference/accuracy.md)). An asterisk marks figures with fewer than ten outliers.

**)"));
}

// What the page of figures() has between its tables.
constexpr std::array kWords = {
    R"(
[accuracy.csv](reproduction/accuracy.csv) has every figure with its interval.

## Linearity (Fig. 3.16)
)",
    R"(
## Binning, time gating, coincidence at 50 klux and 3 m

Relative precision / rmse without table / share of errors above 10 %, all in %; 4000 frames:

|)",
    R"(
A pixel has 0.54 background events per acquisition, four binned pixels together have 2.14; the TDC has 2 slots.

## Other readings

The same sweeps judge narrower and wider ranges and plots with fewer points: 6 readings agree, 4 do not, 3 stay open.

|)",
    R"(
## Other assumptions

Each row changes one assumption, with 1000 frames (a tenth for 33,333 acquisitions):

|)",
    R"(
The largest number of statements that agree, 6 of 15, is found with: preset, four slots. With the preset, 6 agree.

Relative precision at the nearest distance under the same assumptions:

|)",
    R"(
The relative precision of ezPointer is below that of the preset, and the intervals do not overlap, with: four slots; above with: none.

A pointer that has settled still moves by one bin for each photon. This is its spread at the nearest targets with other steps (limit at 0.2 m: 10 %):

|)",
    R"(
* step of 2 bins: 1.50 times the spread of the thesis's step at 0.2 m

Both rates changed together; statements that agree / disagree / stay open:

|)",
    R"(
## How much light each read-out tolerates

4000 frames per point.
)",
    R"(
One result that is off by half the distance, in 4000 frames, alone gives a relative precision of 0.8 %; in 1,000 frames 1.6 %.

## What relative precision hides

Eq. 3.14 is a spread. It does not show a wrong mean.
)",
    R"(
ezPointer at 50 klux. At 2 of 2 distances the relative precision is at most 3 %, but the rmse is above 3 % (distances in m: 3, 5).

|)",
    R"(
ezPointer's bias at 5 m: -1.67 m with 3333 acquisitions, -0.02 m with 33333 acquisitions.
)",
    R"(
If fewer sensors share the laser, each sensor has 32,000 / (number of sensors) times the signal and the same background. Limits: 10 % below 1 m, 3 % from 1 to 3 m, at 0.2, 0.3, 0.5, 0.8, 1, 1.5, 2, 2.5 and 3 m, judged by the figures without their intervals. 2 array sizes from 3200 to 32000 sensors.

|)",
    R"(
## Future work: read-outs on small arrays at 50 klux

3200 sensors, relative precision, %:

|)",
    R"(
3200 sensors, rmse after the look-up table, % of distance:

|)",
    R"(

Command: `the command`
)"};

TEST(ReproductionReport, WordsBetweenTheTables) {
  const std::string page = text_of(figures());
  for (const char* const words : kWords) {
    EXPECT_TRUE(contains(page, words)) << words;
  }
}

TEST(ReproductionReport, MoreFramesDecideWhatIsOpen) {
  Reproduction r = figures();
  r.studies.at_klux.at(50.0) = study(thesis_readouts(), 50.0, thesis_distances(), 0.03);
  EXPECT_EQ(judge(r, precision_statements().front()).verdict, Verdict::kOpen);
  r.more_frames = studies(0.05);
  const Judgement judgement = judge(r, precision_statements().front());
  EXPECT_EQ(judgement.verdict, Verdict::kAgrees);
  EXPECT_THAT(judgement.here, HasSubstr("(10000 frames)"));
}

TEST(ReproductionReport, EveryPictureIsShown) {
  const ReproductionReport report = render_reproduction(figures(), "");
  const std::string page = page_text("reproduction", report.page);
  EXPECT_GT(report.pictures.size(), 15U);
  for (const ReproductionPicture& picture : report.pictures) {
    EXPECT_THAT(page, HasSubstr("![" + picture.layout.title + "](reproduction/" + picture.name + ")"));
  }
  for (const char* name :
       {"figure_3_6.svg", "figure_3_9.svg", "figure_3_11.svg", "figure_3_13.svg", "figure_3_15.svg"}) {
    EXPECT_NE(std::ranges::find(report.pictures, name, &ReproductionPicture::name), report.pictures.end());
  }
}

}  // namespace
}  // namespace dtof
