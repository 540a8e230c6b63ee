// SPDX-License-Identifier: Apache-2.0
#include "analytic/stability.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

TEST(Stability, EveryCheckIsWithinItsLimit) {
  SCOPED_TRACE(test_seed_message());
  const auto results = check_stability(test_seed());
  EXPECT_GE(results.size(), 20U);
  for (const StabilityResult& result : results) {
    EXPECT_GT(result.cases, 0U) << result.what;
    EXPECT_TRUE(result.passed()) << result.what << ": " << result.error << " " << result.unit << ", accepted "
                                 << result.limit;
  }
}

TEST(Stability, NoLimitIsMoreThanTenTimesWhatIsObserved) {
  for (const StabilityResult& result : check_stability(1)) {
    // Random draws have limits of six standard deviations, whatever was drawn.
    if (result.unit != "standard deviations") {
      EXPECT_LE(result.limit, 10.0 * result.error)
          << result.what << ": " << result.error << " " << result.unit;
    }
  }
}

TEST(Stability, AnErrorThatIsNoNumberIsNotAccepted) {
  StabilityResult result{
      .what = "", .inputs = "", .reference = "", .cases = 1, .error = 0.0, .limit = 0.0, .unit = ""};
  EXPECT_TRUE(result.passed());
  result.error = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(result.passed());
}

}  // namespace
}  // namespace dtof
