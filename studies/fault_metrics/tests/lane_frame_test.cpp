// SPDX-License-Identifier: Apache-2.0
// The outcome of faults whose effect follows from the drawing of the fake array.
#include "fault_metrics/lane_frame.hpp"

#include <gtest/gtest.h>

#include "dtof/core/error.hpp"
#include "fault_metrics/tests/fake_array.hpp"

namespace dtof {
namespace {

constexpr Timestamp kResult = 500;
constexpr std::uint64_t kAfterLoad = 5;  // the result is on the port
constexpr std::uint64_t kClocks = 6;     // start, three lines, a clock without a line, result; then done

class LaneFrame : public testing::Test {
 protected:
  FrameOutcome outcome(std::uint32_t flip_flop, FaultAction action, std::uint64_t clock = 0) {
    const CircuitFault fault{{SiteKind::kFlipFlop, flip_flop, 0}, action, clock};
    const std::size_t lane = 77;
    const std::vector<LaneFault> faults = {{lane, fault}};
    const std::vector<FrameOutcome> outcomes = run_lanes(array_.netlist, input_, reference_, faults, 1);
    for (std::size_t i = 0; i < kLanes; ++i) {
      EXPECT_TRUE(i == lane || outcomes[i] == FrameOutcome()) << "lane " << i << " has no fault";
    }
    return outcomes[lane];
  }

  FakeArray array_;
  FrameInput input_ = fake_frame(kResult);
  FrameReference reference_ = run_reference(array_.netlist, input_, 1);
};

TEST_F(LaneFrame, TheReferenceIsTheXorOfTheTimestamps) {
  EXPECT_EQ(reference_.clocks, kClocks);
  ASSERT_EQ(reference_.results.size(), 1U);
  EXPECT_EQ(reference_results(array_.netlist, reference_).front().code, kResult);
}

TEST_F(LaneFrame, AFlippedBitOfAResultIsHarmfulAndFoundByItsParity) {
  EXPECT_EQ(outcome(array_.data + 9, FaultAction::kFlip, kAfterLoad),
            (FrameOutcome{.wrong_result = true, .beyond = true, .parity_error = true}));
  // One code of 500 is no more than 3 %.
  EXPECT_EQ(outcome(array_.data, FaultAction::kFlip, kAfterLoad),
            (FrameOutcome{.wrong_result = true, .parity_error = true}));
}

TEST_F(LaneFrame, AFlipAfterTheResultIsHarmless) {
  EXPECT_EQ(outcome(array_.data + 9, FaultAction::kFlip, kClocks), FrameOutcome());
}

TEST_F(LaneFrame, AFlipBetweenTheLinesIsKept) {
  EXPECT_EQ(outcome(array_.data + 9, FaultAction::kFlip, 2),
            (FrameOutcome{.wrong_result = true, .beyond = true, .parity_error = true}));
}

// The array takes its first line a clock early, and every line once.
TEST_F(LaneFrame, TheSourceFollowsTheArrayOfEachLane) {
  EXPECT_EQ(outcome(array_.ready, FaultAction::kFlip, 0), FrameOutcome());
}

// Bits of 500 = 0b0111110100.
TEST_F(LaneFrame, AStuckBitIsStuckInEveryClock) {
  EXPECT_EQ(outcome(array_.data + 2, FaultAction::kStuckHigh), FrameOutcome());
  EXPECT_TRUE(outcome(array_.data + 2, FaultAction::kStuckLow).wrong_result);
  EXPECT_TRUE(outcome(array_.data, FaultAction::kStuckHigh).wrong_result);
}

TEST_F(LaneFrame, AFlippedParityBitIsHarmlessButReported) {
  const FrameOutcome flipped = outcome(array_.parity, FaultAction::kFlip, kAfterLoad);
  EXPECT_FALSE(flipped.harmful());
  EXPECT_TRUE(flipped.parity_error);
}

TEST_F(LaneFrame, AnotherAddressIsFoundByTheReceiver) {
  const FrameOutcome moved = outcome(array_.column, FaultAction::kFlip, kAfterLoad);
  EXPECT_EQ(moved, (FrameOutcome{.wrong_result = true, .beyond = true, .wrong_order = true}));
  EXPECT_TRUE(moved.detected());
}

TEST_F(LaneFrame, AMissingOrSurplusResultIsFoundByTheReceiver) {
  const FrameOutcome missing = outcome(array_.valid, FaultAction::kFlip, kAfterLoad);
  EXPECT_TRUE(missing.wrong_count && missing.harmful() && missing.detected());
  EXPECT_TRUE(outcome(array_.valid, FaultAction::kStuckHigh).wrong_count) << "a result in two clocks";
  // The result of a line before, and the end of the frame with it.
  EXPECT_EQ(outcome(array_.valid, FaultAction::kFlip, 3),
            (FrameOutcome{.wrong_result = true, .beyond = true}));
}

TEST_F(LaneFrame, AFrameWithoutAnEndIsFoundByTheReceiver) {
  const FrameOutcome endless = outcome(array_.done, FaultAction::kStuckLow);
  EXPECT_TRUE(endless.endless && endless.harmful() && endless.detected());
  EXPECT_FALSE(endless.wrong_result);
  EXPECT_TRUE(outcome(array_.busy, FaultAction::kStuckHigh).endless) << "busy after done";
}

TEST_F(LaneFrame, AnErrorOutputIsAnErrorOfTheProtocol) {
  EXPECT_EQ(outcome(array_.error, FaultAction::kFlip, 3), (FrameOutcome{.protocol_error = true}));
}

TEST_F(LaneFrame, AReferenceWithAnErrorIsRefused) {
  array_.netlist.ports["parity_error_o"] = {kHigh};
  EXPECT_THROW((void)run_reference(array_.netlist, input_, 1), InputError);
}

TEST_F(LaneFrame, AnotherReferenceIsRefused) {
  reference_.results.front() ^= 1U;
  EXPECT_THROW((void)run_lanes(array_.netlist, input_, reference_, {}, 1), InputError);
}

}  // namespace
}  // namespace dtof
