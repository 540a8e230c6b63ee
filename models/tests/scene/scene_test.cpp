// SPDX-License-Identifier: Apache-2.0
#include "dtof/scene/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "dtof/core/physical_constants.hpp"
#include "tests/core/refusal.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<PixelTarget> all_targets(const TargetMap& map) {
  std::vector<PixelTarget> targets;
  for (int column = 0; column < map.columns(); ++column) {
    for (int row = 0; row < map.rows(); ++row) {
      targets.push_back(map.at(column, row));
    }
  }
  return targets;
}

TEST(Scene, NamesAreParsedBack) {
  for (const Scene scene : kAllScenes) {
    EXPECT_EQ(parse_scene(scene_name(scene)), scene);
    EXPECT_FALSE(scene_summary(scene).empty());
  }
  const std::string message = refusal([] { parse_scene("forest"); });
  EXPECT_THAT(message, HasSubstr("forest"));
  EXPECT_THAT(message, HasSubstr("flat, staircase, plane, room"));
}

TEST(Scene, EverySceneIsLegalForThePhotonSource) {
  for (const Scene scene : kAllScenes) {
    for (const auto& [columns, rows] :
         {std::pair(200, 160), std::pair(1, 1), std::pair(1, 160), std::pair(7, 3)}) {
      SceneParameters parameters;
      parameters.columns = columns;
      parameters.rows = rows;
      parameters.reflectivity = 0.5;
      const TargetMap map = make_scene(scene, parameters);
      EXPECT_EQ(map.columns(), columns);
      EXPECT_EQ(map.rows(), rows);
      EXPECT_NO_THROW(map.validate());
      for (const PixelTarget& target : all_targets(map)) {
        ASSERT_TRUE(target.returns_signal() || scene == Scene::kSky);
        ASSERT_LE(target.reflectivity, 0.5);
      }
    }
  }
}

TEST(Scene, Flat) {
  const TargetMap map =
      make_scene(Scene::kFlat, {.columns = 3, .rows = 2, .distance_m = 2.5, .reflectivity = 0.4});
  for (const PixelTarget& target : all_targets(map)) {
    EXPECT_EQ(target, (PixelTarget{.depth_m = 2.5, .reflectivity = 0.4}));
  }
}

TEST(Scene, Staircase) {
  const TargetMap map =
      make_scene(Scene::kStaircase, {.columns = 9, .rows = 2, .near_m = 1.0, .far_m = 3.0, .steps = 3});
  const std::vector<double> expected = {1, 1, 1, 2, 2, 2, 3, 3, 3};
  for (int column = 0; column < 9; ++column) {
    EXPECT_DOUBLE_EQ(map.at(column, 0).depth_m, expected[static_cast<std::size_t>(column)]);
    EXPECT_EQ(map.at(column, 0), map.at(column, 1));
  }
  const TargetMap one = make_scene(Scene::kStaircase, {.columns = 4, .rows = 1, .near_m = 2.0, .steps = 1});
  EXPECT_EQ(one.at(3, 0).depth_m, 2.0);
}

TEST(Scene, SlantedPlane) {
  const TargetMap map =
      make_scene(Scene::kPlane, {.columns = 5, .rows = 2, .near_m = 4.0, .far_m = 2.0, .reflectivity = 0.1});
  for (int column = 0; column < 5; ++column) {
    EXPECT_DOUBLE_EQ(map.at(column, 1).depth_m, 4.0 - 0.5 * column);
    EXPECT_EQ(map.at(column, 1).reflectivity, 0.1);
  }
}

TEST(Scene, RoomHasTheStatedDepthsAndReflectivities) {
  const TargetMap map = make_scene(Scene::kRoom, {});
  double near = kInfinity;
  double far = 0.0;
  std::set<double> reflectivities;
  for (const PixelTarget& target : all_targets(map)) {
    near = std::min(near, target.depth_m);
    far = std::max(far, target.depth_m);
    reflectivities.insert(target.reflectivity);
  }
  EXPECT_NEAR(near, 0.8, 0.03);
  EXPECT_GT(far, 4.5);
  EXPECT_LT(far, 5.0);
  // Four kinds of wall (left and right are alike), the sphere, four boxes.
  EXPECT_EQ(reflectivities.size(), 9U);
  EXPECT_EQ(*reflectivities.begin(), 0.2);
  EXPECT_EQ(*reflectivities.rbegin(), 1.0);
}

TEST(Scene, RoomGeometry) {
  const TargetMap map = make_scene(Scene::kRoom, {});
  // Ray of pixel (column, row) in degrees, 0.48 a pixel.
  const auto at = [&](double yaw, double pitch) {
    return map.at(static_cast<int>(std::floor(yaw / 0.48 + 100.0)),
                  static_cast<int>(std::floor(pitch / 0.48 + 80.0)));
  };
  // Back wall at z = 4.2 m, seen right beside the middle.
  EXPECT_NEAR(at(5.0, -3.0).depth_m, 4.2 / std::cos(5.0 * std::numbers::pi / 180.0), 0.03);
  EXPECT_EQ(at(5.0, -3.0).reflectivity, 0.8);
  // Sphere of radius 0.5 at (-0.45, 0, 1.6): nearest towards its centre.
  EXPECT_NEAR(at(-15.7, 0.0).depth_m, std::hypot(0.45, 1.6) - 0.5, 0.002);
  EXPECT_EQ(at(-15.7, 0.0).reflectivity, 0.7);
  // Walls left and right at 2.2 m, ceiling and floor at 1.4 m.
  EXPECT_NEAR(at(47.8, -1.0).depth_m, 2.2 / std::sin(47.8 * std::numbers::pi / 180.0), 0.03);
  EXPECT_NEAR(at(-47.8, -1.0).depth_m, 2.2 / std::sin(47.8 * std::numbers::pi / 180.0), 0.03);
  EXPECT_NEAR(at(10.0, -38.2).depth_m, 1.4 / std::sin(38.2 * std::numbers::pi / 180.0), 0.03);
  EXPECT_EQ(at(10.0, -38.2).reflectivity, 1.0);
  EXPECT_EQ(at(-10.0, 38.2).reflectivity, 0.3);
  // The dark box's front at z = 0.78 m.
  EXPECT_NEAR(at(24.0, 22.0).depth_m,
              0.78 / std::cos(24.0 * std::numbers::pi / 180.0) / std::cos(22.0 * std::numbers::pi / 180.0),
              0.02);
  EXPECT_EQ(at(24.0, 22.0).reflectivity, 0.2);
}

TEST(Scene, RoomLooksTheSameOnASmallerArray) {
  const TargetMap full = make_scene(Scene::kRoom, {});
  // 40 x 32: the middle of a pixel is that of the third of five pixels.
  const TargetMap fifth = make_scene(Scene::kRoom, {.columns = 40, .rows = 32});
  for (int column = 0; column < 40; ++column) {
    for (int row = 0; row < 32; ++row) {
      ASSERT_NEAR(fifth.at(column, row).depth_m, full.at(5 * column + 2, 5 * row + 2).depth_m, 1e-9);
    }
  }
}

TEST(Scene, PlanesDifferInSlopeAndReflectivity) {
  const TargetMap map = make_scene(Scene::kPlanes, {});
  std::set<double> reflectivities;
  for (int column = 0; column < 200; ++column) {
    const double step = map.at(column, 1).depth_m - map.at(column, 0).depth_m;
    for (int row = 1; row < 160; ++row) {
      ASSERT_NEAR(map.at(column, row).depth_m - map.at(column, row - 1).depth_m, step, 1e-9);
      ASSERT_GE(map.at(column, row).depth_m, 0.5);
      ASSERT_LE(map.at(column, row).depth_m, 5.0);
    }
    reflectivities.insert(map.at(column, 0).reflectivity);
  }
  EXPECT_EQ(reflectivities.size(), 28U);
  EXPECT_NEAR(*reflectivities.begin(), 0.1, 1e-12);
  EXPECT_NEAR(*reflectivities.rbegin(), 0.9, 1e-12);
}

TEST(Scene, ClutterHasManyDepthsInEightPixels) {
  const TargetMap map = make_scene(Scene::kClutter, {});
  int crowded = 0;
  for (int column = 0; column < 200; ++column) {
    for (int group = 0; group < 20; ++group) {
      std::set<int> depths;
      for (int row = 8 * group; row < 8 * group + 8; ++row) {
        depths.insert(static_cast<int>(map.at(column, row).depth_m / 0.3));
        ASSERT_GE(map.at(column, row).depth_m, 0.8);
        ASSERT_LE(map.at(column, row).depth_m, 4.5);
      }
      crowded += depths.size() > 3 ? 1 : 0;
    }
  }
  EXPECT_GT(crowded, 4000 / 20);
}

TEST(Scene, PolesCoverAPartOfTheWall) {
  const TargetMap map = make_scene(Scene::kPoles, {});
  const std::vector<PixelTarget> targets = all_targets(map);
  const auto wall = std::ranges::count(targets, 4.0, &PixelTarget::depth_m);
  EXPECT_GT(wall, 200 * 160 / 4);
  EXPECT_LT(wall, 200 * 160 * 9 / 10);
  for (const PixelTarget& target : targets) {
    ASSERT_TRUE(target.depth_m == 4.0 || (target.depth_m >= 0.8 && target.depth_m <= 3.5));
  }
}

TEST(Scene, IsolatedPixelsHaveNoNeighbour) {
  const TargetMap map = make_scene(Scene::kIsolated, {});
  int isolated = 0;
  for (int column = 0; column < 200; ++column) {
    for (int row = 0; row < 160; ++row) {
      if (map.at(column, row).depth_m == 3.0) {
        ++isolated;
        EXPECT_TRUE(row == 0 || map.at(column, row - 1).depth_m == 4.0);
        EXPECT_TRUE(column == 0 || map.at(column - 1, row).depth_m == 4.0);
      }
    }
  }
  EXPECT_EQ(isolated, 200 * 160 / 20);
}

TEST(Scene, SkyHasNoReturnAboveWallBoxesAndPoles) {
  const TargetMap map = make_scene(Scene::kSky, {});
  for (int column = 0; column < 200; ++column) {
    const int place = column % 34;
    // Row 0 is sky but for the poles; the last one has a target everywhere.
    EXPECT_EQ(map.at(column, 0).returns_signal(), place == 18 || place == 26 || place == 27) << column;
    EXPECT_TRUE(map.at(column, 159).returns_signal());
    EXPECT_EQ(map.at(column, 84).returns_signal(), true);
    EXPECT_EQ(map.at(column, 67).returns_signal(),
              (place >= 4 && place < 12) || map.at(column, 0).returns_signal());
  }
  EXPECT_EQ(map.at(0, 0).reflectivity, 1.0);
  EXPECT_EQ(map.at(0, 159), (PixelTarget{.depth_m = 4.0, .reflectivity = 0.5}));
  EXPECT_EQ(map.at(5, 67), (PixelTarget{.depth_m = 3.0, .reflectivity = 0.5}));
  EXPECT_FALSE(map.at(5, 65).returns_signal());
  EXPECT_EQ(map.at(18, 0).depth_m, 2.0);
  EXPECT_EQ(map.at(27, 0).depth_m, 3.0);
}

TEST(Scene, ShapesDependOnTheSeedAlone) {
  for (const Scene scene : {Scene::kPlanes, Scene::kClutter, Scene::kPoles}) {
    EXPECT_EQ(make_scene(scene, {.seed = 7}), make_scene(scene, {.seed = 7}));
    EXPECT_FALSE(make_scene(scene, {.seed = 7}) == make_scene(scene, {.seed = 8}));
  }
}

TEST(Scene, RefusesBadParameters) {
  for (const double bad : {kNan, kInfinity, -1.0, 0.0}) {
    EXPECT_THAT(refusal([&] { make_scene(Scene::kFlat, {.distance_m = bad}); }), HasSubstr("distance"));
    EXPECT_THAT(refusal([&] { make_scene(Scene::kStaircase, {.near_m = bad}); }), HasSubstr("near"));
    EXPECT_THAT(refusal([&] { make_scene(Scene::kPlane, {.far_m = bad}); }), HasSubstr("far"));
    // Parameters that a scene does not use do not matter.
    EXPECT_EQ(refusal([&] { make_scene(Scene::kRoom, {.distance_m = bad}); }), "accepted");
  }
  for (const Scene scene : kAllScenes) {
    for (const double bad : {kNan, kInfinity, -0.1}) {
      EXPECT_THAT(refusal([&] { make_scene(scene, {.reflectivity = bad}); }), HasSubstr("reflectivity"));
    }
    EXPECT_THAT(refusal([&] { make_scene(scene, {.columns = 0}); }), HasSubstr("0 x 160"));
    EXPECT_EQ(refusal([&] { make_scene(scene, {.reflectivity = 0.0}); }), "accepted");
  }
  EXPECT_THAT(refusal([] { make_scene(Scene::kStaircase, {.steps = 0}); }), HasSubstr("at least 1 step"));
}

TEST(DepthImageScene, SameSizeIsCopied) {
  const std::vector<float> metres = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F};
  const TargetMap map = scene_from_depth_image(3, 2, metres, 3, 2, 0.25);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 2; ++row) {
      EXPECT_EQ(map.at(column, row),
                (PixelTarget{.depth_m = 1.0 + column + 3.0 * row, .reflectivity = 0.25}));
    }
  }
}

TEST(DepthImageScene, IsResampledToTheNearestPixel) {
  const std::vector<float> metres = {1.0F, 2.0F, 3.0F, 4.0F};
  const TargetMap larger = scene_from_depth_image(2, 2, metres, 4, 6);
  EXPECT_EQ(larger.at(0, 0).depth_m, 1.0);
  EXPECT_EQ(larger.at(1, 2).depth_m, 1.0);
  EXPECT_EQ(larger.at(2, 2).depth_m, 2.0);
  EXPECT_EQ(larger.at(1, 3).depth_m, 3.0);
  EXPECT_EQ(larger.at(3, 5).depth_m, 4.0);
  const std::vector<float> line = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F};
  const TargetMap smaller = scene_from_depth_image(6, 1, line, 2, 1);
  EXPECT_EQ(smaller.at(0, 0).depth_m, 2.0);
  EXPECT_EQ(smaller.at(1, 0).depth_m, 5.0);
}

TEST(DepthImageScene, UnknownDepthIsNoTarget) {
  const std::vector<float> metres = {0.0F, std::numeric_limits<float>::quiet_NaN(),
                                     std::numeric_limits<float>::infinity(), 1.0F};
  const TargetMap map = scene_from_depth_image(4, 1, metres, 4, 1);
  EXPECT_NO_THROW(map.validate());
  for (int column = 0; column < 3; ++column) {
    EXPECT_FALSE(map.at(column, 0).returns_signal());
  }
  EXPECT_TRUE(map.at(3, 0).returns_signal());
}

TEST(ReflectivityMap, IsResampledToTheNearestPixelAndKeepsDistances) {
  TargetMap map(4, 2, {.depth_m = 3.0, .reflectivity = 1.0});
  const std::array<float, 4> values = {0.25F, 0.5F, 0.75F, 1.0F};
  set_reflectivity(map, 2, 2, values);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 2; ++row) {
      EXPECT_EQ(map.at(column, row), (PixelTarget{3.0, 0.25 + (column < 2 ? 0.0 : 0.25) + 0.5 * row}));
    }
  }
  EXPECT_THAT(refusal([&] { set_reflectivity(map, 3, 1, values); }), HasSubstr("4 values"));
  const std::array<float, 1> negative = {-0.5F};
  EXPECT_THAT(refusal([&] { set_reflectivity(map, 1, 1, negative); }), HasSubstr("-0.5"));
}

TEST(TransientScene, HasTheStrongestReturnAsItsTruthAndIsResampled) {
  // 1 row, 3 columns, 6 bins of 1 ns: nothing, one return, a weak one before a strong one.
  const std::vector<double> events = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 1, 0, 0, 0, 2, 0};
  const std::array<std::size_t, 3> shape = {1, 3, 6};
  const TransientScale scale{.bin_width_s = 1e-9, .start_s = 10e-9, .events_per_unit = 0.01};
  const TargetMap map = scene_from_transient_cube(shape, events, scale, 1e-9, 6, 2, 0.3);
  const double metres_per_ns = 0.5e-9 * kSpeedOfLight;
  for (int column = 0; column < 6; ++column) {
    SCOPED_TRACE(column);
    EXPECT_EQ(map.returns_signal(column, 1), column >= 2);
    EXPECT_EQ(map.at(column, 1).reflectivity, 0.3);
    EXPECT_NEAR(map.at(column, 1).depth_m, column < 2 ? 0.0 : 14.5 * metres_per_ns, 1e-9);
    EXPECT_DOUBLE_EQ(map.cube()->light(column, 1).events(), column < 2 ? 0.0 : column < 4 ? 0.04 : 0.03);
  }
  EXPECT_NEAR(map.cube()->first_return(5, 0, 1e-9).distance_m, 10.5 * metres_per_ns, 1e-9);
  // Without sunlight the laser's light remains.
  EXPECT_TRUE(scene_from_transient_cube(shape, events, scale, 1e-9, 3, 1, 0.0).returns_signal(1, 0));
  // A last axis of one element is no axis.
  const std::array<std::size_t, 4> channel = {1, 3, 6, 1};
  EXPECT_EQ(scene_from_transient_cube(channel, events, scale, 1e-9, 3, 1).at(1, 0).depth_m,
            map.at(2, 0).depth_m);
}

TEST(TransientScene, RefusesBadCubes) {
  const TransientScale scale{.bin_width_s = 1e-9};
  const auto with = [&](std::vector<std::size_t> shape, std::vector<double> events) {
    return refusal([&] { (void)scene_from_transient_cube(shape, events, scale, 1e-9, 2, 2); });
  };
  EXPECT_THAT(with({2, 2}, std::vector<double>(4)),
              HasSubstr("shape (2, 2): a transient cube has rows, columns"));
  EXPECT_THAT(with({1, 1, 2, 3}, std::vector<double>(6)), HasSubstr("no colours"));
  EXPECT_THAT(with({0, 1, 2}, {}), HasSubstr("1 to 65535 rows and columns"));
  EXPECT_THAT(with({1, 1, 2}, std::vector<double>(3)), HasSubstr("cannot have 3 values"));
  // Also where the array does not look.
  EXPECT_THAT(with({1, 5, 1}, {1, 1, 1, 1, -1}), HasSubstr("column 4, row 0, bin 0: -1"));
  EXPECT_THAT(with({1, 1, 2}, {0, kNan}), HasSubstr("column 0, row 0, bin 1: nan"));
}

TEST(DepthImageScene, RefusesBadImages) {
  const std::vector<float> metres = {1.0F, -2.0F};
  EXPECT_THAT(refusal([&] { scene_from_depth_image(3, 1, metres, 2, 2); }), HasSubstr("2 values"));
  EXPECT_THAT(refusal([&] { scene_from_depth_image(0, 0, {}, 2, 2); }), HasSubstr("0 x 0"));
  EXPECT_THAT(refusal([&] { scene_from_depth_image(2, 1, metres, 2, 2); }),
              HasSubstr("(column 1, row 0): negative"));
  EXPECT_THAT(refusal([&] {
                scene_from_depth_image(1, 1, {metres.data(), 1}, 2, 2, kNan);
              }),
              HasSubstr("reflectivity"));
}

}  // namespace
}  // namespace dtof
