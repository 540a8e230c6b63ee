// SPDX-License-Identifier: Apache-2.0
// A camera that moves sideways during the frame, compared with the areas that a pixel's square shares with a
// step edge.
#include "tests/photon/surroundings_fixture.hpp"

namespace dtof {
namespace {

constexpr int kWide = 8;
constexpr int kEdge = 4;  // the first pixel behind the edge
constexpr double kPixelTrials = 1.0 * kAcquisitions * kRows;

class LateralMotionTest : public SurroundingsTest {
 protected:
  /// Near on the left, far and darker on the right.
  [[nodiscard]] static TargetMap step_edge() {
    TargetMap map(kWide, kRows, {.depth_m = 1.0, .reflectivity = 1.0});
    for (int column = kEdge; column < kWide; ++column) {
      for (int row = 0; row < kRows; ++row) {
        map.at(column, row) = {.depth_m = 3.0, .reflectivity = 0.5};
      }
    }
    return map;
  }
  /// Share of the frame's pulses, by area, in which a pixel sees what is behind the edge.
  [[nodiscard]] static double share_behind(int pixel, double pixels_per_frame) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kAcquisitions; ++i) {
      const double moved = pixels_per_frame * (i - 0.5 * (kAcquisitions - 1.0)) / kAcquisitions;
      sum += std::clamp(pixel + 1 + moved - kEdge, 0.0, 1.0);
    }
    return sum / kAcquisitions;
  }
  [[nodiscard]] std::vector<double> expected(double behind) const {
    std::vector<double> sum =
        means(0.15 * (1.0 - behind) + 0.15 * 0.5 * behind + 4.5e-4,
              {{0.3 * (1.0 - behind), bins(1.0)}, {0.3 * 0.5 / 9.0 * behind, bins(3.0)}});
    for (double& mean : sum) {
      mean *= kPixelTrials / kTrials;
    }
    return sum;
  }
  [[nodiscard]] static std::vector<std::uint64_t> column_counts(const PhotonSource& source, int column) {
    std::vector<std::uint64_t> codes(kCodes);
    const ColumnStream stream = source.column(column);
    for (int row = 0; row < stream.rows(); ++row) {
      for (const Detection& detection : stream.row(row)) {
        ++codes.at(detection.timestamp);
      }
    }
    return codes;
  }
};

TEST_F(LateralMotionTest, AStepEdgeMovesByTheCameraColumns) {
  for (const double way : {0.5, 3.0, -3.0}) {
    around_.lateral = {.columns_per_frame = way};
    const PhotonSource source(sensor_, step_edge(), 14.0, test_seed());
    for (int column = 0; column < kWide; ++column) {
      const double behind = share_behind(column, way);
      EXPECT_GT(poisson_chi_square_p(column_counts(source, column), expected(behind)), kErrorRate)
          << way << ' ' << column;
    }
  }
}

TEST_F(LateralMotionTest, AWayThatIsTwiceAsLongIsRejected) {
  around_.lateral = {.columns_per_frame = 3.0};
  const PhotonSource source(sensor_, step_edge(), 14.0, test_seed());
  for (const int column : {kEdge - 2, kEdge - 1, kEdge, kEdge + 1}) {
    EXPECT_LT(poisson_chi_square_p(column_counts(source, column), expected(share_behind(column, 6.0))),
              kErrorRate)
        << column;
  }
}

TEST_F(LateralMotionTest, TheEdgePassesAPixelAtItsTime) {
  make_dark();
  around_.lateral = {.columns_per_frame = 3.0};
  const PhotonSource source(sensor_, step_edge(), 0.0, test_seed());
  // Column 3 begins to see the far side in the frame's middle, and sees it alone a third of the frame later.
  const ColumnStream stream = source.column(kEdge - 1);
  std::uint64_t far_before = 0;
  std::uint64_t near_after = 0;
  const double between = 0.5 * (bins(1.0) + bins(3.0));
  for (int row = 0; row < stream.rows(); ++row) {
    for (const Detection& detection : stream.row(row)) {
      far_before += detection.acquisition < 1499 && detection.timestamp > between ? 1 : 0;
      near_after += detection.acquisition > 2500 && detection.timestamp < between ? 1 : 0;
    }
  }
  EXPECT_EQ(far_before, 0);
  EXPECT_EQ(near_after, 0);
}

TEST_F(LateralMotionTest, RowsMoveAsColumnsDo) {
  make_dark();
  TargetMap map(1, kWide, {.depth_m = 1.0, .reflectivity = 1.0});
  for (int row = kEdge; row < kWide; ++row) {
    map.at(0, row) = {};
  }
  around_.lateral = {.rows_per_frame = 3.0};
  const ColumnStream stream = PhotonSource(sensor_, map, 0.0, test_seed()).column(0);
  for (int row = 0; row < kWide; ++row) {
    const double mean = 0.3 * kAcquisitions * (1.0 - share_behind(row, 3.0));
    const auto events = static_cast<double>(stream.row(row).size());
    if (mean == 0.0) {
      EXPECT_EQ(events, 0.0) << row;
    } else {
      EXPECT_GT(normal_p(events - mean, std::sqrt(mean)), kErrorRate) << row;
    }
  }
}

TEST_F(LateralMotionTest, APixelSeesAreasThatAddUpToItsOwn) {
  for (const LateralMotion& motion :
       {LateralMotion{.columns_per_frame = 5.5, .rows_per_frame = -2.25},
        LateralMotion{.columns_per_frame = 0.3}, LateralMotion{.rows_per_frame = 7.0}}) {
    constexpr std::uint32_t kPulses = 97;
    const std::vector<SeenPixel> seen = seen_pixels(motion, kPulses);
    for (std::uint32_t i = 0; i < kPulses; ++i) {
      double sum = 0.0;
      for (const SeenPixel& pixel : seen) {
        const double share = seen_share(motion, pixel, i, kPulses);
        EXPECT_TRUE(share == 0.0 || (i >= pixel.first && i < pixel.end));
        EXPECT_LE(share, pixel.largest_share);
        sum += share;
      }
      EXPECT_NEAR(sum, 1.0, 1e-12);
    }
  }
  EXPECT_TRUE(seen_pixels({}, 100).empty());
}

TEST_F(LateralMotionTest, AnEvenSceneDoesNotChange) {
  around_.lateral = {.columns_per_frame = 20.0, .rows_per_frame = 30.0};
  around_.cover_glass = {.events = 0.05, .distance_m = 0.05};
  const std::vector<double> still = means(kBackground, {{0.3 / 4.0, bins(2.0)}, {0.05, bins(0.05)}});
  EXPECT_GT(poisson_chi_square_p(counts(source(2.0)), still), kErrorRate);
  around_.fog = {.extinction_per_m = 0.25, .lidar_ratio_sr = 20.0, .overlap_m = 0.2};
  around_.pane = {.distance_m = 1.0, .reflectivity = 0.05, .transmittance = 0.8};
  const double all = static_cast<double>(detections(source(2.0)).size());
  around_.lateral = {};
  const double standing = static_cast<double>(detections(source(2.0)).size());
  EXPECT_GT(normal_p(all - standing, std::sqrt(all + standing)), kErrorRate);
}

TEST_F(LateralMotionTest, HotAndDeadPixelsStayWithTheSensor) {
  sensor_.background_events_per_klux = 0.0;
  around_.lateral = {.columns_per_frame = 6.0};
  sensor_.defects.dead = {{.column = 2, .row = 0}};
  sensor_.defects.hot = {{.column = 1, .row = 0}};
  sensor_.defects.hot_dark_count_rate_hz = 1e7;
  const PhotonSource source(sensor_, TargetMap(4, 1), 0.0, test_seed());
  const double hot = 1e7 * sensor_.integration_time_s * kAcquisitions;
  const auto events = static_cast<double>(source.column(1).row(0).size());
  EXPECT_GT(normal_p(events - hot, std::sqrt(hot)), kErrorRate);
  EXPECT_TRUE(source.column(2).row(0).empty());
  EXPECT_LT(source.column(3).row(0).size(), 20U);
}

TEST_F(LateralMotionTest, IsOffUnlessNamedAndHasALimit) {
  EXPECT_TRUE(around_.none());
  around_.lateral.rows_per_frame = 0.1;
  EXPECT_FALSE(around_.none());
  EXPECT_TRUE(around_.signal_changes());
  for (const double wrong : {1001.0, -1001.0, std::nan("")}) {
    around_.lateral.rows_per_frame = wrong;
    EXPECT_THROW(around_.validate(), InputError) << wrong;
  }
}

}  // namespace
}  // namespace dtof
