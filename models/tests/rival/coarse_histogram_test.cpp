// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/coarse_histogram.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "dtof/core/error.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

SensorModel four_bits() {
  SensorModel sensor;
  sensor.np = 4;
  sensor.pulse_fwhm_s = 8e-9;  // of 45 ns: 2.8 codes
  return sensor;
}

TEST(CoarseHistogram, CountsTheUpperBitsAndDropsNoDetection) {
  const std::unique_ptr<Rival> rival = make_coarse_histogram(four_bits(), {.bin_bits = 2});
  const std::vector<Detection> detections = one_each(std::array{0, 3, 4, 8, 8, 14, 15, 15});
  EXPECT_THAT(read_one_frame(*rival, detections), ElementsAre(2, 1, 2, 1));
  EXPECT_EQ(rival->bits_per_pixel(), 4 * 8);
}

TEST(CoarseHistogram, AFullBinStaysFull) {
  const std::unique_ptr<Rival> rival = make_coarse_histogram(four_bits(), {.bin_bits = 2, .count_bits = 2});
  EXPECT_THAT(read_one_frame(*rival, one_each(std::array{0, 4, 4, 4, 4, 4, 0, 8})), ElementsAre(2, 3, 1, 0));
  EXPECT_EQ(rival->bits_per_pixel(), 4 * 2);
}

TEST(CoarseHistogram, ReadsTheLastFrameOnly) {
  const std::unique_ptr<Rival> rival = make_coarse_histogram(four_bits(), {.bin_bits = 2});
  const std::vector<Detection> before = one_each(std::array{0, 0});
  const std::vector<Detection> last = one_each(std::array{12});
  EXPECT_THAT(rival->read_pixel(std::vector<std::span<const Detection>>{before, last}),
              ElementsAre(0, 0, 0, 1));
}

// Pairs of bins hold the depth: a pulse of 19 codes in bins of 32 is found to a fraction of a code.
TEST(CoarseHistogram, FindsANoiseFreePulseBetweenItsBins) {
  SensorModel sensor;
  sensor.acquisitions = 20000;
  const std::unique_ptr<Rival> rival = make_coarse_histogram(sensor, {.count_bits = 16});
  for (const double centre : {100.0, 111.0, 319.5, 500.25, 703.0}) {
    for (const int floor : {0, 2}) {
      const RivalWords words = read_one_frame(*rival, noise_free_pulse(sensor, centre, 4000.0, floor));
      EXPECT_NEAR(rival->decode(words).position, centre, 0.8) << centre << " " << floor;
      const std::vector<double> evidence = rival->evidence(words);
      ASSERT_EQ(evidence.size(), 1023U);
      const auto best = std::ranges::max_element(evidence) - evidence.begin();
      EXPECT_NEAR(static_cast<double>(best), centre, 1.0) << centre;
    }
  }
}

// A bright wall fills the bins of the pulse; what its flanks leave in the bins beside them still tells where
// it is.
TEST(CoarseHistogram, FindsABrightPulseOfFullBins) {
  SensorModel sensor;
  sensor.acquisitions = 20000;
  const std::unique_ptr<Rival> rival = make_coarse_histogram(sensor, {});
  for (double centre = 128.0; centre < 160.0; centre += 4.0) {
    const RivalWords words = read_one_frame(*rival, noise_free_pulse(sensor, centre, 6000.0, 0));
    EXPECT_EQ(*std::ranges::max_element(words), 255) << centre;
    EXPECT_NEAR(rival->decode(words).position, centre, 1.0) << centre;
  }
}

TEST(CoarseHistogram, ADarkPixelHasNoConfidence) {
  const std::unique_ptr<Rival> rival = make_coarse_histogram(SensorModel(), {});
  EXPECT_EQ(rival->decode(read_one_frame(*rival, {})).confidence, 0.0);
}

TEST(CoarseHistogram, RefusesWhatItCannotHold) {
  const std::unique_ptr<Rival> rival = make_coarse_histogram(four_bits(), {.bin_bits = 2});
  EXPECT_THAT([&] { (void)read_one_frame(*rival, one_each(std::array{16})); },
              ThrowsMessage<InputError>(HasSubstr("timestamp 16 is above 15")));
  const std::vector<Detection> late = {{3333, 1}};
  EXPECT_THAT([&] { (void)read_one_frame(*rival, late); },
              ThrowsMessage<InputError>(HasSubstr("acquisition 3333 is beyond the frame's 3333")));
  EXPECT_THAT([] { (void)make_coarse_histogram(four_bits(), {.bin_bits = 5}); },
              ThrowsMessage<InputError>(HasSubstr("2^5 bins")));
}

}  // namespace
}  // namespace dtof
