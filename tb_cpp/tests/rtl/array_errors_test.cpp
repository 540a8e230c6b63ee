// SPDX-License-Identifier: Apache-2.0
// error_o of every kind of array, clock by clock, while a master breaks the rules. The harness checks in
// every run that it is silent otherwise, and that it tells of a start while busy.
#include <gtest/gtest.h>
#include <verilated.h>

#include <algorithm>
#include <array>
#include <memory>

#include "rtl/registry.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

// The smallest array with several pixels: a gap needs an acquisition of more than one clock.
RtlConfiguration smallest_array() {
  std::vector<RtlConfiguration> all = compiled_rtl_configurations();
  const auto size = [](const RtlConfiguration& configuration) {
    const int pixels = configuration.pixels_per_sram * configuration.sram_num;
    return configuration.pixels_per_sram < 2 ? 1'000'000 : pixels;
  };
  return *std::ranges::min_element(all, {}, size);
}

// An array whose assertions are off, so that it lives on after what they forbid.
class ArrayErrors : public testing::Test {
 protected:
  void SetUp() override {
    Verilated::threadContextp(&context_);
    std::array<const char*, 1> arguments = {"test"};
    context_.commandArgs(1, arguments.data());
    context_.assertOn(false);
    model_ = make_array_model(smallest_array(), context_);
    ports_ = model_->ports();
    *ports_.reset_n = 0;
    *ports_.start = 0;
    *ports_.tdc_valid = 0;
    *ports_.result_ready = 1;
    *ports_.acquisitions = 4;
    if (ports_.coarse_end != nullptr) {
      *ports_.coarse_end = 1;
      *ports_.track_end = 2;
    }
    clock();
    *ports_.reset_n = 1;
    clock();
  }

  void settle() {
    *ports_.clock = 0;
    model_->eval();
  }
  void clock() {
    settle();
    *ports_.clock = 1;
    model_->eval();
  }
  // error_o of this clock.
  int error() {
    settle();
    return *ports_.error;
  }
  void start() {
    *ports_.start = 1;
    clock();
    *ports_.start = 0;
  }
  // To the clock in which the first acquisition may begin.
  void wait_for_acquisition() {
    for (int i = 0; i < 10'000 && *ports_.tdc_ready == 0; ++i) {
      clock();
      settle();
    }
    ASSERT_NE(*ports_.tdc_ready, 0);
  }

  VerilatedContext context_;
  std::unique_ptr<ArrayModel> model_;
  ArrayModel::Ports ports_{};
};

TEST_F(ArrayErrors, StartWhileBusy) {
  start();
  EXPECT_EQ(error(), 0);
  start();
  EXPECT_EQ(error(), kRtlStartIgnored);
  clock();
  EXPECT_EQ(error(), 0);
}

TEST_F(ArrayErrors, GapInsideAnAcquisition) {
  start();
  wait_for_acquisition();
  clock();  // no acquisition begins without a valid line: that is no gap
  EXPECT_EQ(error(), 0);
  wait_for_acquisition();
  *ports_.tdc_valid = 1;
  clock();
  *ports_.tdc_valid = 0;
  clock();
  EXPECT_EQ(error(), kRtlUnderrun);
  *ports_.tdc_valid = 1;
  clock();
  EXPECT_EQ(error(), 0);
}

TEST_F(ArrayErrors, ScheduleOutOfOrder) {
  if (ports_.coarse_end == nullptr) {
    GTEST_SKIP() << "dtof_array has no schedule";
  }
  *ports_.coarse_end = 3;
  start();
  clock();
  EXPECT_EQ(error(), kRtlIllegalSchedule);
  clock();
  EXPECT_EQ(error(), 0);
}

TEST_F(ArrayErrors, RowsOfARawFrameOutOfOrder) {
  if (ports_.raw == nullptr || !smallest_array().raw_histogram) {
    GTEST_SKIP() << "the array sends no histograms";
  }
  *ports_.raw = 1;
  *ports_.raw_first_row = 1;
  *ports_.raw_last_row = 0;
  start();
  EXPECT_EQ(error(), kRtlIllegalSchedule);
  clock();
  EXPECT_EQ(error(), 0);
}

}  // namespace
}  // namespace dtof
