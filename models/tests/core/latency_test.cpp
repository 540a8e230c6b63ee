// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/latency.hpp"

#include <gtest/gtest.h>

#include "dtof/core/frame_time.hpp"

namespace dtof {
namespace {

// The RTL of all small arrays is compared in tb_cpp/tests/rtl/frame_clocks_test.cpp.
TEST(Latency, OfOneMeasurementIsTheFrameBehindItsTimestamps) {
  for (const Readout readout : {Readout::kEzPointer, Readout::kHistogram, Readout::kCoarseHistogram}) {
    const ReadoutParameters parameters = ReadoutParameters::defaults(readout);
    constexpr std::uint64_t kLines = 160 * 2;
    const std::uint64_t words = readout == Readout::kEzPointer   ? 1
                                : readout == Readout::kHistogram ? 1024
                                                                 : 32;
    // start_i, the clear of every word, and the acquisitions with a line's delay.
    const std::uint64_t start = 2 + 160 * words + 2 + 100 * kLines + 2;
    EXPECT_EQ(predicted_latency_clocks(parameters, 160, 200),
              predicted_frame_clocks(parameters, 160, 200, 100) - start)
        << readout_name(readout);
  }
}

// At 330 MHz: 0.14 ms for the columns, whose results leave one after the other, 0.22 and 0.30 ms for
// poolPointer.
TEST(Latency, IsThatOfTheLastMeasurementAlone) {
  const auto latency = [](Readout readout) {
    return predicted_latency_clocks(ReadoutParameters::defaults(readout), 160, 200);
  };
  EXPECT_EQ(latency(Readout::kHisPointer), latency(Readout::kEzPointer));
  EXPECT_EQ(latency(Readout::kHisPointer1), latency(Readout::kEzPointer));
  EXPECT_EQ(latency(Readout::kSifh), latency(Readout::kPifh)) << "32 bins each";
  EXPECT_LT(latency(Readout::kThreeSteps), latency(Readout::kSifh)) << "16 bins";
  EXPECT_LT(latency(Readout::kSifh), latency(Readout::kHistogram)) << "1024 bins";
  EXPECT_EQ(latency(Readout::kEzPointer), 46'086U);
  EXPECT_EQ(latency(Readout::kSifh), 46'149U);
  EXPECT_EQ(latency(Readout::kPoolPointer), 71'749U);
  EXPECT_EQ(latency(Readout::kPoolPointerLean), 98'719U);
}

}  // namespace
}  // namespace dtof
