// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/sensor_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "tests/core/refusal.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(SensorModel, RefusesBadPhysics) {
  struct Case {
    const char* word;
    std::function<void(SensorModel&, double)> set;
    bool zero_allowed;
  };
  const std::vector<Case> cases = {
      {"integration time", [](SensorModel& m, double v) { m.integration_time_s = v; }, false},
      {"pulse FWHM", [](SensorModel& m, double v) { m.pulse_fwhm_s = v; }, false},
      {"signal events", [](SensorModel& m, double v) { m.signal_events_1m = v; }, true},
      {"background events", [](SensorModel& m, double v) { m.background_events_per_klux = v; }, true},
      {"dark count rate", [](SensorModel& m, double v) { m.dark_count_rate_hz = v; }, true},
      {"dead time", [](SensorModel& m, double v) { m.dead_time_s = v; }, true},
      {"reflectivity", [](SensorModel& m, double v) { m.default_reflectivity = v; }, true},
      {"coincidence window", [](SensorModel& m, double v) { m.coincidence_window_s = v; }, true},
      {"time gate",
       [](SensorModel& m, double v) {
         m.time_gate = TimeGate{v, 20e-9};
       },
       true},
      {"time gate",
       [](SensorModel& m, double v) {
         m.time_gate = TimeGate{0.0, v};
       },
       false},
  };
  for (const Case& test : cases) {
    for (const double value : {kNan, kInfinity, -kInfinity, -1e-9}) {
      SensorModel model = SensorModel();
      test.set(model, value);
      EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr(test.word)) << value;
    }
    SensorModel model = SensorModel();
    test.set(model, 0.0);
    EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr(test.zero_allowed ? "accepted" : test.word));
  }
}

TEST(SensorModel, RefusesImpossibleIntegers) {
  for (const int np : {-1, 2, 17}) {
    SensorModel model;
    model.np = np;
    EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("NP"));
  }
  SensorModel model;
  model.slots = 0;
  EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("SLOTS"));
  model = SensorModel();
  model.binning = 0;
  EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("binning"));
  model.binning = 201;
  EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("binning must be at most 200"));
  model.binning = 200;
  model.validate();
}

TEST(SensorModel, RefusesGatesOutsideTheRange) {
  SensorModel model = SensorModel();
  model.time_gate = TimeGate{10e-9, 46e-9};
  EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("time gate"));
  model.time_gate = TimeGate{10e-9, 10e-9};
  EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("time gate"));
  model.time_gate = TimeGate{0.0, 45e-9};
  EXPECT_NO_THROW(model.validate());
}

}  // namespace
}  // namespace dtof
