// SPDX-License-Identifier: Apache-2.0
#include "photon/preset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/error.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Preset, ThesisCalibration) {
  const SensorModel model = parse_preset("thesis");
  EXPECT_EQ(model.acquisitions, 3333U);
  EXPECT_EQ(model.np, 10);
  EXPECT_EQ(model.slots, 2);
  EXPECT_DOUBLE_EQ(model.default_reflectivity, 1.0);
  EXPECT_DOUBLE_EQ(model.signal_events(1.0, 1.0), 0.30);
  EXPECT_DOUBLE_EQ(model.signal_events(2.0, 0.5), 0.0375);
  EXPECT_DOUBLE_EQ(model.background_events(14.0, 1.0), 0.15 + 4.5e-4);
  EXPECT_DOUBLE_EQ(model.background_events(28.0, 0.5), 0.15 + 4.5e-4);
  EXPECT_NEAR(model.time_resolution_s(), 43.9e-12, 0.1e-12);
}

TEST(Preset, PhoneIsDerived) {
  const SensorModel model = parse_preset("phone");
  EXPECT_DOUBLE_EQ(model.default_reflectivity, 0.5);
  EXPECT_EQ(model.acquisitions, 3333U);
  // A photon of 940 nm carries 905/940 of the energy; 2.8 instead of 6.3 mW/m2/nm, 20 nm instead of 1.
  EXPECT_NEAR(model.signal_events(1.0, 1.0), 0.200 * 940.0 / 905.0, 0.001);
  EXPECT_NEAR(model.background_events(14.0, 1.0), 0.042 * 940.0 / 905.0 * 2.8 / 6.3 * 20.0 + 4.5e-4, 0.003);
}

TEST(Preset, UnknownNameListsTheKnown) {
  EXPECT_THAT(preset_names(), ElementsAre("thesis", "phone"));
  const std::string message = refusal([] { parse_preset("tablet"); });
  EXPECT_THAT(message, HasSubstr("tablet"));
  EXPECT_THAT(message, HasSubstr("thesis, phone"));
}

TEST(Preset, EveryPresetIsLegal) {
  for (const std::string_view name : preset_names()) {
    EXPECT_NO_THROW(parse_preset(name).validate()) << name;
    EXPECT_EQ(parse_preset(name).name, name);
  }
}

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
      SensorModel model = parse_preset("thesis");
      test.set(model, value);
      EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr(test.word)) << value;
    }
    SensorModel model = parse_preset("thesis");
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
}

TEST(SensorModel, RefusesGatesOutsideTheRange) {
  SensorModel model = parse_preset("thesis");
  model.time_gate = TimeGate{10e-9, 46e-9};
  EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("time gate"));
  model.time_gate = TimeGate{10e-9, 10e-9};
  EXPECT_THAT(refusal([&] { model.validate(); }), HasSubstr("time gate"));
  model.time_gate = TimeGate{0.0, 45e-9};
  EXPECT_NO_THROW(model.validate());
}

}  // namespace
}  // namespace dtof
