// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/depth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const DepthScale& thesis_scale() {
  static const DepthScale scale(45e-9, 10, 2e-9);
  return scale;
}

TEST(CodePosition, FractionIsInUnitsOfItsLastBit) {
  EXPECT_EQ(code_position({.code = 5}, 0), 5.0);
  EXPECT_EQ(code_position({.code = 5, .fraction = 3}, 2), 5.75);
  EXPECT_EQ(code_position({.code = 1023, .fraction = 63}, 6), 1023.984375);
}

TEST(DepthScale, Equation311ByHand) {
  // 45 ns / 1024 = 43.9453125 ps; (195 + 0.5) bins are 8.59130859375 ns, less 2 ns, times c/2.
  EXPECT_NEAR(thesis_scale().depth(195), 0.149896229 * 6.59130859375, 1e-12);
  EXPECT_NEAR(thesis_scale().bin_depth(), 0.149896229 * 0.0439453125, 1e-15);
}

TEST(DepthScale, TargetAtOneMetreIsFoundWhereThePulseArrives) {
  const double arrival_s = 2.0 * 1.0 / 299792458.0 + 2e-9;
  const double bin = arrival_s / (45e-9 / 1024) - 0.5;
  EXPECT_NEAR(thesis_scale().position(1.0), bin, 1e-9);
  EXPECT_NEAR(thesis_scale().depth(bin), 1.0, 1e-12);
}

TEST(DepthScale, InverseOverTheWholeRange) {
  for (double position = -10.0; position < 1100.0; position += 0.37) {
    EXPECT_NEAR(thesis_scale().position(thesis_scale().depth(position)), position, 1e-10);
  }
}

TEST(DepthScale, CodesBeforeThePulseAreNegative) { EXPECT_LT(thesis_scale().depth(0), 0.0); }

TEST(DepthScale, RefusesImpossiblePhysics) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](double time, int np, double fwhm, const char* message) {
    EXPECT_THAT([=] { DepthScale(time, np, fwhm); }, ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refuses(0.0, 10, 2e-9, "integration time is 0 s");
  refuses(nan, 10, 2e-9, "integration time is nan s");
  refuses(45e-9, 10, -1.0, "pulse FWHM is -1 s");
  refuses(45e-9, 10, nan, "pulse FWHM is nan s");
  refuses(45e-9, 0, 2e-9, "NP is 0");
  refuses(45e-9, 17, 2e-9, "NP is 17");
}

}  // namespace
}  // namespace dtof
