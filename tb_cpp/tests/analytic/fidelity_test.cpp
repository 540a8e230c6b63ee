// SPDX-License-Identifier: Apache-2.0
#include "analytic/fidelity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "sensor/preset.hpp"

namespace dtof {
namespace {

PhotonSource flat(double depth_m, double dead_time_s = 0.0) {
  SensorModel sensor = parse_preset("thesis");
  sensor.dead_time_s = dead_time_s;
  return {sensor, TargetMap(20, 20, {.depth_m = depth_m, .reflectivity = 1.0}), 14.0, 1};
}

TEST(Fidelity, AutoTakesTheCheapestThatIsGoodEnough) {
  const PhotonSource scene = flat(1.0);
  EXPECT_EQ(choose_fidelity(scene, 0.0), Fidelity::kExact);
  EXPECT_EQ(choose_fidelity(scene, 1e-9), Fidelity::kExact);
  EXPECT_EQ(choose_fidelity(scene, 1e-3), Fidelity::kFast);
  EXPECT_EQ(choose_fidelity(scene, 0.5), Fidelity::kAnalytic);
  for (const Fidelity fidelity : {Fidelity::kFast, Fidelity::kAnalytic}) {
    const double error = model_error(fidelity, scene);
    EXPECT_LE(choose_fidelity(scene, error), Fidelity::kAnalytic);
    EXPECT_GE(choose_fidelity(scene, error), fidelity);
    EXPECT_LT(choose_fidelity(scene, error * 0.999), fidelity);
  }
}

TEST(Fidelity, NoisierScenesNeedAMoreExactModel) {
  EXPECT_GT(model_error(Fidelity::kAnalytic, flat(5.0)), model_error(Fidelity::kAnalytic, flat(1.0)));
  EXPECT_EQ(model_error(Fidelity::kExact, flat(5.0)), 0.0);
}

TEST(Fidelity, OnlyTheExactModelHasADeadTime) {
  EXPECT_EQ(choose_fidelity(flat(1.0, 1e-9), 1.0), Fidelity::kExact);
  EXPECT_THROW(make_source(Fidelity::kFast, flat(1.0, 1e-9)), InputError);
  EXPECT_THROW(make_source(Fidelity::kAnalytic, flat(1.0, 1e-9)), InputError);
}

TEST(Fidelity, AnEmptySceneHasNoError) {
  EXPECT_EQ(model_error(Fidelity::kAnalytic, flat(0.0)), 0.0);
  EXPECT_EQ(choose_fidelity(flat(0.0), 1e-12), Fidelity::kAnalytic);
}

TEST(Fidelity, NamesAndRefusals) {
  const PhotonSource scene = flat(1.0);
  for (const Fidelity fidelity : {Fidelity::kExact, Fidelity::kFast, Fidelity::kAnalytic}) {
    EXPECT_EQ(parse_fidelity(fidelity_name(fidelity), scene, 0.0), fidelity);
    EXPECT_EQ(make_source(fidelity, scene)->columns(), 20);
  }
  EXPECT_EQ(parse_fidelity("auto", scene, 1e-3), Fidelity::kFast);
  try {
    parse_fidelity("quick", scene, 0.0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("'quick': known are exact, fast, analytic and auto"));
  }
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(parse_fidelity("auto", scene, bad), InputError);
  }
}

}  // namespace
}  // namespace dtof
