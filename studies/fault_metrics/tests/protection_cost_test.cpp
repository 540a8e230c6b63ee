// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/protection_cost.hpp"

#include <gtest/gtest.h>

#include "dtof/core/error.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

class ProtectionCostTest : public test::IoTest {
 protected:
  void write_reports() const {
    (void)write("area.csv",
                "configuration,readout,total_mm2\nezpointer,ezpointer,1.25\nezpointer_parity,ezpointer,1.3\n"
                "sifh,sifh,15\n");
    (void)write("timing.csv",
                "configuration,corner,fmax_mhz,logic_mw,sram_mw,clock_mw\n"
                "ezpointer,slow,352,,,\nezpointer,typical,1000,30,40,50\n"
                "ezpointer_parity,slow,340.5,,,\nezpointer_parity,typical,990,31,42,53\n");
  }
};

TEST_F(ProtectionCostTest, IsTheDifferenceOfTwoConfigurations) {
  write_reports();
  const auto cost = protection_cost(path("."), "ezpointer");
  ASSERT_TRUE(cost.has_value());
  EXPECT_DOUBLE_EQ(cost->with.mm2, 1.3);
  EXPECT_DOUBLE_EQ(cost->without.mw, 120.0);
  EXPECT_DOUBLE_EQ(cost->with.mw, 126.0);
  EXPECT_DOUBLE_EQ(cost->with.fmax_mhz, 340.5);
  EXPECT_NEAR(cost->area_share(), 0.04, 1e-12);
}

TEST_F(ProtectionCostTest, OfAConfigurationThatIsNotSynthesisedIsNone) {
  write_reports();
  EXPECT_FALSE(protection_cost(path("."), "sifh").has_value());
  EXPECT_THROW((void)protection_cost(path("absent"), "sifh"), InputError);
}

}  // namespace
}  // namespace dtof
