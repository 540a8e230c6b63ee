// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/preset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>

#include "tests/core/refusal.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

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

/// Expected events of a pixel and frame, signal and background (dark counts included), before the TDC's
/// slots.
struct FrameEvents {
  double signal;
  double background;
};

FrameEvents frame_events(const char* preset, double distance_m, double klux) {
  const SensorModel model = parse_preset(preset);
  const auto pulses = static_cast<double>(model.acquisitions);
  return {pulses * model.signal_events(distance_m, 1.0), pulses * model.background_events(klux, 1.0)};
}

TEST(Preset, FramesOfAMegahertzLaserInClosedForm) {
  // 33,333 pulses. A wall at 2 m returns a quarter of the events at 1 m; background is that of 14 klux and
  // the dark counts, 10 kHz in 45 ns.
  const FrameEvents weak = frame_events("thesis_1mhz", 2.0, 14.0);
  EXPECT_NEAR(weak.signal, 33'333 * 0.030 / 4.0, 1e-9);
  EXPECT_NEAR(weak.background, 33'333 * (0.15 + 4.5e-4), 1e-9);
  const FrameEvents full = frame_events("thesis_full", 2.0, 14.0);
  EXPECT_NEAR(full.signal, 33'333 * 0.30 / 4.0, 1e-9);
  EXPECT_NEAR(full.background, weak.background, 1e-9);
}

TEST(Preset, AMegahertzLaserHasThePowerOrTheEnergyOfThesis) {
  constexpr double kMorePulses = 33'333.0 / 3'333.0;
  for (const double klux : {0.0, 14.0, 100.0}) {
    const FrameEvents thesis = frame_events("thesis", 1.0, klux);
    const FrameEvents weak = frame_events("thesis_1mhz", 1.0, klux);
    const FrameEvents full = frame_events("thesis_full", 1.0, klux);
    EXPECT_NEAR(weak.signal / thesis.signal, kMorePulses / 10.0, 1e-9);
    EXPECT_NEAR(full.signal / thesis.signal, kMorePulses, 1e-9);
    EXPECT_NEAR(weak.background / thesis.background, kMorePulses, 1e-9);
    EXPECT_NEAR(full.background / thesis.background, kMorePulses, 1e-9);
  }
}

TEST(Preset, FramesOfAMegahertzLaserDifferFromThesisInNothingElse) {
  const SensorModel thesis = parse_preset("thesis");
  for (const char* name : {"thesis_1mhz", "thesis_full"}) {
    SensorModel model = parse_preset(name);
    EXPECT_EQ(model.acquisitions, 33'333U) << name;
    EXPECT_EQ(model.columns, thesis.columns) << name;
    EXPECT_EQ(model.rows, thesis.rows) << name;
    EXPECT_EQ(model.field_of_view_deg, thesis.field_of_view_deg) << name;
    EXPECT_EQ(model.np, thesis.np) << name;
    EXPECT_EQ(model.slots, thesis.slots) << name;
    EXPECT_EQ(model.integration_time_s, thesis.integration_time_s) << name;
    EXPECT_EQ(model.pulse_fwhm_s, thesis.pulse_fwhm_s) << name;
    EXPECT_EQ(model.dark_count_rate_hz, thesis.dark_count_rate_hz) << name;
    EXPECT_EQ(model.default_reflectivity, thesis.default_reflectivity) << name;
  }
}

TEST(Preset, PhoneIsDerived) {
  const SensorModel model = parse_preset("phone");
  EXPECT_DOUBLE_EQ(model.default_reflectivity, 0.5);
  EXPECT_EQ(model.acquisitions, 3333U);
  // A photon of 940 nm carries 905/940 of the energy; 2.8 instead of 6.3 mW/m2/nm, 20 nm instead of 1.
  EXPECT_NEAR(model.signal_events(1.0, 1.0), 0.200 * 940.0 / 905.0, 0.001);
  EXPECT_NEAR(model.background_events(14.0, 1.0), 0.042 * 940.0 / 905.0 * 2.8 / 6.3 * 20.0 + 4.5e-4, 0.003);
}

TEST(Preset, ThesisIsTheDefaultModelToTheLastBit) {
  const SensorModel preset = parse_preset("thesis");
  const SensorModel model;
  EXPECT_EQ(preset.columns, model.columns);
  EXPECT_EQ(preset.rows, model.rows);
  EXPECT_EQ(preset.field_of_view_deg, model.field_of_view_deg);
  EXPECT_EQ(preset.np, model.np);
  EXPECT_EQ(preset.slots, model.slots);
  EXPECT_EQ(preset.acquisitions, model.acquisitions);
  EXPECT_EQ(preset.integration_time_s, model.integration_time_s);
  EXPECT_EQ(preset.pulse_fwhm_s, model.pulse_fwhm_s);
  EXPECT_EQ(preset.signal_events_1m, model.signal_events_1m);
  EXPECT_EQ(preset.background_events_per_klux, model.background_events_per_klux);
  EXPECT_EQ(preset.dark_count_rate_hz, model.dark_count_rate_hz);
  EXPECT_EQ(preset.dead_time_s, model.dead_time_s);
  EXPECT_EQ(preset.default_reflectivity, model.default_reflectivity);
}

TEST(Preset, UnknownNameListsTheKnown) {
  EXPECT_THAT(preset_names(), ElementsAre("thesis", "thesis_1mhz", "thesis_full", "phone", "vl53l8ch",
                                          "vl53l9cx", "tmf8829", "ads6311"));
  const std::string message = refusal([] { parse_preset("tablet"); });
  EXPECT_THAT(message, HasSubstr("tablet"));
  EXPECT_THAT(message,
              HasSubstr("thesis, thesis_1mhz, thesis_full, phone, vl53l8ch, vl53l9cx, tmf8829, ads6311"));
}

TEST(Preset, AConditionThatIsNamedTwiceIsRefused) {
  EXPECT_EQ(refusal([] { (void)find_sensor("phone+fog+motion+fog"); }),
            "phone+fog+motion+fog: condition 'fog' is named twice");
  EXPECT_EQ(find_sensor("phone+fog+motion").name, "phone-fog-motion");
}

/// Presets of makers' sensors, whose light nobody publishes.
constexpr std::array kMakers = {"vl53l8ch", "vl53l9cx", "tmf8829", "ads6311"};

TEST(Preset, EveryNumberOfAMakersSensorHasASourceOrIsAnAssumption) {
  for (const char* const name : kMakers) {
    std::istringstream text{std::string(preset_text(name))};
    int sources = 0;
    int numbers = 0;
    for (std::string line; std::getline(text, line);) {
      if (const std::regex source("# [0-9]: .*"); std::regex_match(line, source)) {
        ++sources;
      }
      const std::regex number("[a-z0-9_]+ = [0-9].*");
      const std::regex explained(".*  # (sources? ([0-9])( and ([0-9]))?|assumption)\\b.*");
      if (!std::regex_match(line, number)) {
        continue;
      }
      ++numbers;
      std::smatch found;
      ASSERT_TRUE(std::regex_match(line, found, explained)) << name << ": " << line;
      for (const int group : {2, 4}) {
        EXPECT_LE(found[group].matched ? std::stoi(found[group]) : 1, sources) << name << ": " << line;
      }
    }
    EXPECT_GE(sources, 1) << name;
    EXPECT_GE(numbers, 11) << name;
  }
}

TEST(Preset, MakersSensorsHaveTheirPublicFigures) {
  constexpr double kMillimetresPerSecond = 299'792'458'000.0;
  const SensorModel vl53l8ch = parse_preset("vl53l8ch");
  EXPECT_EQ(vl53l8ch.columns * vl53l8ch.rows, 64);
  EXPECT_NEAR(2.0 * vl53l8ch.time_resolution_s() * kMillimetresPerSecond / 2.0, 37.5, 0.1);
  EXPECT_GT(vl53l8ch.integration_time_s * kMillimetresPerSecond / 2.0, 4000.0);
  const SensorModel vl53l9cx = parse_preset("vl53l9cx");
  EXPECT_EQ(vl53l9cx.columns * vl53l9cx.rows, 2268);
  EXPECT_NEAR(vl53l9cx.degrees_per_pixel(), 1.0, 1e-9);
  EXPECT_GT(vl53l9cx.integration_time_s * kMillimetresPerSecond / 2.0, 8800.0);
  const SensorModel tmf8829 = parse_preset("tmf8829");
  EXPECT_EQ(tmf8829.columns * tmf8829.rows, 1536);
  EXPECT_NEAR(tmf8829.time_resolution_s(), 203.75e-12, 1e-15);
  const SensorModel ads6311 = parse_preset("ads6311");
  EXPECT_EQ(ads6311.columns * ads6311.rows, 256 * 192);
  EXPECT_NEAR(ads6311.time_resolution_s(), 0.75e-9, 1e-15);
  // The assumption about the light: 25 events a frame from a white target at the longest distance.
  const std::array<double, kMakers.size()> longest_m = {4.0, 8.8, 7.5, 75.5};
  for (std::size_t i = 0; i < kMakers.size(); ++i) {
    const SensorModel sensor = parse_preset(kMakers[i]);
    EXPECT_NEAR(sensor.signal_events(longest_m[i], 1.0) * sensor.acquisitions, 25.0, 0.05) << kMakers[i];
    EXPECT_NEAR(sensor.background_events_per_klux / sensor.integration_time_s, 0.15 / 14.0 / 45e-9, 2e2)
        << kMakers[i];
  }
}

TEST(Preset, EveryPresetIsLegal) {
  for (const std::string_view name : preset_names()) {
    EXPECT_NO_THROW(parse_preset(name).validate()) << name;
    EXPECT_EQ(parse_preset(name).name, name);
  }
}

}  // namespace
}  // namespace dtof
