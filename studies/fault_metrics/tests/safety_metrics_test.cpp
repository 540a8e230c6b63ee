// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/safety_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dtof {
namespace {

StratumResult stratum(Element element, double full_sites, const FaultCounts& events,
                      const FaultCounts& stuck = {}) {
  StratumResult result;
  result.element = element;
  result.full_sites = full_sites;
  result.events = events;
  result.stuck = stuck;
  return result;
}

// 10,000 bits of which half are harmful and all detected, 1,000 gates of which a tenth are harmful and a
// quarter of those detected.
ArrayResult weighted_array() {
  return {.readout = "ezpointer",
          .parity = true,
          .strata = {
              stratum(Element::kBit, 10000, {.faults = 100, .harmful = 50, .beyond = 40, .by_parity = 50},
                      {.faults = 100, .harmful = 50, .by_parity = 30, .by_self_test = 20}),
              stratum(Element::kGate, 1000,
                      {.faults = 200,
                       .harmful = 20,
                       .beyond = 10,
                       .by_frame_check = 5,
                       .undetected = 15,
                       .undetected_beyond = 10},
                      {.faults = 100, .harmful = 60, .by_self_test = 50, .undetected = 10, .latent = 9}),
          }};
}

TEST(SafetyMetrics, AreWeightedByTheElements) {
  const SafetyMetrics events = safety_metrics(weighted_array(), FaultLife::kEvent);
  EXPECT_NEAR(events.harmful.value, 5100.0 / 11000, 1e-12);
  EXPECT_NEAR(events.detected.value, 5025.0 / 5100, 1e-12);
  EXPECT_NEAR(events.in_logic.value, 25.0 / 100, 1e-12);
  EXPECT_NEAR(events.detected_beyond.value, 4000.0 / 4050, 1e-12);
  EXPECT_NEAR(events.single_point.value, 1 - 75.0 / 11000, 1e-12);
  const SafetyMetrics stuck = safety_metrics(weighted_array(), FaultLife::kStuck);
  EXPECT_NEAR(stuck.detected.value, 5500.0 / 5600, 1e-12);
  EXPECT_NEAR(stuck.in_frame.value, 3000.0 / 5600, 1e-12);
  EXPECT_NEAR(stuck.single_point.value, 1 - 100.0 / 11000, 1e-12);
  EXPECT_NEAR(stuck.latent.value, 1 - 90.0 / 10900, 1e-12);
}

// The share of one stratum alone has the interval of estimate_share.
TEST(SafetyMetrics, OfOneStratumHaveWilsonsInterval) {
  const FaultCounts counts{.faults = 100, .harmful = 20, .by_parity = 20};
  const std::vector<StratumResult> one = {stratum(Element::kBit, 700, counts)};
  const auto harmful = [](const FaultCounts& c) { return c.harmful; };
  const auto all = [](const FaultCounts& c) { return c.faults; };
  const Estimate share = weighted_share(one, FaultLife::kEvent, harmful, all);
  const Estimate expected = estimate_share(20, 100);
  EXPECT_NEAR(share.value, expected.value, 1e-12);
  EXPECT_NEAR(share.interval.low, expected.interval.low, 1e-9);
  EXPECT_NEAR(share.interval.high, expected.interval.high, 1e-9);
  const Estimate certain = weighted_share(
      one, FaultLife::kEvent, [](const FaultCounts& c) { return c.by_parity; }, harmful);
  EXPECT_DOUBLE_EQ(certain.value, 1.0);
  EXPECT_NEAR(certain.interval.low, estimate_share(20, 20).interval.low, 1e-9);
}

TEST(SafetyMetrics, WithoutAHarmfulFaultNothingIsKnown) {
  const ArrayResult none{.readout = "ezpointer",
                         .strata = {stratum(Element::kGate, 10, {.faults = 10}, {.faults = 10})}};
  const SafetyMetrics metrics = safety_metrics(none, FaultLife::kEvent);
  EXPECT_TRUE(std::isnan(metrics.detected.value));
  EXPECT_DOUBLE_EQ(metrics.single_point.value, 1.0);
}

}  // namespace
}  // namespace dtof
