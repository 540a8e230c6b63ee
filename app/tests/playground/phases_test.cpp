// SPDX-License-Identifier: Apache-2.0
#include "playground/phases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;

std::vector<ReadoutPhase> phases(Readout readout, std::uint32_t acquisitions) {
  return readout_phases(default_parameters(readout, parse_preset("thesis")), acquisitions);
}

TEST(ReadoutPhases, AreThoseOfThePages) {
  EXPECT_THAT(
      phases(Readout::kPoolPointer, 640),
      ElementsAre(ReadoutPhase{"coarse", 140}, ReadoutPhase{"track", 440}, ReadoutPhase{"pointer", 640}));
  EXPECT_THAT(
      phases(Readout::kPoolPointerLean, 640),
      ElementsAre(ReadoutPhase{"coarse", 140}, ReadoutPhase{"track", 340}, ReadoutPhase{"pointer", 640}));
  EXPECT_THAT(phases(Readout::kHisPointer, 3333),
              ElementsAre(ReadoutPhase{"histogram", 1666}, ReadoutPhase{"pointer", 3333}));
  EXPECT_THAT(phases(Readout::kThreeSteps, 600),
              ElementsAre(ReadoutPhase{"step 1", 100}, ReadoutPhase{"step 2", 200},
                          ReadoutPhase{"step 3", 300}, ReadoutPhase{"fine histogram", 600}));
  EXPECT_EQ(phases(Readout::kPifh, 1600).size(), 16U);
  EXPECT_EQ(phases(Readout::kPifh, 1600).front(), (ReadoutPhase{"run 1", 100}));
}

TEST(ReadoutPhases, FillTheFrameForEveryReadout) {
  for (const Readout readout : kAllReadouts) {
    for (const std::uint32_t acquisitions : {1U, 7U, 3333U}) {
      SCOPED_TRACE(std::string(readout_name(readout)));
      const std::vector<ReadoutPhase> found = phases(readout, acquisitions);
      ASSERT_FALSE(found.empty());
      EXPECT_TRUE(std::ranges::is_sorted(found, {}, &ReadoutPhase::end));
      EXPECT_EQ(found.back().end, acquisitions);
    }
  }
}

}  // namespace
}  // namespace dtof
