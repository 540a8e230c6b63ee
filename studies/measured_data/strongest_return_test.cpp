// SPDX-License-Identifier: Apache-2.0
#include "measured_data/strongest_return.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace dtof {
namespace {

constexpr double kWindow = 2e-9;
constexpr double kSpan = 100e-9;

/// One event at each of these times in ns.
std::vector<TimedEvents> at(std::vector<double> times_ns) {
  std::ranges::sort(times_ns);
  std::vector<TimedEvents> events;
  for (const double time : times_ns) {
    events.push_back({time * 1e-9, 1.0});
  }
  return events;
}

TEST(StrongestReturn, IsTheMeanOfTheFullestWindow) {
  // Six events within 2 ns of 30 ns, four near 60 ns, two alone.
  const auto events = at({10, 30, 30.2, 30.4, 30.6, 31, 31.8, 60, 60.1, 60.2, 60.3, 90});
  EXPECT_NEAR(strongest_return(events, kWindow, kSpan).value(), (30 + 30.2 + 30.4 + 30.6 + 31 + 31.8) / 6e9,
              1e-18);
  EXPECT_NEAR(strongest_return(events, 0.35e-9, kSpan).value(), 60.15e-9, 1e-18) << "a shorter window";
}

TEST(StrongestReturn, CountsTheEventsOfABin) {
  const std::vector<TimedEvents> bins = {
      {10e-9, 5.0}, {11e-9, 20.0}, {12e-9, 60.0}, {13e-9, 0.0}, {50e-9, 70.0}};
  EXPECT_NEAR(strongest_return(bins, kWindow, kSpan).value(), (11 * 20 + 12 * 60) / 80e9, 1e-18);
  EXPECT_NEAR(strongest_return(bins, 1e-10, kSpan).value(), 50e-9, 1e-18);
}

TEST(StrongestReturn, IsTheEarliestOfEqualOnes) {
  EXPECT_NEAR(strongest_return(at({20, 20, 20, 20, 20, 70, 70, 70, 70, 70}), kWindow, kSpan).value(), 20e-9,
              1e-18);
}

TEST(StrongestReturn, IsNoneIfChanceExplainsIt) {
  EXPECT_FALSE(strongest_return({}, kWindow, kSpan));
  EXPECT_FALSE(strongest_return(at({42}), kWindow, kSpan)) << "a single event may be anything";
  EXPECT_FALSE(strongest_return(at({42, 42.1}), kWindow, kSpan));
  EXPECT_FALSE(strongest_return(at({1, 2, 3, 4, 5, 6, 7}), kWindow, 1.5e-9))
      << "nothing is outside of a window";
  // Chernoff's bound by hand. Four events in the window and none outside: a mean of 1 * 2 / 98, so that
  // ln P <= 4 - 0.0204 - 4 ln(4 / 0.0204) = -17.13, four windows add ln 4 = 1.39, and ln 1e-3 = -6.91.
  EXPECT_TRUE(strongest_return(at({42, 42.1, 42.2, 42.3}), kWindow, kSpan));
  // With 20 events outside the mean is 21 * 2 / 98 = 0.429: ln P <= 4 - 0.429 - 4 ln(4 / 0.429) = -5.36.
  std::vector<double> more = {42, 42.1, 42.2, 42.3};
  for (int i = 0; i < 20; ++i) {
    more.push_back(45.0 + 2.7 * i);
  }
  EXPECT_FALSE(strongest_return(at(more), kWindow, kSpan));
}

TEST(StrongestReturn, OfEvenPhotonsIsAsRareAsPromised) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> even(0.0, kSpan * 1e9);
  int found = 0;
  for (int pixel = 0; pixel < 2000; ++pixel) {
    std::vector<double> times(static_cast<std::size_t>(5 + pixel % 200));
    std::ranges::generate(times, [&] { return even(random); });
    found += strongest_return(at(times), kWindow, kSpan) ? 1 : 0;
  }
  EXPECT_LE(found, 6) << "2 are promised";
}

}  // namespace
}  // namespace dtof
