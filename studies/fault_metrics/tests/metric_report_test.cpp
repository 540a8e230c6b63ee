// SPDX-License-Identifier: Apache-2.0
// The page of results that are made by hand: every figure of these rows is computed beside the row.
#include "fault_metrics/metric_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;

// 9,000 bits, of which every second flip is harmful; 1,000 gates, of which every tenth event is harmful.
std::vector<ArrayResult> two_arrays() {
  StratumResult bits{CircuitPart::kWords, Element::kBit, Repeated::kColumn, 90, 9000, {}, {}};
  bits.events = {.faults = 100, .harmful = 50, .beyond = 50, .undetected = 50, .undetected_beyond = 50};
  bits.stuck = {.faults = 100, .harmful = 50, .by_self_test = 50};
  StratumResult gates{CircuitPart::kColumns, Element::kGate, Repeated::kColumn, 10, 1000, {}, {}};
  gates.events = {.faults = 100, .harmful = 10, .by_frame_check = 1, .undetected = 9};
  gates.stuck = {.faults = 100, .harmful = 80, .by_protocol = 8, .by_self_test = 70, .undetected = 2};
  ArrayResult without{
      .readout = "ezpointer", .rows = 16, .columns = 4, .clocks = 1000, .strata = {gates, bits}};
  bits.events = {.faults = 100, .harmful = 50, .beyond = 50, .by_parity = 50};
  bits.stuck = {.faults = 100, .harmful = 50, .by_parity = 50};
  gates.stuck.latent = 5;
  ArrayResult with{.readout = "ezpointer",
                   .parity = true,
                   .rows = 16,
                   .columns = 4,
                   .clocks = 1002,
                   .strata = {gates, bits}};
  return {without, with};
}

std::map<std::string, ProtectionCost> cost(double mm2) {
  return {{"ezpointer",
           {.without = {.mm2 = 1.0, .mw = 120.0, .fmax_mhz = 352.0},
            .with = {.mm2 = mm2, .mw = 123.5, .fmax_mhz = 340.0}}}};
}

std::string page(const std::vector<ArrayResult>& results, double mm2 = 1.03) {
  return page_text("fault_metrics", report_metrics(results, cost(mm2), {}, "test").page);
}

TEST(MetricReport, HasTheMetricsOfItsResults) {
  const std::string text = page(two_arrays());
  // Events: 4500 + 100 of 10,000 harmful; detected 10 of 4600 without and 4510 with parity.
  EXPECT_THAT(text, HasSubstr("| ezPointer | no     | single event | 46.00 ("));
  EXPECT_THAT(text, HasSubstr("0.22 ("));
  EXPECT_THAT(text, HasSubstr("| ezPointer | yes    | single event | 46.00 ("));
  EXPECT_THAT(text, HasSubstr("98.04 ("));
  EXPECT_THAT(text, HasSubstr("10.00 (")) << "of those in logic";
  EXPECT_THAT(text, HasSubstr("99.10 (")) << "SPFM: 1 - 90 / 10,000";
  // Stuck: 4500 + 800 harmful, 20 undetected; 50 latent.
  EXPECT_THAT(text, HasSubstr("99.62 (")) << "detected: 5280 / 5300";
  EXPECT_THAT(text, HasSubstr("99.80 (")) << "SPFM: 1 - 20 / 10,000";
  EXPECT_THAT(text, HasSubstr("99.50 (")) << "LFM: 1 - 50 / 9980";
}

TEST(MetricReport, HasTheMeansAndTheParts) {
  const std::string text = page(two_arrays());
  EXPECT_THAT(text, HasSubstr("| ezPointer | yes    | single event |          97.83 |    0.00 |     0.22 |   "
                              "      - |    1.96 |"));
  EXPECT_THAT(text, HasSubstr("| ezPointer | yes    | stuck-at     |          84.91 |    1.51 |     0.00 |   "
                              "  13.21 |    0.38 |"));
  EXPECT_THAT(text, HasSubstr("| ezPointer | no     | stuck-at     |           0.00 |    1.51 |     0.00 |   "
                              "  98.11 |    0.38 |"));
  EXPECT_THAT(text, HasSubstr("| ezPointer | gates of columns |     1000 |                     10.00 |       "
                              "10.00 |        100.00 |"
                              "                80.00 |       97.50 |        100.00 |      5.00 |"));
  EXPECT_THAT(text, HasSubstr("| ezPointer | SRAM words       |     9000 |                     50.00 |      "
                              "100.00 |          0.00 |"));
}

TEST(MetricReport, SaysWhichGoalsAreMet) {
  const std::string text = page(two_arrays());
  EXPECT_THAT(text, HasSubstr("ezPointer with parity, single event: detected harmful faults 98.04"));
  EXPECT_THAT(text, HasSubstr("Most of the others: gates of columns (100 %)"));
  EXPECT_THAT(text, HasSubstr("parity takes 3.00 % of the area, the goal is met"));
  EXPECT_THAT(page(two_arrays(), 1.05), HasSubstr("parity takes 5.00 % of the area, the goal is missed"));
  EXPECT_THAT(page_text("fault_metrics", report_metrics(two_arrays(), {}, {}, "test").page),
              HasSubstr("is not synthesised"));
  std::vector<ArrayResult> blind = two_arrays();
  blind[1].strata = blind[0].strata;  // parity that never reports
  EXPECT_THAT(page(blind), testing::ContainsRegex(
                               "single event: detected harmful faults 0.22 [^%]* %, the goal is missed;"));
}

TEST(MetricReport, HasTheCost) {
  EXPECT_THAT(page(two_arrays()),
              HasSubstr("1.000 / 1.030 |    3.00 |     120.0 / 123.5 |          352 / 340 |"
                        "                      1000 / 1002 |"));
}

TEST(MetricReport, HasEveryStratumInTheTable) {
  const std::string csv = report_metrics(two_arrays(), cost(1.03), {}, "test").csv;
  EXPECT_THAT(csv, HasSubstr("ezpointer,1,SRAM words,bits,column,event,90,9000,100,50,50,50,0,0,0,0,0,0\n"));
  EXPECT_THAT(csv, HasSubstr("ezpointer,1,columns,gates,column,stuck,10,1000,100,80,0,0,8,0,70,2,0,5\n"));
  EXPECT_THAT(csv, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace dtof
