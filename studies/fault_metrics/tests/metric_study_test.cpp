// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/metric_study.hpp"

#include <gtest/gtest.h>

#include "dtof/core/error.hpp"
#include "fault_metrics/tests/fake_array.hpp"

namespace dtof {
namespace {

FaultCounts counted(const FrameOutcome& frame, const FrameOutcome* self_test = nullptr) {
  FaultCounts counts;
  count_fault(counts, frame, self_test);
  return counts;
}

TEST(MetricStudy, CountsAFaultForTheFirstMeansThatDetectsIt) {
  EXPECT_EQ(counted({}), (FaultCounts{.faults = 1}));
  EXPECT_EQ(counted({.parity_error = true}), (FaultCounts{.faults = 1})) << "harmless";
  EXPECT_EQ(counted({.wrong_result = true}), (FaultCounts{.faults = 1, .harmful = 1, .undetected = 1}));
  EXPECT_EQ(counted({.wrong_result = true, .beyond = true}),
            (FaultCounts{.faults = 1, .harmful = 1, .beyond = 1, .undetected = 1, .undetected_beyond = 1}));
  EXPECT_EQ(counted({.wrong_result = true, .parity_error = true, .protocol_error = true}),
            (FaultCounts{.faults = 1, .harmful = 1, .by_parity = 1}));
  EXPECT_EQ(counted({.endless = true, .protocol_error = true}),
            (FaultCounts{.faults = 1, .harmful = 1, .by_protocol = 1}));
  EXPECT_EQ(counted({.wrong_count = true}), (FaultCounts{.faults = 1, .harmful = 1, .by_frame_check = 1}));
  EXPECT_EQ(counted({.endless = true}), (FaultCounts{.faults = 1, .harmful = 1, .by_frame_check = 1}));
}

TEST(MetricStudy, TheSelfTestDetectsFaultsThatAreStillThere) {
  const FrameOutcome wrong{.wrong_result = true};
  const FrameOutcome good;
  const FrameOutcome reported{.parity_error = true};
  const FaultCounts undetected{.faults = 1, .harmful = 1, .undetected = 1};
  const FaultCounts found{.faults = 1, .harmful = 1, .by_self_test = 1};
  EXPECT_EQ(counted(wrong, nullptr), undetected);
  EXPECT_EQ(counted(wrong, &good), undetected);
  EXPECT_EQ(counted(wrong, &wrong), found);
  EXPECT_EQ(counted(wrong, &reported), found);
  EXPECT_TRUE(stays_unseen(good, good));
  EXPECT_FALSE(stays_unseen(good, wrong) || stays_unseen(good, reported) || stays_unseen(wrong, good) ||
               stays_unseen(reported, good));
}

TEST(MetricStudy, RefusesAnArrayThatIsNotItsModel) {
  const FakeArray fake;
  EXPECT_THROW((void)study_netlist(fake.netlist, {.acquisitions = 20, .faults = 5}), InputError);
  EXPECT_THROW((void)study_netlist(fake.netlist, {.acquisitions = 20, .faults = 0}), InputError);
  EXPECT_THROW((void)study_inputs(fake.netlist, 1, 1), InputError);
  EXPECT_THROW((void)study_inputs(fake.netlist, 65536, 1), InputError);
}

}  // namespace
}  // namespace dtof
