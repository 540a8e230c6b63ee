// SPDX-License-Identifier: Apache-2.0
#include "dtof/analytic/code_distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/sensor/preset.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {
namespace {

class CodeDistribution : public ::testing::TestWithParam<Readout> {
 protected:
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

TEST_P(CodeDistribution, IsThatOfTheExactModel) {
  for (const double depth : {1.0, 2.7, 4.5}) {
    const SensorModel sensor = parse_preset("thesis");
    const ReadoutParameters parameters = ReadoutParameters::defaults(GetParam());
    const PhotonSource exact(sensor, TargetMap(10, 200, {.depth_m = depth, .reflectivity = 1.0}), 14.0,
                             test_seed());
    std::vector<std::uint64_t> counts(1024, 0);
    for (const PixelResult& result : run_frame(exact, parameters)) {
      ++counts[result.code];
    }
    const std::vector<double> expected = code_distribution(sensor, exact.rates(0, 0), parameters);
    EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1.0, 1e-9);
    EXPECT_GT(chi_square_p(counts, expected, 2000.0), kErrorRate) << depth;
    // The test would notice another distance, 5 % farther.
    const PhotonSource farther(sensor, TargetMap(1, 1, {.depth_m = 1.05 * depth, .reflectivity = 1.0}), 14.0,
                               1);
    // PiFH loses a far pulse either way, and ezPointer does not get there.
    const bool blind = depth > 3.0 && (GetParam() == Readout::kPifh || GetParam() == Readout::kEzPointer);
    if (!blind) {
      EXPECT_LT(chi_square_p(counts, code_distribution(sensor, farther.rates(0, 0), parameters), 2000.0),
                kErrorRate)
          << depth;
    }
  }
}

TEST_P(CodeDistribution, FollowsOptionsOfTheReadout) {
  SensorModel sensor = parse_preset("thesis");
  sensor.np = 8;
  ReadoutParameters parameters = ReadoutParameters::defaults(GetParam(), 8);
  parameters.count_width = 4;  // saturates
  parameters.window_centred = GetParam() == Readout::kSifh;
  parameters.pointer_step = 2;
  parameters.time_gate = CodeGate{40, 200};
  parameters.fraction_bits = is_pointer_readout(GetParam()) ? 2 : 0;
  const PhotonSource exact(sensor, TargetMap(10, 200, {.depth_m = 2.0, .reflectivity = 1.0}), 14.0,
                           test_seed());
  std::vector<std::uint64_t> counts(std::size_t{256} << static_cast<unsigned>(parameters.fraction_bits), 0);
  for (const PixelResult& result : run_frame(exact, parameters)) {
    ++counts[(std::size_t{result.code} << static_cast<unsigned>(parameters.fraction_bits)) | result.fraction];
  }
  EXPECT_GT(chi_square_p(counts, code_distribution(sensor, exact.rates(0, 0), parameters), 2000.0),
            kErrorRate);
}

INSTANTIATE_TEST_SUITE_P(Readouts, CodeDistribution, ::testing::ValuesIn(kThesisReadouts),
                         [](const auto& parameter) { return std::string(readout_name(parameter.param)); });

TEST(PredictedErrors, AreThoseOfTheSameDrawnErrors) {
  const SensorModel sensor = parse_preset("thesis");
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kFifh);
  const DepthScale scale(sensor.integration_time_s, 10, sensor.pulse_fwhm_s);
  std::vector<double> distribution(1024, 0.0);
  ErrorStatistics statistics;
  for (const int code : {300, 310, 310, 340, 420, 700}) {
    distribution[static_cast<std::size_t>(code)] += 1.0;
    statistics.add(1.8, scale.depth(code));
  }
  const PredictedErrors errors = predict_errors(distribution, sensor, parameters, 1.8);
  const ErrorSummary summary = statistics.summary();
  const double unbiased = std::sqrt(5.0 / 6.0);
  EXPECT_NEAR(errors.bias_m, summary.bias_m, 1e-12);
  EXPECT_NEAR(errors.relative_precision, summary.relative_precision * unbiased, 1e-12);
  EXPECT_NEAR(errors.standard_deviation_m, summary.standard_deviation_m * unbiased, 1e-12);
  EXPECT_NEAR(errors.share_above_3_percent, summary.share_above_3_percent, 1e-12);
  EXPECT_NEAR(errors.share_above_10_percent, summary.share_above_10_percent, 1e-12);
}

TEST(CodeDistributionRefusals, ReadoutsThatPoolPixels) {
  EXPECT_THROW(
      code_distribution(parse_preset("thesis"), {}, ReadoutParameters::defaults(Readout::kPoolPointer)),
      InputError);
}

TEST(CodeDistributionRefusals, OtherNpOrSlotsThanTheSensor) {
  const SensorModel sensor = parse_preset("thesis");
  EXPECT_THROW(code_distribution(sensor, {}, ReadoutParameters::defaults(Readout::kSifh, 9)), InputError);
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh);
  parameters.slots = 1;
  EXPECT_THROW(code_distribution(sensor, {}, parameters), InputError);
}

}  // namespace
}  // namespace dtof
