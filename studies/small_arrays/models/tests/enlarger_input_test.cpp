// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/enlarger_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// 12 x 9 pixels, spots at columns 1, 4, 7, 10 and rows 1, 4, 7.
struct Small {
  SmallMap map;
  IntensityImage image;
};

Small make_small() {
  Small small{{make_spot_grid(12, 9, 4, 3), {}, {}}, {12, 9, {}}};
  for (int i = 0; i < 12; ++i) {
    small.map.distance_m.push_back(1.2 + 0.1 * i);
    small.map.confidence.push_back(i < 4 ? 7.0 : i);  // four equal ones
  }
  for (int i = 0; i < 12 * 9; ++i) {
    small.image.values.push_back(100.0 + i % 5);
  }
  return small;
}

float feature(const EnlargerInput& input, std::size_t number, int column, int row) {
  return input.features.at(number * input.pixels() + static_cast<std::size_t>(row * input.columns + column));
}

TEST(EnlargerInput, CandidatesAreTheSpotsAround) {
  const EnlargerInput input = make_enlarger_input(make_small().map, make_small().image);
  ASSERT_EQ(input.candidates.size(), 9U * 108U);
  const auto candidate = [&](std::size_t k, int column, int row) {
    return input.candidates.at(k * 108 + static_cast<std::size_t>(row * 12 + column));
  };
  for (std::size_t k = 0; k < 9; ++k) {
    // The nearest spot of column 5, row 3 has column 1 and row 1 of the small array.
    EXPECT_FLOAT_EQ(candidate(k, 5, 3), 1.2F + 0.1F * static_cast<float>(4 * (k / 3) + k % 3)) << k;
  }
  // In a corner, the border's spots stand for those beyond.
  for (const std::size_t k : {0, 1, 3, 4}) {
    EXPECT_FLOAT_EQ(candidate(k, 0, 0), 1.2F) << k;
  }
  EXPECT_FLOAT_EQ(candidate(8, 0, 0), 1.7F);
  EXPECT_FLOAT_EQ(candidate(8, 11, 8), 2.3F);
}

TEST(EnlargerInput, FeaturesAreWhatTheHeaderSays) {
  const Small small = make_small();
  const EnlargerInput input = make_enlarger_input(small.map, small.image);
  ASSERT_EQ(input.features.size(), static_cast<std::size_t>(kFeatures) * 108U);
  const std::vector<double> bright = brightness(small.image);
  for (int k = 0; k < 9; ++k) {
    const int spot = 4 * (k / 3) + k % 3;
    const int spot_pixel = (1 + 3 * (k / 3)) * 12 + 1 + 3 * (k % 3);
    const auto number = static_cast<std::size_t>(k);
    EXPECT_NEAR(feature(input, number, 5, 3), 5.0 * std::log((1.2 + 0.1 * spot) / 1.7), 1e-6) << k;
    // Four confidences of 7 besides that of spot 7: five equal ones of twelve, below them those of spots 4
    // to 6.
    const double share = spot < 4 || spot == 7 ? 5.5 / 12.0 : (spot < 7 ? spot - 4 + 0.5 : spot + 0.5) / 12.0;
    EXPECT_NEAR(feature(input, 9 + number, 5, 3), share, 1e-6) << k;
    const double unlike = bright.at(static_cast<std::size_t>(spot_pixel)) - bright.at(3 * 12 + 5);
    EXPECT_NEAR(feature(input, 18 + number, 5, 3), std::exp(-200.0 * unlike * unlike), 1e-6) << k;
    const double right = (5.0 - (1 + 3 * (k % 3))) / 3.0;
    const double below = (3.0 - (1 + 3 * (k / 3))) / 3.0;
    EXPECT_NEAR(input.prior.at(number * 108 + 3 * 12 + 5),
                -0.5 * ((right * right + below * below) / (0.35 * 0.35) + unlike * unlike / (0.06 * 0.06)),
                1e-5)
        << k;
  }
  EXPECT_NEAR(feature(input, 27, 5, 3), bright.at(3 * 12 + 5), 1e-6);
  EXPECT_NEAR(feature(input, 28, 5, 3), 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(feature(input, 29, 5, 3), -1.0 / 3.0, 1e-6);
  EXPECT_NEAR(feature(input, 30, 5, 3), 0.75, 1e-6);
}

TEST(EnlargerInput, DifferencesOfDistanceHaveALimit) {
  Small small = make_small();
  small.map.distance_m[0] = 100.0;
  small.map.distance_m[1] = 0.0;
  const EnlargerInput input = make_enlarger_input(small.map, small.image);
  EXPECT_EQ(feature(input, 0, 5, 3), 2.0F);
  EXPECT_EQ(feature(input, 1, 5, 3), -2.0F);
}

TEST(EnlargerInput, ACandidateOfAnyOtherBrightnessKeepsAPrior) {
  Small small = make_small();
  small.image.values[3 * 12 + 5] = 1e6;
  const EnlargerInput input = make_enlarger_input(small.map, small.image);
  EXPECT_NEAR(input.prior.at(4 * 108 + 3 * 12 + 5), -0.5 * (2.0 / 9.0) / (0.35 * 0.35) - 6.0, 1e-5);
}

TEST(EnlargerInput, RefusesSizesThatDoNotFit) {
  Small small = make_small();
  small.image.values.pop_back();
  EXPECT_THAT([&] { (void)make_enlarger_input(small.map, small.image); },
              ThrowsMessage<InputError>(HasSubstr("12 x 9 pixels with 107 values cannot guide")));
}

}  // namespace
}  // namespace dtof
