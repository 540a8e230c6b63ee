// SPDX-License-Identifier: Apache-2.0
#include "sensor/sensor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "core/error.hpp"
#include "sensor/preset.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kLeast =
    "[tdc]\nrange_ns = 60\n[laser]\nacquisitions = 500\npulse_fwhm_ns = 1.5\n"
    "[light]\nsignal_events_at_1m = 0.1\nbackground_events_per_klux = 0.02\n";

std::string refusal(const std::string& text) {
  try {
    (void)parse_sensor(text, "my.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// kLeast with one part of it replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = kLeast;
  return text.replace(text.find(from), from.size(), to);
}

TEST(SensorFile, WhatIsNotNamedIsOffOrHasItsDefault) {
  const SensorModel sensor = parse_sensor(kLeast, "folder/my.toml");
  EXPECT_EQ(sensor.name, "my");
  EXPECT_DOUBLE_EQ(sensor.integration_time_s, 60e-9);
  EXPECT_DOUBLE_EQ(sensor.pulse_fwhm_s, 1.5e-9);
  EXPECT_EQ(sensor.acquisitions, 500U);
  EXPECT_DOUBLE_EQ(sensor.signal_events(2.0, 0.5), 0.1 / 8.0);
  EXPECT_DOUBLE_EQ(sensor.background_events(10.0, 0.5), 0.1);
  EXPECT_EQ(sensor.np, 10);
  EXPECT_EQ(sensor.slots, 2);
  EXPECT_EQ(sensor.columns, 200);
  EXPECT_EQ(sensor.rows, 160);
  EXPECT_DOUBLE_EQ(sensor.degrees_per_pixel(), 0.48);
  EXPECT_DOUBLE_EQ(sensor.default_reflectivity, 1.0);
  EXPECT_DOUBLE_EQ(sensor.dark_count_rate_hz, 0.0);
  EXPECT_DOUBLE_EQ(sensor.dead_time_s, 0.0);
}

TEST(SensorFile, EveryKeyReachesTheModel) {
  const SensorModel sensor = parse_sensor(
      "name = \"demo\"\n[array]\ncolumns = 32\nrows = 24\nfield_of_view_deg = 48\n[tdc]\nrange_ns = 100\n"
      "timestamp_bits = 12\nslots = 4\n[laser]\nacquisitions = 9\npulse_fwhm_ns = 0.7\n[light]\n"
      "signal_events_at_1m = 2\nbackground_events_per_klux = 3\ndefault_reflectivity = 0.4\n[detector]\n"
      "dark_count_rate_hz = 500\ndead_time_ns = 20\n",
      "my.toml");
  EXPECT_EQ(sensor.name, "demo");
  EXPECT_EQ(sensor.columns, 32);
  EXPECT_EQ(sensor.rows, 24);
  EXPECT_DOUBLE_EQ(sensor.field_of_view_deg, 48.0);
  EXPECT_EQ(sensor.np, 12);
  EXPECT_EQ(sensor.slots, 4);
  EXPECT_DOUBLE_EQ(sensor.integration_time_s, 100e-9);
  EXPECT_DOUBLE_EQ(sensor.signal_events_1m, 2.0);
  EXPECT_DOUBLE_EQ(sensor.background_events_per_klux, 3.0);
  EXPECT_DOUBLE_EQ(sensor.default_reflectivity, 0.4);
  EXPECT_DOUBLE_EQ(sensor.dark_count_rate_hz, 500.0);
  EXPECT_DOUBLE_EQ(sensor.dead_time_s, 20e-9);
}

TEST(SensorFile, OpticsGiveTheRates) {
  const std::string optics =
      "[optics]\npeak_power_w = 20\nwavelength_nm = 905\nlens_area_mm2 = 1.16\nlens_efficiency = 0.7\n"
      "photon_detection_efficiency = 0.2\nfilter_width_nm = 1\nsolar_irradiance_mw_per_m2_nm_klux = 6.3\n";
  const std::string rest = "[tdc]\nrange_ns = 45\n[laser]\nacquisitions = 3333\npulse_fwhm_ns = 2\n";
  const SensorModel sensor = parse_sensor(rest + optics, "my.toml");
  // Spec section 4's worked figures of this system: 0.200 signal events, 0.042 sunlight events at 14 klux.
  EXPECT_NEAR(sensor.signal_events_1m, 0.200, 1e-3);
  EXPECT_NEAR(14.0 * sensor.background_events_per_klux, 0.042, 5e-4);
  EXPECT_THAT(refusal(rest + optics + "[light]\nsignal_events_at_1m = 1\n"),
              HasSubstr("follows from [optics]"));
  EXPECT_THAT(refusal(rest + "[optics]\npeak_power_w = 20\n"), HasSubstr("[optics] has no wavelength_nm"));
}

TEST(SensorFile, UnknownKeysAreRefusedWithTheNearest) {
  EXPECT_THAT(refusal(with("pulse_fwhm_ns = 1.5", "pulse_fwmh_ns = 1.5")), StartsWith("my.toml:5: "));
  EXPECT_THAT(refusal(with("pulse_fwhm_ns = 1.5", "pulse_fwmh_ns = 1.5")),
              HasSubstr("did you mean 'pulse_fwhm_ns'"));
  EXPECT_THAT(refusal(with("[laser]", "[lasre]")),
              HasSubstr("my.toml:3: unknown section 'lasre'; did you mean 'laser'"));
  EXPECT_THAT(refusal(with("[laser]", "[laser]\nrange_ns = 3")),
              HasSubstr("my.toml:4: range_ns belongs to [tdc], not to [laser]"));
  EXPECT_THAT(refusal(std::string("nmae = \"x\"\n") + kLeast),
              HasSubstr("my.toml:1: unknown key outside of a section 'nmae'; did you mean 'name'"));
  EXPECT_THAT(refusal("laser = 3\n"), HasSubstr("must be a section"));
}

TEST(SensorFile, WrongTypesAndValuesAreRefusedWithTheLine) {
  EXPECT_THAT(refusal(with("range_ns = 60", "range_ns = \"60\"")),
              StartsWith("my.toml:2: range_ns must be a number"));
  EXPECT_THAT(refusal(with("acquisitions = 500", "acquisitions = 500.5")),
              StartsWith("my.toml:4: acquisitions must be a whole number"));
  EXPECT_THAT(refusal(with("range_ns = 60", "range_ns = 0")),
              HasSubstr("range_ns is 0, but must be above 0 to 1000000"));
  EXPECT_THAT(refusal(with("range_ns = 60", "range_ns = nan")), HasSubstr("range_ns is nan"));
  EXPECT_THAT(refusal(with("range_ns = 60", "range_ns = inf")), HasSubstr("range_ns is inf"));
  EXPECT_THAT(refusal(with("acquisitions = 500", "acquisitions = -1")), HasSubstr("acquisitions is -1"));
  EXPECT_THAT(refusal(with("[light]", "[light]\ndefault_reflectivity = 5")),
              HasSubstr("a white matt surface"));
  EXPECT_THAT(refusal(std::string("name = 3\n") + kLeast), HasSubstr("name must be text"));
  EXPECT_THAT(refusal(std::string("name = \"a/b\"\n") + kLeast), HasSubstr("name must"));
  EXPECT_THAT(refusal(with("pulse_fwhm_ns = 1.5", "pulse_fwhm_ns = 60")),
              HasSubstr("does not fit into a range of 60 ns"));
}

TEST(SensorFile, MissingKeysAreNamed) {
  EXPECT_THAT(refusal(with("range_ns = 60", "")), HasSubstr("[tdc] has no range_ns"));
  EXPECT_THAT(refusal("[tdc]\nrange_ns = 60\n"), HasSubstr("[laser] has no acquisitions"));
  EXPECT_THAT(refusal(with("signal_events_at_1m = 0.1", "")),
              HasSubstr("[light] has no signal_events_at_1m"));
}

TEST(SensorFile, WhatIsNoTomlIsRefusedWithTheLine) {
  EXPECT_THAT(refusal("[tdc]\nrange_ns = = 3\n"), StartsWith("my.toml:2: no TOML: "));
  EXPECT_THAT(refusal("[tdc]\nrange_ns = 1\nrange_ns = 2\n"), StartsWith("my.toml:3: no TOML: "));
  EXPECT_THAT(refusal(std::string("\xff\xfe\x00", 3)), HasSubstr("no TOML"));
}

TEST(SensorFile, FindSensorTakesPresetsAndFiles) {
  EXPECT_EQ(find_sensor("phone").name, "phone");
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "found.toml";
  std::ofstream(path) << kLeast;
  EXPECT_EQ(find_sensor(path.string()).acquisitions, 500U);
  std::filesystem::remove(path);
  EXPECT_THROW(find_sensor(path.string()), InputError);
}

TEST(SensorFile, TheDocumentHoldsTheTableOfKeys) {
  std::ifstream file(DTOF_SENSOR_DOCUMENT);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_THAT(text, HasSubstr(sensor_key_table())) << "print it with `dtof sensor --keys`";
}

}  // namespace
}  // namespace dtof
