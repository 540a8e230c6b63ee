// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/frame_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace dtof {
namespace {

using ::testing::HasSubstr;

TEST(FrameTime, IsThatOfTheThesissArray) {
  // As the RTL takes for a frame of the room (reports/frame/summary.md); other arrays are in random/.
  const auto clocks = [](Readout readout) {
    return predicted_frame_clocks(ReadoutParameters::defaults(readout), 160, 200, 3333);
  };
  EXPECT_EQ(clocks(Readout::kEzPointer), 1'112'812U);
  EXPECT_EQ(clocks(Readout::kHisPointer), 1'122'904U);
  EXPECT_EQ(clocks(Readout::kSifh), 1'133'207U);
  EXPECT_EQ(clocks(Readout::kPifh), 1'276'735U);
  EXPECT_EQ(clocks(Readout::kCoarseHistogram), 1'117'814U);
  EXPECT_EQ(clocks(Readout::kPoolPointer), 1'391'801U);
  EXPECT_EQ(clocks(Readout::kPoolPointerLean), 1'399'585U);
  // A first histogram with more bins than the last: as drawn by make random-configurations SEED=20261126
  // FIRST=4.
  ReadoutParameters fifh = ReadoutParameters::defaults(Readout::kFifh, 16);
  fifh.nb = 10;
  fifh.slots = 4;
  EXPECT_EQ(predicted_frame_clocks(fifh, 7, 1, 43), 16'056U);
}

/// The number before `unit` in a sentence.
double number_before(const std::string& text, const std::string& unit) {
  const std::size_t end = text.rfind(unit);
  const std::size_t begin = text.rfind(' ', end - 1);
  return end == std::string::npos ? -1.0 : std::stod(text.substr(begin + 1, end - begin - 1));
}

TEST(FrameFit, SaysWhatWouldFit) {
  const FrameBudget budget{.clock_hz = 330e6, .frames_per_s = 30.0};
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh);
  EXPECT_TRUE(frame_fit(parameters, 160, 200, 33'333, budget).fits);
  const FrameFit fit = frame_fit(parameters, 160, 200, 50'000, budget);
  EXPECT_FALSE(fit.fits);
  EXPECT_EQ(fit.clocks, predicted_frame_clocks(parameters, 160, 200, 50'000));
  const auto again = [&](std::uint32_t acquisitions, const FrameBudget& other) {
    return frame_fit(parameters, 160, 200, acquisitions, other).fits;
  };
  // Each way fits, and a little less of the way does not.
  const std::string ways = fit.sentence.substr(fit.sentence.find("one of:"));
  const auto acquisitions = static_cast<std::uint32_t>(number_before(ways, " acquisitions"));
  EXPECT_TRUE(again(acquisitions, budget));
  EXPECT_FALSE(again(acquisitions + 1, budget));
  const double mhz = number_before(ways, " MHz");
  EXPECT_TRUE(again(50'000, {.clock_hz = mhz * 1e6, .frames_per_s = 30.0}));
  EXPECT_FALSE(again(50'000, {.clock_hz = (mhz - 0.1) * 1e6, .frames_per_s = 30.0}));
  const double rate = number_before(ways, " frames/s");
  EXPECT_TRUE(again(50'000, {.clock_hz = 330e6, .frames_per_s = rate}));
  EXPECT_FALSE(again(50'000, {.clock_hz = 330e6, .frames_per_s = rate + 0.01}));
  EXPECT_THAT(ways, HasSubstr("SLOTS = 1, 2 arrays of 80 rows."));
  parameters.slots = 1;
  EXPECT_TRUE(again(50'000, budget));
}

// More engines, of fewer columns each, leave more of the frame for acquisitions.
TEST(FrameFit, SaysHowManyColumnsAnEngineMayHave) {
  const FrameBudget budget{.clock_hz = 330e6, .frames_per_s = 30.0};
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
  EXPECT_TRUE(frame_fit(parameters, 160, 200, 33'333, budget).fits);
  parameters.pool.engine_columns = 100;
  const FrameFit fit = frame_fit(parameters, 160, 200, 33'333, budget);
  EXPECT_FALSE(fit.fits);
  const std::size_t at = fit.sentence.find("ENGINE_COLUMNS = ");
  ASSERT_NE(at, std::string::npos) << fit.sentence;
  const int columns = std::stoi(fit.sentence.substr(at + 17));
  const auto fits = [&](int width) {
    parameters.pool.engine_columns = width;
    return frame_fit(parameters, 160, 200, 33'333, budget).fits;
  };
  EXPECT_TRUE(fits(columns));
  EXPECT_FALSE(fits(columns + 2));
  EXPECT_THAT(frame_fit(ReadoutParameters::defaults(Readout::kSifh), 160, 200, 50'000, budget).sentence,
              testing::Not(HasSubstr("ENGINE_COLUMNS")));
}

TEST(FrameFit, OffersNoWayThatDoesNotFit) {
  const FrameFit fit = frame_fit(ReadoutParameters::defaults(Readout::kHistogram), 160, 200, 10,
                                 {.clock_hz = 1e6, .frames_per_s = 30.0});
  EXPECT_FALSE(fit.fits);
  EXPECT_THAT(fit.sentence, testing::Not(HasSubstr("acquisitions,")));
  EXPECT_THAT(fit.sentence, testing::Not(HasSubstr("SLOTS")));
}

}  // namespace
}  // namespace dtof
