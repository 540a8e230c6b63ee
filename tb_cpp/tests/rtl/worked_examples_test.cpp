// SPDX-License-Identifier: Apache-2.0
// The thesis's worked examples, word by word in the SRAM and state by state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <map>

#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;

// Clocks from the control to the columns: BROADCAST_STAGES of the models here.
constexpr std::size_t kWayClocks = 2;

// Follows a frame: the states in order, and the SRAM as it stands when a state ends, as the columns receive
// the state.
class Follower {
 public:
  void operator()(const RtlCycle& clock) {
    if (states_.empty() || states_.back() != clock.state) {
      states_.push_back(clock.state);
    }
    on_the_way_.push_back(clock.state);
    if (on_the_way_.size() > kWayClocks + 1) {
      on_the_way_.pop_front();
    }
    const RtlState in_columns = on_the_way_.front();
    if (clock.sram_write) {
      memory_[clock.sram_address] = clock.sram_data;
      writes_[in_columns].push_back(clock.sram_data);
    }
    at_end_of_[in_columns] = memory_;
  }

  using Memory = std::map<int, int>;
  std::vector<RtlState> states_;
  std::map<RtlState, Memory> at_end_of_;
  std::map<RtlState, std::vector<int>> writes_;  // data, in order

 private:
  Memory memory_;
  std::deque<RtlState> on_the_way_;
};

// Tables 3 and 4, Fig. 4.13 and 4.14: NP = 4, NB = 3, one pixel, two slots. 15 is "no detection".
TEST(WorkedExamples, SifhOfTables3And4StateByState) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 4);
  parameters.count_width = 4;
  ASSERT_EQ(parameters.nb, 3);
  RtlReadout rtl(find_rtl_configuration(parameters, 1, 1));
  Follower follower;
  RtlRunOptions options = default_options(1);
  options.observer = std::ref(follower);
  const std::vector<ColumnStream> columns = {
      single_pixel({11, 9, 11, 15, /* measurement 2 */ 10, 10, 15, 11}, 2)};
  RtlFrame frame;
  ASSERT_TRUE(agrees_with_model(rtl, columns, 4, options, &frame));

  using enum RtlState;
  EXPECT_THAT(follower.states_, ElementsAre(kIdle, kReset, kM0, kM1, kM2, kM3, kM4, kM5, kIdle));

  // RESET clears the 8 bins one address per clock.
  using Memory = Follower::Memory;
  const Memory cleared = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}, {6, 0}, {7, 0}};
  EXPECT_EQ(follower.at_end_of_[kReset], cleared);
  EXPECT_EQ(follower.writes_[kReset].size(), 8U);

  // BUILD_HIS1 counts 11 -> bin 5, 9 -> bin 4, 11 -> bin 5; 15 is dropped (Fig. 4.13 a).
  Memory coarse = cleared;
  coarse[4] = 1;
  coarse[5] = 2;
  EXPECT_EQ(follower.at_end_of_[kM0], coarse);
  EXPECT_THAT(follower.writes_[kM0], ElementsAre(1, 1, 2));

  // FIND_PEAK_HIS1 leaves a cleared SRAM for the second histogram.
  EXPECT_EQ(follower.at_end_of_[kM1], cleared);

  // The peak is 5, the window 6 < x <= 14: 10 -> bin 3 twice, 11 -> bin 4 (Fig. 4.14 a).
  Memory fine = cleared;
  fine[3] = 2;
  fine[4] = 1;
  EXPECT_EQ(follower.at_end_of_[kM3], fine);
  EXPECT_THAT(follower.writes_[kM3], ElementsAre(1, 2, 1));

  // The fine peak is bin 3: 6 + 3 + 1.
  EXPECT_EQ(frame.results.at(0).code, 10);
}

// Fig. 3.7: the pointer stands at 7; 11 moves it to 8, 9 to 9, 15 is no detection. A first timestamp of 7
// brings it from its start, 8, to 7.
TEST(WorkedExamples, EzPointerOfFigure37) {
  RtlReadout rtl(find_rtl_configuration(ReadoutParameters::defaults(Readout::kEzPointer, 4), 1, 1));
  struct Step {
    std::vector<Timestamp> timestamps;
    int pointer;
  };
  const std::vector<Step> steps = {{{}, 8}, {{7}, 7}, {{7, 11}, 8}, {{7, 11, 9}, 9}, {{7, 11, 9, 15}, 9}};
  for (const Step& step : steps) {
    const auto acquisitions = static_cast<std::uint32_t>((step.timestamps.size() + 1) / 2);
    const std::vector<ColumnStream> columns = {single_pixel(step.timestamps, 2)};
    Follower follower;
    RtlRunOptions options = default_options(1);
    options.observer = std::ref(follower);
    RtlFrame frame;
    ASSERT_TRUE(agrees_with_model(rtl, columns, acquisitions, options, &frame));
    EXPECT_EQ(frame.results.at(0).code, step.pointer);

    using enum RtlState;  // Fig. 4.3: IDLE, RESET, EXECUTE, RESULT
    EXPECT_THAT(follower.states_, ElementsAre(kIdle, kReset, kM3, kM4, kM5, kIdle));
    // One read-modify-write an acquisition, whatever its slots hold.
    EXPECT_EQ(follower.writes_[kM3].size(), acquisitions);
  }
}

}  // namespace
}  // namespace dtof
