// SPDX-License-Identifier: Apache-2.0
// Reset at random moments, back-pressure and pauses on full-size arrays, one of each read-out.
#include <gtest/gtest.h>

#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

class Disturbance : public testing::TestWithParam<Readout> {
 protected:
  static RtlConfiguration full_size(const ReadoutParameters& parameters) {
    constexpr int kEngine = 10;  // columns of poolPointer's that the tests have
    return find_rtl_configuration(parameters, 160, parameters.columns_together() > 1 ? kEngine : 200);
  }
  RtlConfiguration configuration_ = full_size(ReadoutParameters::defaults(GetParam()));
};

INSTANTIATE_TEST_SUITE_P(FullSize, Disturbance, testing::ValuesIn(full_size_readouts()), readout_test_name);

TEST_P(Disturbance, ResetAtRandomMoments) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 10);
  constexpr std::uint32_t kAcquisitions = 21;
  const std::vector<ColumnStream> columns = adversarial_columns(configuration_, kAcquisitions, 0, random);
  RtlReadout rtl(configuration_);
  RtlFrame frame;
  RtlRunOptions options = default_options(test_seed());
  ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, options, &frame));
  const std::uint64_t cycles = frame.statistics.cycles;
  options.reset_first = false;
  for (int i = 0; i < 4; ++i) {
    options.reset_at = 1 + random.bits64() % cycles;
    SCOPED_TRACE(testing::Message() << "reset in clock " << *options.reset_at);
    ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, options, &frame));
    EXPECT_EQ(frame.statistics.cycles, cycles) << "a frame after a reset takes as long as any";
  }
}

TEST_P(Disturbance, NoDataIsLostUnderBackPressure) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random = test_random(test_seed(), 11);
  constexpr std::uint32_t kAcquisitions = 60;
  const std::vector<ColumnStream> columns = adversarial_columns(configuration_, kAcquisitions, 3, random);
  RtlReadout rtl(configuration_);
  RtlRunOptions options = default_options(random.bits64());
  options.pause_probability = 0.5;
  options.stall_probability = 0.95;
  options.start_probability = 0.5;
  ASSERT_TRUE(agrees_with_model(rtl, columns, kAcquisitions, options));
}

}  // namespace
}  // namespace dtof
