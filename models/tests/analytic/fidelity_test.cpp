// SPDX-License-Identifier: Apache-2.0
#include "dtof/analytic/fidelity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

PhotonSource flat(double depth_m, double dead_time_s = 0.0) {
  SensorModel sensor = parse_preset("thesis");
  sensor.dead_time_s = dead_time_s;
  return {sensor, TargetMap(20, 20, {.depth_m = depth_m, .reflectivity = 1.0}), 14.0, 1};
}

FidelityRequest sampled(double tolerance, std::span<const Readout> readouts) {
  return {.tolerance = tolerance, .use = PhotonUse::kSampler, .readouts = readouts};
}

TEST(Fidelity, AutoTakesTheFastSamplerWhereItsLimitIsWithinTheTolerance) {
  const PhotonSource scene = flat(1.0);
  for (const Readout readout : kThesisReadouts) {
    const std::span<const Readout> one(&readout, 1);
    const double limit = fast_sampler_difference(readout);
    EXPECT_GT(limit, 0.0);
    const Fidelity cheaper = fast_sampler_cost(readout) < 1.0 ? Fidelity::kFast : Fidelity::kExact;
    EXPECT_EQ(choose_fidelity(scene, sampled(limit, one)), cheaper);
    EXPECT_EQ(choose_fidelity(scene, sampled(0.999 * limit, one)), Fidelity::kExact);
    EXPECT_EQ(choose_fidelity(scene, sampled(0.0, one)), Fidelity::kExact);
  }
}

TEST(Fidelity, AutoKeepsTheToleranceForEveryReadoutOfTheFrame) {
  double largest = 0.0;
  for (const Readout readout : kThesisReadouts) {
    largest = std::max(largest, fast_sampler_difference(readout));
  }
  EXPECT_EQ(choose_fidelity(flat(1.0), sampled(largest, kThesisReadouts)), Fidelity::kFast);
  EXPECT_EQ(choose_fidelity(flat(1.0), sampled(0.999 * largest, kThesisReadouts)), Fidelity::kExact);
  EXPECT_EQ(choose_fidelity(flat(1.0), sampled(1.0, kAllReadouts)), Fidelity::kExact)
      << "poolPointer's differences were not measured";
}

TEST(Fidelity, OneDearReadoutDoesNotSpoilAFrameOfCheapOnes) {
  EXPECT_GT(fast_sampler_cost(Readout::kPifh), 1.0);
  const std::array both = {Readout::kPifh, Readout::kHisPointer};
  const std::array three = {Readout::kPifh, Readout::kHisPointer, Readout::kSifh};
  EXPECT_EQ(choose_fidelity(flat(1.0), sampled(1.0, both)), Fidelity::kExact);
  EXPECT_EQ(choose_fidelity(flat(1.0), sampled(1.0, three)), Fidelity::kFast);
}

TEST(Fidelity, StreamsAreExact) {
  EXPECT_EQ(choose_fidelity(flat(1.0), {.tolerance = 1.0, .use = PhotonUse::kStream, .readouts = {}}),
            Fidelity::kExact);
}

TEST(Fidelity, BeyondWhatWasMeasuredOnlyTheExactModelIsTaken) {
  const Readout readout = Readout::kHisPointer;
  const FidelityRequest request = sampled(1.0, std::span(&readout, 1));
  EXPECT_EQ(choose_fidelity(flat(1.0, 1e-9), request), Fidelity::kExact) << "dead time";
  EXPECT_EQ(choose_fidelity(flat(0.2), request), Fidelity::kExact) << "too bright";
  const auto with = [&](auto change) {
    SensorModel sensor = parse_preset("thesis");
    change(sensor);
    return choose_fidelity({sensor, TargetMap(2, 2, {.depth_m = 1.0}), 14.0, 1}, request);
  };
  EXPECT_EQ(with([](SensorModel&) {}), Fidelity::kFast);
  EXPECT_EQ(with([](SensorModel& sensor) { sensor.np = 11; }), Fidelity::kExact);
  EXPECT_EQ(with([](SensorModel& sensor) { sensor.pulse_fwhm_s = 1e-9; }), Fidelity::kExact);
  EXPECT_EQ(with([](SensorModel& sensor) { sensor.jitter_fwhm_s = 1e-9; }), Fidelity::kExact);
  EXPECT_EQ(with([](SensorModel& sensor) { sensor.time_gate = {0.0, 20e-9}; }), Fidelity::kExact);
  EXPECT_EQ(with([](SensorModel& sensor) { sensor.slots = 4; }), Fidelity::kExact);
  EXPECT_EQ(with([](SensorModel& sensor) { sensor.acquisitions = 100; }), Fidelity::kExact);
  EXPECT_EQ(with([](SensorModel& sensor) { sensor.background_events_per_klux = 1.0; }), Fidelity::kExact);
}

TEST(Fidelity, OnlyTheExactModelHasADeadTime) {
  EXPECT_THROW(make_source(Fidelity::kFast, flat(1.0, 1e-9)), InputError);
  EXPECT_THROW(make_source(Fidelity::kAnalytic, flat(1.0, 1e-9)), InputError);
}

TEST(Fidelity, AutoNeverTakesAModelWithoutNoise) {
  for (const double depth : {0.0, 1.0, 5.0}) {
    EXPECT_NE(choose_fidelity(flat(depth), sampled(1e9, kThesisReadouts)), Fidelity::kAnalytic);
  }
}

TEST(Fidelity, NamesAndRefusals) {
  const PhotonSource scene = flat(1.0);
  for (const Fidelity fidelity : {Fidelity::kExact, Fidelity::kFast, Fidelity::kAnalytic}) {
    EXPECT_EQ(parse_fidelity(fidelity_name(fidelity), scene, {}), fidelity);
    EXPECT_EQ(make_source(fidelity, scene)->columns(), 20);
  }
  EXPECT_EQ(parse_fidelity("auto", scene, sampled(1.0, kThesisReadouts)), Fidelity::kFast);
  try {
    parse_fidelity("quick", scene, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("'quick': known are exact, fast, analytic and auto"));
  }
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(parse_fidelity("auto", scene, sampled(bad, kThesisReadouts)), InputError);
  }
}

}  // namespace
}  // namespace dtof
