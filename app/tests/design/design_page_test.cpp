// SPDX-License-Identifier: Apache-2.0
#include "design/design_page.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "dtof/core/frame_time.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;

DesignOption option(Readout readout, double share, double mm2) {
  DesignOption made;
  made.candidate.array.parameters = ReadoutParameters::defaults(readout);
  made.candidate.cost = {.mm2 = mm2, .fmax_mhz = 350.0, .bits_per_pixel = 14.0};
  made.candidate.slots_taken = 0.2;
  made.candidate.clocks = 1'100'000;
  LightScore light;
  light.klux = 50.0;
  light.above_3_percent = {share, {share - 0.005, share + 0.005}};
  light.above_10_percent = {share / 2, {}};
  light.detected = Estimate{0.875, {0.87, 0.88}};
  light.false_alarms = Estimate{0.0005, {}};
  made.screened.lights = {light};
  made.score = made.screened;
  return made;
}

DesignRequest request() {
  DesignRequest made;
  made.bench.sensor = parse_preset("thesis");
  made.limits.most_mm2 = 2.0;
  return made;
}

DesignResult result(const DesignRequest& request, std::vector<DesignOption> options) {
  DesignResult made;
  made.options = std::move(options);
  made.frames = 4;
  made.recommendation = recommend(made.options, request.limits);
  for (const LimitChange& change : limit_changes(request.limits)) {
    made.consequences.push_back({change, recommend(made.options, change.limits), "--max-mm2 would do"});
  }
  return made;
}

std::vector<DesignOption> two_options() {
  return {option(Readout::kPoolPointer, 0.01, 1.9), option(Readout::kEzPointer, 0.50, 1.0)};
}

TEST(DesignPage, TheTableHasAReadoutALineBestFirst) {
  const std::string text = design_rows(request(), result(request(), two_options())).markdown();
  EXPECT_THAT(text, HasSubstr("1.00 [0.50, 1.50]"));
  EXPECT_THAT(text, HasSubstr("87.5"));
  EXPECT_THAT(text, HasSubstr("0.05"));
  EXPECT_THAT(text, HasSubstr("latency ms"));
  EXPECT_LT(text.find("poolPointer"), text.find("ezPointer"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 4);
}

TEST(DesignPage, TheRecommendationHasItsReasonAndItsCompetitor) {
  const std::string text = design_recommendation(request(), result(request(), two_options()));
  EXPECT_THAT(text, HasSubstr("Recommended: poolPointer, 1.90 mm2"));
  EXPECT_THAT(text, HasSubstr("the fewest of the 2 read-outs"));
  EXPECT_THAT(text, HasSubstr("Nearest competitor: ezPointer, 1.00 mm2"));
  const std::string alone = design_recommendation(request(), result(request(), {two_options()[1]}));
  EXPECT_THAT(alone, HasSubstr("No other read-out keeps the limits"));
}

// 1,100,000 clocks, 30 times a second.
TEST(DesignPage, TheSlowestClockIsSaidIfTheFrameLeavesTime) {
  DesignRequest asked = request();
  std::vector<DesignOption> options = two_options();
  const std::string text = design_recommendation(asked, result(asked, options));
  const double mw = options[0].candidate.mw(33e6);
  EXPECT_LT(mw, 0.2 * options[0].candidate.mw(330e6));
  EXPECT_THAT(text, HasSubstr(fmt::format(" Its frames still fit at 33 MHz, with {:.0f} mW. Nearest", mw)));
  options[0].candidate.clocks = 10'500'000;
  EXPECT_THAT(design_recommendation(asked, result(asked, options)), Not(HasSubstr("still fit")));
}

TEST(DesignPage, SeveralColumnsForEachSramAreSaidEverywhere) {
  const DesignRequest asked = request();
  std::vector<DesignOption> options = two_options();
  ArrayChoice& array = options[1].candidate.array;
  array.columns_per_sram = 4;
  array.rows = 640;
  array.columns = 50;
  array.pointer_ports = 1;
  const DesignResult found = result(asked, {options[1]});
  EXPECT_EQ(
      design_product(asked, found, "thesis"),
      "dtof product --sensor thesis --readout ezpointer --pointer-ports 1 --columns-per-sram 4 --out chip");
  EXPECT_THAT(design_rows(asked, found).markdown(),
              HasSubstr("ezPointer --pointer-ports 1 --columns-per-sram 4"));
  EXPECT_THAT(
      design_clocks(asked, found).front(),
      HasSubstr(fmt::format(" takes {} clocks", predicted_frame_clocks(array.parameters, 640, 50, 3333))));
  options[1].candidate.array.arrays = 2;
  EXPECT_THAT(design_product(asked, result(asked, {options[1]}), "thesis"),
              HasSubstr("# with columns = 200 in"));
}

TEST(DesignPage, ASmallerArrayThatIsAsGoodIsTheReason) {
  const std::string text =
      design_recommendation(request(), result(request(), {option(Readout::kPoolPointer, 0.100, 1.9),
                                                          option(Readout::kPoolPointerLean, 0.103, 0.7)}));
  EXPECT_THAT(text, HasSubstr("Recommended: poolPointer lean"));
  EXPECT_THAT(text, HasSubstr("at most 1.05 times the 10.00 [9.50, 10.50] % of poolPointer"));
  EXPECT_THAT(text, HasSubstr("smaller array (0.70 of 1.90 mm2)"));
  EXPECT_THAT(
      design_recommendation(request(), result(request(), {option(Readout::kPoolPointer, 0.0, 1.9),
                                                          option(Readout::kPoolPointerLean, 0.0008, 0.7)})),
      HasSubstr("at most 0.1 % of the pixels more than the"));
}

TEST(DesignPage, AnEstimateNearTheLimitAsksToBeConfirmed) {
  DesignRequest tight = request();
  EXPECT_THAT(design_recommendation(tight, result(tight, {option(Readout::kSifh, 0.01, 1.0)})),
              Not(HasSubstr("--confirm")));
  EXPECT_THAT(design_recommendation(tight, result(tight, {option(Readout::kSifh, 0.01, 1.9999)})),
              HasSubstr("--confirm"));
}

TEST(DesignPage, ConsequencesNameTheOtherWinnerOrWhatWouldDo) {
  const DesignRequest made = request();
  const std::string text = design_consequences(made, result(made, two_options()));
  EXPECT_THAT(text, HasSubstr("* area 10 % less: ezPointer, 1.00 mm2"));
  EXPECT_THAT(text, HasSubstr("50.00 [49.50, 50.50] % instead of 1.00 [0.50, 1.50] %"));
  EXPECT_THAT(text, HasSubstr("* area 10 % more: the same"));
  EXPECT_THAT(text, HasSubstr("* clock 10 % more: --max-mm2 would do"));
}

TEST(DesignPage, SeveralArraysAreSaidEverywhere) {
  DesignOption wide = option(Readout::kSifh, 0.01, 1.0);
  wide.candidate.array.columns = 160;
  wide.candidate.array.arrays = 2;
  const DesignRequest made = request();
  const DesignResult found = result(made, {wide});
  EXPECT_THAT(design_rows(made, found).markdown(), HasSubstr("SiFH, 2 arrays of 160 columns"));
  EXPECT_EQ(design_product(made, found, "mine.toml"),
            "dtof product --sensor mine.toml --readout sifh --out chip  # with columns = 160 in the sensor "
            "file, 2 times");
}

RivalOption rival(std::string_view name, double share) {
  RivalOption made{
      .entry = &find_rival(name), .bits_per_pixel = 256, .frames = 3, .memory_mm2 = 2.345, .score = {}};
  made.score = option(Readout::kSifh, share, 1.0).screened;
  return made;
}

TEST(DesignPage, ARivalHasNoAreaOfLogicAndTheReason) {
  const DesignRequest made = request();
  DesignResult found = result(made, two_options());
  EXPECT_EQ(design_rivals(found), "");
  EXPECT_EQ(design_more_accurate(found), "");
  found.rivals = {rival("histogram32", 0.002), rival("signs", 0.60)};
  found.rivals_left_out = {{&find_rival("fourier16"), "its memory alone takes 5.00 mm2"}};
  const std::string text = design_rivals(found);
  EXPECT_THAT(text, HasSubstr("32-bin histogram"));
  EXPECT_THAT(text, HasSubstr("2.35"));  // mm2 of memory
  EXPECT_THAT(text, HasSubstr("Logic, clock and power of rivals are not estimated: a rival has no RTL"));
  EXPECT_THAT(text, HasSubstr("1 rivals are left out"));
  EXPECT_EQ(design_more_accurate(found),
            "More accurate, no RTL: 32-bin histogram, 0.20 [-0.30, 0.70] %, 256 bits a pixel, 2.35 mm2 of "
            "memory alone, 3 frames.\n");
  const std::string page = design_page(made, found, "mine.toml", "dtof design", "");
  for (const char* part : {"## Rivals", "More accurate, no RTL", "not estimated",
                           "* truncated Fourier K = 16 (rival): its memory alone takes 5.00 mm2"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  const std::string csv = design_csv(made, found);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
  EXPECT_THAT(csv, HasSubstr("histogram32,rival,50,0.002000"));
  EXPECT_THAT(csv, HasSubstr("not estimated,not estimated,not estimated,not estimated,256,4,2.3450"));
  found.rivals = {rival("signs", 0.60)};
  EXPECT_EQ(design_more_accurate(found), "No rival of 1 is more accurate.\n");
}

TEST(DesignPage, MoreThanThreeBetterRivalsAreCounted) {
  const DesignRequest made = request();
  DesignResult found = result(made, {option(Readout::kEzPointer, 0.50, 1.0)});
  for (const RivalEntry& entry : all_rivals().first(5)) {
    found.rivals.push_back(rival(entry.name, 0.01));
  }
  const std::string text = design_more_accurate(found);
  EXPECT_THAT(text, HasSubstr("; and 2 more."));
  EXPECT_EQ(std::ranges::count(text, ';'), 3) << "three are named";
}

TEST(DesignPage, ThePageSaysHowAndWithWhatError) {
  const DesignRequest made = request();
  DesignResult found = result(made, two_options());
  found.left_out.push_back({Readout::kSifh, "--max-mm2 15"});
  const std::string page =
      design_page(made, found, "mine.toml", "dtof design --sensor mine.toml", "MEASURED");
  for (const char* part : {"# A read-out for thesis", "at most 2 mm2", "## Left out", "* SiFH: --max-mm2 15",
                           "## Confirmed", "MEASURED", "they were off by at most",
                           "dtof product --sensor mine.toml --readout poolpointer --out chip",
                           "Command: `dtof design --sensor mine.toml`", "so that the frame fits"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_EQ(std::ranges::count(design_csv(made, found), '\n'), 3);
}

}  // namespace
}  // namespace dtof
