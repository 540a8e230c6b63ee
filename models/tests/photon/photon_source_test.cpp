// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/photon_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/parallel.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/sensor/preset.hpp"
#include "tests/core/refusal.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class PhotonSourceTest : public ::testing::Test {
 protected:
  static PhotonSource flat(const SensorModel& model, int columns, int rows, double depth_m,
                           double klux = 14.0) {
    return {model, TargetMap(columns, rows, {.depth_m = depth_m, .reflectivity = 1.0}), klux, test_seed()};
  }

  SensorModel model_ = parse_preset("thesis");
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

/// The promises of ColumnStream.
void check_stream(const ColumnStream& stream, const PhotonSource& source) {
  const SensorModel& model = source.model();
  ASSERT_EQ(stream.rows(), source.rows());
  for (int row = 0; row < stream.rows(); ++row) {
    const auto detections = stream.row(row);
    int in_acquisition = 0;
    for (std::size_t i = 0; i < detections.size(); ++i) {
      ASSERT_LT(detections[i].acquisition, model.acquisitions);
      ASSERT_LT(detections[i].timestamp, 1U << static_cast<unsigned>(model.np));
      const bool same = i > 0 && detections[i - 1].acquisition == detections[i].acquisition;
      in_acquisition = same ? in_acquisition + 1 : 1;
      ASSERT_LE(in_acquisition, model.slots);
      if (i > 0) {
        ASSERT_GE(detections[i].acquisition, detections[i - 1].acquisition);
      }
      if (same) {
        ASSERT_GE(detections[i].timestamp, detections[i - 1].timestamp);
      }
    }
  }
}

std::vector<std::uint64_t> histogram(std::span<const Detection> detections, int np) {
  std::vector<std::uint64_t> counts(std::size_t{1} << static_cast<unsigned>(np), 0);
  for (const Detection& detection : detections) {
    ++counts[detection.timestamp];
  }
  return counts;
}

double bins(const SensorModel& model, double seconds) { return seconds / model.time_resolution_s(); }

TEST_F(PhotonSourceTest, RatesFollowTheSensorModel) {
  TargetMap targets(2, 2, {.depth_m = 2.0, .reflectivity = 0.5});
  targets.at(1, 0).depth_m = 0.0;
  targets.at(0, 1).depth_m = kInfinity;
  const PhotonSource source(model_, targets, 28.0, 1);
  EXPECT_DOUBLE_EQ(source.rates(0, 0).signal, 0.0375);
  EXPECT_DOUBLE_EQ(source.rates(0, 0).background, 0.15 + 4.5e-4);
  // 2R/c + FWHM = 15.343 ns.
  EXPECT_NEAR(source.rates(0, 0).centre_bins, 349.13, 0.02);
  EXPECT_EQ(source.rates(1, 0).signal, 0.0);
  EXPECT_EQ(source.rates(0, 1).signal, 0.0);
  EXPECT_DOUBLE_EQ(source.rates(1, 0).background, 0.15 + 4.5e-4);
}

TEST_F(PhotonSourceTest, NumbersPerPixelArePoisson) {
  model_.slots = 64;  // nothing is lost
  const PhotonSource source = flat(model_, 20, 20, 1.0);
  const double mean = model_.acquisitions * (0.30 + 0.15 + 4.5e-4);
  double sum = 0.0;
  double chi_square = 0.0;
  for (int column = 0; column < 20; ++column) {
    const ColumnStream stream = source.column(column);
    check_stream(stream, source);
    for (int row = 0; row < 20; ++row) {
      const auto count = static_cast<double>(stream.row(row).size());
      sum += count;
      chi_square += (count - mean) * (count - mean) / mean;
    }
  }
  EXPECT_GT(normal_p(sum - 400.0 * mean, std::sqrt(400.0 * mean)), kErrorRate);
  // The variance equals the mean: 400 squared deviations are chi-square distributed.
  EXPECT_GT(normal_p(chi_square - 400.0, std::sqrt(2.0 * 400.0)), kErrorRate);
}

TEST_F(PhotonSourceTest, NeighboursAndFramesAreIndependent) {
  const PhotonSource source = flat(model_, 100, 40, 1.0);
  const double mean = [&] {
    double sum = 0.0;
    for (int column = 0; column < 100; ++column) {
      sum += static_cast<double>(source.column(column).detection_count());
    }
    return sum / 4000.0;
  }();
  const PhotonSource next_frame = source.at_frame(1);
  double below = 0.0;
  double beside = 0.0;
  double after = 0.0;
  double variance = 0.0;
  for (int column = 0; column + 1 < 100; ++column) {
    const ColumnStream here = source.column(column);
    const ColumnStream right = source.column(column + 1);
    const ColumnStream later = next_frame.column(column);
    for (int row = 0; row + 1 < 40; ++row) {
      const double own = static_cast<double>(here.row(row).size()) - mean;
      variance += own * own;
      below += own * (static_cast<double>(here.row(row + 1).size()) - mean);
      beside += own * (static_cast<double>(right.row(row).size()) - mean);
      after += own * (static_cast<double>(later.row(row).size()) - mean);
    }
  }
  const double trials = 99.0 * 39.0;
  for (const double covariance : {below, beside, after}) {
    EXPECT_GT(normal_p(covariance / variance, 1.0 / std::sqrt(trials)), kErrorRate);
  }
}

TEST_F(PhotonSourceTest, CodesFollowPulseAndBackground) {
  model_.slots = 64;
  const PhotonSource source = flat(model_, 1, 100, 1.5);
  std::vector<std::uint64_t> counts(1024, 0);
  const ColumnStream stream = source.column(0);
  for (int row = 0; row < 100; ++row) {
    for (const Detection& detection : stream.row(row)) {
      ++counts[detection.timestamp];
    }
  }
  const double sigma = bins(model_, 2e-9 / 2.3548);
  const double centre = bins(model_, 2.0 * 1.5 / 299792458.0 + 2e-9);
  auto means = bin_means(1024, 0.15 + 4.5e-4, 0.30 / 2.25, centre, sigma);
  for (double& mean : means) {
    mean *= 100.0 * model_.acquisitions;
  }
  EXPECT_GT(poisson_chi_square_p(counts, means), kErrorRate);
  // The last bin is not emptied: an event there gets the no-detection code.
  EXPECT_GT(counts[1023], 0U);
}

TEST_F(PhotonSourceTest, PileUpKeepsTheFirstSlots) {
  // The same photons with more slots: the short stream is the long one's beginning of every acquisition.
  const auto stream_of = [&](int slots) {
    model_.slots = slots;
    return flat(model_, 1, 8, 0.3, 50.0).column(0);
  };
  const ColumnStream all = stream_of(40);
  for (const int slots : {1, 2, 3}) {
    const ColumnStream kept = stream_of(slots);
    for (int row = 0; row < 8; ++row) {
      std::vector<Detection> expected;
      int in_acquisition = 0;
      for (const Detection& detection : all.row(row)) {
        const bool same = !expected.empty() && expected.back().acquisition == detection.acquisition;
        in_acquisition = same ? in_acquisition + 1 : 1;
        if (in_acquisition <= slots) {
          expected.push_back(detection);
        }
      }
      ASSERT_TRUE(std::ranges::equal(kept.row(row), expected)) << "slots " << slots << " row " << row;
    }
  }
  EXPECT_GT(all.detection_count(), stream_of(3).detection_count());
}

TEST_F(PhotonSourceTest, PileUpNarrowsTheBellAndMovesItForward) {
  // Fig. 2.4: nearer target, stronger distortion.
  double last_centre = -1e9;
  for (const double depth : {0.2, 0.5, 2.0}) {
    const ColumnStream stream = flat(model_, 1, 40, depth, 0.0).column(0);
    const double truth = bins(model_, arrival_centre_s(depth, 2e-9));
    double sum = 0.0;
    double count = 0.0;
    for (int row = 0; row < 40; ++row) {
      for (const Detection& detection : stream.row(row)) {
        if (std::abs(detection.timestamp - truth) < 100.0) {
          sum += detection.timestamp + 0.5 - truth;
          count += 1.0;
        }
      }
    }
    EXPECT_GT(sum / count, last_centre + 0.5);
    last_centre = sum / count;
  }
  EXPECT_NEAR(last_centre, 0.0, 1.0);
}

TEST_F(PhotonSourceTest, BinningSharesTheUnionOfABlock) {
  model_.slots = 64;
  model_.binning = 2;
  TargetMap targets(2, 2);
  targets.at(0, 0) = {.depth_m = 1.0, .reflectivity = 1.0};
  targets.at(1, 0) = {.depth_m = 2.0, .reflectivity = 1.0};
  targets.at(0, 1) = {.depth_m = 1.0, .reflectivity = 0.5};
  targets.at(1, 1) = {.depth_m = 0.0, .reflectivity = 0.3};
  std::vector<std::uint64_t> counts(1024, 0);
  constexpr int kFrames = 60;
  const PhotonSource source(model_, targets, 14.0, test_seed());
  for (int frame = 0; frame < kFrames; ++frame) {
    const PhotonSource now = source.at_frame(static_cast<std::uint32_t>(frame));
    const ColumnStream left = now.column(0);
    check_stream(left, now);
    ASSERT_EQ(left, now.column(1));
    ASSERT_TRUE(std::ranges::equal(left.row(0), left.row(1)));
    const auto add = histogram(left.row(0), 10);
    std::ranges::transform(counts, add, counts.begin(), std::plus<>());
  }
  const double sigma = bins(model_, pulse_sigma_s(2e-9));
  const auto near =
      bin_means(1024, 0.15 * 2.8 + 4 * 4.5e-4, 0.45, bins(model_, arrival_centre_s(1.0, 2e-9)), sigma);
  const auto far = bin_means(1024, 0.0, 0.075, bins(model_, arrival_centre_s(2.0, 2e-9)), sigma);
  std::vector<double> means(1024);
  for (std::size_t i = 0; i < 1024; ++i) {
    means[i] = kFrames * static_cast<double>(model_.acquisitions) * (near[i] + far[i]);
  }
  EXPECT_GT(poisson_chi_square_p(counts, means), kErrorRate);
}

TEST_F(PhotonSourceTest, BinnedStreamHasTheFirstSlotsOfTheUnion) {
  const auto make = [&](int binning, int slots) {
    model_.binning = binning;
    model_.slots = slots;
    return flat(model_, 3, 3, 0.4, 50.0);
  };
  const PhotonSource binned = make(3, 2);
  const PhotonSource single = make(1, 200);
  std::vector<Detection> all;
  for (int column = 0; column < 3; ++column) {
    const ColumnStream stream = single.column(column);
    for (int row = 0; row < 3; ++row) {
      all.insert(all.end(), stream.row(row).begin(), stream.row(row).end());
    }
  }
  std::ranges::sort(all, {}, [](const Detection& d) { return std::pair(d.acquisition, d.timestamp); });
  std::vector<Detection> expected;
  for (const Detection& detection : all) {
    const std::size_t n = expected.size();
    if (n < 2 || expected[n - 2].acquisition != detection.acquisition) {
      expected.push_back(detection);
    }
  }
  EXPECT_TRUE(std::ranges::equal(binned.column(1).row(2), expected));
}

TEST_F(PhotonSourceTest, BlocksAreCutAtTheArraysBorder) {
  model_.binning = 2;
  model_.slots = 64;
  const PhotonSource source = flat(model_, 3, 3, 1.0);
  const double mean = model_.acquisitions * (0.45 + 4.5e-4);
  const ColumnStream first = source.column(0);
  const ColumnStream last = source.column(2);
  const auto check = [&](std::span<const Detection> row, double pixels) {
    EXPECT_GT(normal_p(static_cast<double>(row.size()) - pixels * mean, std::sqrt(pixels * mean)),
              kErrorRate);
  };
  check(first.row(0), 4.0);
  check(first.row(2), 2.0);
  check(last.row(1), 2.0);
  check(last.row(2), 1.0);
}

TEST_F(PhotonSourceTest, CoincidenceMatchesBruteForce) {
  model_.acquisitions = 300;
  // Wide enough to reach over the gate's ends into the acquisitions before and after, which must not count.
  constexpr double kWindow = 5e-9;
  model_.coincidence_window_s = kWindow;
  model_.time_gate = TimeGate{0.5e-9, 44.5e-9};
  TargetMap targets(4, 5, {.depth_m = 0.5, .reflectivity = 0.5});
  targets.at(2, 2).depth_m = 3.0;
  for (const int binning : {1, 3}) {
    model_.binning = binning;
    const PhotonSource source(model_, targets, 100.0, test_seed(), 7);
    EventSampler sampler(model_, EventSampler::kAll);
    const auto events = [&](int column, int row) {
      const CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 7,
                                 static_cast<std::uint32_t>(row * 4 + column));
      const auto drawn = sampler.sample(source.rates(column, row), random);
      return std::vector<double>(drawn.begin(), drawn.end());
    };
    std::size_t lost = 0;
    const auto coincident = [&](int column, int row) {
      std::vector<double> kept;
      for (const double event : events(column, row)) {
        bool partner = false;
        for (int x = 0; x < 4; ++x) {
          for (int y = 0; y < 5; ++y) {
            if (std::abs(x - column) + std::abs(y - row) != 1) {
              continue;
            }
            for (const double other : events(x, y)) {
              partner |= std::floor(other / 1024.0) == std::floor(event / 1024.0) &&
                         std::abs(other - event) <= bins(model_, kWindow);
            }
          }
        }
        lost += partner ? 0 : 1;
        if (partner) {
          kept.push_back(event);
        }
      }
      return kept;
    };
    for (int column = 0; column < 4; ++column) {
      const ColumnStream stream = source.column(column);
      check_stream(stream, source);
      for (int row = 0; row < 5; ++row) {
        std::vector<double> block;
        for (int x = column / binning * binning; x < std::min(4, (column / binning + 1) * binning); ++x) {
          for (int y = row / binning * binning; y < std::min(5, (row / binning + 1) * binning); ++y) {
            const auto kept = coincident(x, y);
            block.insert(block.end(), kept.begin(), kept.end());
          }
        }
        std::ranges::sort(block);
        std::vector<Detection> expected;
        for (const double event : block) {
          const auto acquisition = static_cast<std::uint32_t>(event / 1024.0);
          const auto code = static_cast<Timestamp>(event - acquisition * 1024.0);
          if (expected.size() < 2 || expected[expected.size() - 2].acquisition != acquisition) {
            expected.push_back({acquisition, code});
          }
        }
        ASSERT_TRUE(std::ranges::equal(stream.row(row), expected)) << column << " " << row << " " << binning;
        ASSERT_GT(expected.size(), 0U);
      }
    }
    EXPECT_GT(lost, 0U);
  }
}

TEST_F(PhotonSourceTest, CoincidenceNeedsANeighbour) {
  model_.coincidence_window_s = 1.0;
  EXPECT_EQ(flat(model_, 1, 1, 0.5).column(0).detection_count(), 0U);
  EXPECT_GT(flat(model_, 1, 2, 0.5).column(0).detection_count(), 0U);
  EXPECT_GT(flat(model_, 2, 1, 0.5).column(0).detection_count(), 0U);
}

TEST_F(PhotonSourceTest, AnyPixelAloneAndAnyThreadCount) {
  TargetMap targets(6, 4, {.depth_m = 1.0, .reflectivity = 1.0});
  const PhotonSource source(model_, targets, 14.0, test_seed(), 3);
  const auto all_columns = [&](int threads) {
    std::vector<ColumnStream> columns(6);
    parallel_for(6, threads, [&](std::size_t i) { columns[i] = source.column(static_cast<int>(i)); });
    return columns;
  };
  const auto reference = all_columns(1);
  EXPECT_EQ(all_columns(4), reference);
  for (int column = 5; column >= 0; --column) {
    EXPECT_EQ(source.column(column), reference[static_cast<std::size_t>(column)]);
  }
  // What other pixels look at does not matter.
  targets = TargetMap(6, 4, {.depth_m = 0.3, .reflectivity = 0.7});
  targets.at(2, 1) = {.depth_m = 1.0, .reflectivity = 1.0};
  const PhotonSource other(model_, targets, 14.0, test_seed(), 3);
  EXPECT_TRUE(std::ranges::equal(other.column(2).row(1), reference[2].row(1)));
  EXPECT_FALSE(std::ranges::equal(other.column(2).row(2), reference[2].row(2)));
}

TEST_F(PhotonSourceTest, RowsAloneAreThoseOfTheColumn) {
  const auto check = [](const StreamSource& source) {
    for (int column = 0; column < source.columns(); ++column) {
      const ColumnStream whole = source.column(column);
      for (int first = 0; first < source.rows(); ++first) {
        for (int count = 0; first + count <= source.rows(); ++count) {
          const ColumnStream part = source.column_rows(column, {.first = first, .count = count});
          ASSERT_EQ(part.rows(), count);
          for (int row = 0; row < count; ++row) {
            ASSERT_TRUE(std::ranges::equal(part.row(row), whole.row(first + row)))
                << "column " << column << " row " << row << " of " << count << " from " << first;
          }
        }
      }
    }
  };
  model_.acquisitions = 200;
  TargetMap targets(3, 7, {.depth_m = 1.0, .reflectivity = 1.0});
  targets.at(1, 3).depth_m = 0.3;
  const auto source = [&] { return PhotonSource(model_, targets, 50.0, test_seed(), 2); };
  check(source());
  check(FastPhotonSource(source()));
  check(MeanPhotonSource(source()));
  for (const int binning : {1, 2, 3, 100}) {
    for (const bool coincidence : {false, true}) {
      SCOPED_TRACE(testing::Message() << "binning " << binning << " coincidence " << coincidence);
      model_.binning = binning;
      model_.coincidence_window_s = coincidence ? std::optional(1e-9) : std::nullopt;
      check(source());
    }
  }
}

TEST_F(PhotonSourceTest, SeedFrameAndPixelChangeTheNumbers) {
  const PhotonSource source = flat(model_, 2, 2, 1.0);
  const ColumnStream column = source.column(0);
  EXPECT_NE(column, source.column(1));
  EXPECT_FALSE(std::ranges::equal(column.row(0), column.row(1)));
  EXPECT_NE(column, source.at_frame(1).column(0));
  EXPECT_EQ(column, source.at_frame(1).at_frame(0).column(0));
  const PhotonSource other_seed(model_, source.targets(), 14.0, test_seed() + 1);
  EXPECT_NE(column, other_seed.column(0));
}

TEST_F(PhotonSourceTest, NoPhotonsAtAll) {
  model_.dark_count_rate_hz = 0.0;
  const TargetMap black(2, 3, {.depth_m = 1.0, .reflectivity = 0.0});
  for (const int binning : {1, 2}) {
    model_.binning = binning;
    const PhotonSource source(model_, black, 0.0, test_seed());
    EXPECT_EQ(source.column(1).rows(), 3);
    EXPECT_EQ(source.column(1).detection_count(), 0U);
  }
}

TEST_F(PhotonSourceTest, TargetBeyondTheRangeGivesBackgroundOnly) {
  model_.dark_count_rate_hz = 0.0;
  // 2R/c + FWHM of 7 m is 48.7 ns, 4.4 sigma beyond 45 ns.
  EXPECT_LT(flat(model_, 1, 20, 7.0, 0.0).column(0).detection_count(), 5U);
  EXPECT_EQ(flat(model_, 1, 20, 9.0, 0.0).column(0).detection_count(), 0U);
  EXPECT_EQ(flat(model_, 1, 20, 0.0, 0.0).column(0).detection_count(), 0U);
  EXPECT_EQ(flat(model_, 1, 20, kInfinity, 0.0).column(0).detection_count(), 0U);
}

TEST_F(PhotonSourceTest, EmptyFramesAndEveryWidthOfTimestamp) {
  for (const std::uint32_t acquisitions : {0U, 1U, 50U}) {
    for (int np = 3; np <= 16; ++np) {
      model_.np = np;
      model_.acquisitions = acquisitions;
      const PhotonSource source = flat(model_, 2, 3, 0.1, 200.0);
      check_stream(source.column(1), source);
      EXPECT_EQ(source.column(1).detection_count() > 0, acquisitions > 0);
    }
  }
}

TEST_F(PhotonSourceTest, MirrorNearby) {
  // 0.05 m and four times a white target: 480 events per pulse.
  const PhotonSource source(model_, TargetMap(1, 4, {.depth_m = 0.05, .reflectivity = 4.0}), 200.0,
                            test_seed());
  const ColumnStream stream = source.column(0);
  check_stream(stream, source);
  EXPECT_EQ(stream.detection_count(), 4U * 2U * 3333U);
}

TEST_F(PhotonSourceTest, RefusesBadPhysics) {
  const auto message = [&](PixelTarget target, double klux) {
    TargetMap targets(3, 2, {.depth_m = 1.0, .reflectivity = 1.0});
    targets.at(2, 1) = target;
    return refusal([&] { PhotonSource(model_, targets, klux, 1); });
  };
  EXPECT_EQ(message({.depth_m = 1.0, .reflectivity = 0.0}, 0.0), "accepted");
  for (const double bad : {kNan, -1.0, -kInfinity}) {
    EXPECT_THAT(message({.depth_m = bad, .reflectivity = 1.0}, 14.0), HasSubstr("(column 2, row 1): depth"));
    EXPECT_THAT(message({.depth_m = 1.0, .reflectivity = bad}, 14.0),
                HasSubstr("(column 2, row 1): reflectivity"));
    EXPECT_THAT(message({.depth_m = 1.0, .reflectivity = 1.0}, bad), HasSubstr("klux"));
  }
  EXPECT_THAT(message({.depth_m = 1.0, .reflectivity = kInfinity}, 14.0), HasSubstr("reflectivity"));
  EXPECT_THAT(message({.depth_m = 1.0, .reflectivity = 1.0}, kInfinity), HasSubstr("klux"));
  EXPECT_THAT(message({.depth_m = 1e-200, .reflectivity = 1.0}, 14.0), HasSubstr("overflows"));
  model_.coincidence_window_s = 1e-9;
  EXPECT_THAT(message({.depth_m = 1e-4, .reflectivity = 1.0}, 14.0), HasSubstr("coincidence"));
  model_.coincidence_window_s = kNan;
  EXPECT_THAT(message({.depth_m = 1.0, .reflectivity = 1.0}, 14.0), HasSubstr("coincidence window"));
}

}  // namespace
}  // namespace dtof
