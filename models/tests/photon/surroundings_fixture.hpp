// SPDX-License-Identifier: Apache-2.0
// Effects of a sensor's surroundings compared with closed forms or sums of the test. Seeds are fixed
// (DTOF_TEST_SEED changes them); a correct model fails one test in a million (kErrorRate).
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/photon/surroundings.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {

using ::testing::HasSubstr;

inline constexpr std::uint32_t kAcquisitions = 3000;
inline constexpr int kColumns = 4;
inline constexpr int kRows = 50;
inline constexpr std::size_t kCodes = 1024;
inline constexpr double kTrials = 1.0 * kAcquisitions * kColumns * kRows;

class SurroundingsTest : public ::testing::Test {
 protected:
  SurroundingsTest() {
    sensor_.acquisitions = kAcquisitions;
    sensor_.slots = 16;
    sensor_.pulse_period_s = 10e-6;
  }

  [[nodiscard]] PhotonSource source(double depth_m, double klux = 14.0) const {
    return {sensor_, TargetMap(kColumns, kRows, {.depth_m = depth_m, .reflectivity = 1.0}), klux,
            test_seed()};
  }
  /// Removes all events except those under test.
  void make_dark() {
    sensor_.dark_count_rate_hz = 0.0;
    sensor_.background_events_per_klux = 0.0;
  }

  [[nodiscard]] static std::vector<Detection> detections(const PhotonSource& source) {
    std::vector<Detection> all;
    for (int column = 0; column < source.columns(); ++column) {
      const ColumnStream stream = source.column(column);
      for (int row = 0; row < stream.rows(); ++row) {
        const auto own = stream.row(row);
        EXPECT_TRUE(std::ranges::is_sorted(
            own, {}, [](const Detection& d) { return std::pair(d.acquisition, d.timestamp); }));
        all.insert(all.end(), own.begin(), own.end());
      }
    }
    return all;
  }
  [[nodiscard]] static std::vector<std::uint64_t> counts(const PhotonSource& source) {
    std::vector<std::uint64_t> codes(kCodes);
    for (const Detection& detection : detections(source)) {
      ++codes.at(detection.timestamp);
    }
    return codes;
  }
  [[nodiscard]] double bins(double distance_m, double fwhm_s = 2e-9) const {
    return (2.0 * distance_m / kSpeedOfLight + fwhm_s) / sensor_.time_resolution_s();
  }
  [[nodiscard]] double sigma() const { return 2e-9 / 2.3548200450309493 / sensor_.time_resolution_s(); }
  /// Mean events of each code: flat background and Gaussian returns of (events a pulse, centre in bins).
  [[nodiscard]] std::vector<double> means(double background,
                                          const std::vector<std::pair<double, double>>& returns) const {
    std::vector<double> sum(kCodes, background / kCodes);
    for (const auto& [events, centre] : returns) {
      const std::vector<double> own = bin_means(kCodes, 0.0, events, centre, sigma());
      for (std::size_t i = 0; i < kCodes; ++i) {
        sum[i] += own[i];
      }
    }
    for (double& mean : sum) {
      mean *= kTrials;
    }
    return sum;
  }
  /// p-value for Gaussian times around `centre` of their acquisition; each time is drawn uniformly within its
  /// bin.
  template <typename Centre>
  [[nodiscard]] double gaussian_p(const std::vector<Detection>& all, const Centre& centre) const {
    CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestControl), 5, 7);
    std::vector<double> shares;
    for (const Detection& detection : all) {
      // Within a bin the density is not flat, which is far below what the test resolves: bins are sigma / 19.
      const double time = detection.timestamp + random.uniform();
      shares.push_back(0.5 *
                       std::erfc(-(time - centre(detection.acquisition)) / sigma() / std::numbers::sqrt2));
    }
    return kolmogorov_smirnov_p(shares);
  }

  SensorModel sensor_;
  Surroundings& around_ = sensor_.surroundings;
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

inline constexpr double kBackground = 0.15 + 4.5e-4;

}  // namespace dtof
