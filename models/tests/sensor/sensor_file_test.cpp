// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/sensor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/sensor/condition.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
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
  for (const char* number : {"4294967296", "3000000", "9223372036854775807"}) {
    EXPECT_THAT(refusal(with("acquisitions = 500", std::string("acquisitions = ") + number)),
                HasSubstr(std::string("acquisitions is ") + number + ", but must be 1 to 1048575"));
  }
  EXPECT_THAT(refusal(with("range_ns = 60", "range_ns = 4294967296")),
              HasSubstr("range_ns is 4294967296, but"));
  EXPECT_THAT(refusal(with("pulse_fwhm_ns = 1.5", "pulse_response_file = \"\"")),
              HasSubstr("pulse_response_file is empty; leave the key out if there is none"));
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

TEST(SensorFile, SurroundingsReachTheModel) {
  std::string text =
      with("[laser]",
           "column_skew_ps = 300\ncolumn_skew_pattern = \"ramp\"\npixel_skew_ps = 20\nskew_seed = 5\n"
           "[laser]\npulse_period_us = 2\nstart_up_silent_share = 0.1\nstart_up_power_drop = 0.3\n"
           "start_up_delay_ps = -70\nstart_up_time_share = 0.2\npower_drift = -0.4\n"
           "firing_offset_bits = 4\nfiring_offset_step_ns = 3\nfiring_offset_seed = 99");
  text +=
      "[cover_glass]\ncrosstalk_events = 0.05\ndistance_m = 0.02\n"
      "[fog]\nextinction_per_m = 0.1\nlidar_ratio_sr = 40\noverlap_m = 0.2\n"
      "[pane]\ndistance_m = 1.5\nreflectivity = 0.02\ntransmittance = 0.8\n"
      "[other_laser]\nevents = 0.3\nrate_offset_ppm = -6\nfirst_arrival_ns = 20\npulse_fwhm_ns = 3\n"
      "[motion]\nradial_velocity_m_per_s = -7\ncolumns_per_frame = 3.5\nrows_per_frame = -2\n";
  const SensorModel sensor = parse_sensor(text, "my.toml");
  EXPECT_DOUBLE_EQ(sensor.pulse_period(), 2e-6);
  const Surroundings expected = {
      .cover_glass = {.events = 0.05, .distance_m = 0.02},
      .fog = {.extinction_per_m = 0.1, .lidar_ratio_sr = 40.0, .overlap_m = 0.2},
      .pane = {.distance_m = 1.5, .reflectivity = 0.02, .transmittance = 0.8},
      .other_laser = {.events = 0.3,
                      .rate_offset = -6.0 / 1e6,
                      .first_arrival_s = 20.0 / 1e9,
                      .pulse_fwhm_s = 3.0 / 1e9},
      .motion = {.velocity_m_per_s = -7.0},
      .lateral = {.columns_per_frame = 3.5, .rows_per_frame = -2.0},
      .settling = {.silent_share = 0.1,
                   .power_drop = 0.3,
                   .delay_s = -70.0 / 1e12,
                   .time_share = 0.2,
                   .power_drift = -0.4},
      .skew = {.column_s = 300.0 / 1e12, .pattern = SkewPattern::kRamp, .pixel_s = 20.0 / 1e12, .seed = 5},
      .firing_offsets = {.bits = 4, .step_s = 3.0 / 1e9, .seed = 99}};
  EXPECT_EQ(sensor.surroundings, expected);
  // Sections alone have the defaults of the table.
  const Surroundings few =
      parse_sensor(std::string(kLeast) +
                       "[cover_glass]\ncrosstalk_events = 1\n[fog]\n"
                       "extinction_per_m = 1\n[pane]\ndistance_m = 1\nreflectivity = 0\n",
                   "my.toml")
          .surroundings;
  EXPECT_EQ(few.cover_glass.distance_m, 0.03);
  EXPECT_EQ(few.fog.lidar_ratio_sr, 18.8);
  EXPECT_EQ(few.fog.overlap_m, 0.1);
  EXPECT_EQ(few.pane.transmittance, 0.92);
  EXPECT_TRUE(parse_sensor(kLeast, "my.toml").surroundings.none());
}

TEST(SensorFile, SurroundingsThatCannotBeAreRefusedWithTheLine) {
  const auto section = [](const std::string& keys) { return refusal(std::string(kLeast) + keys); };
  EXPECT_THAT(section("[fog]\n"), StartsWith("my.toml:9: [fog] has no extinction_per_m"));
  EXPECT_THAT(section("[fog]\nextinction_per_m = -1\n"),
              HasSubstr("my.toml:10: extinction_per_m is -1, but must be 0 to 100"));
  EXPECT_THAT(section("[pane]\ndistance_m = 1\n"), HasSubstr("[pane] has no reflectivity"));
  EXPECT_THAT(section("[pane]\ndistance_m = 1\nreflectivity = 0.1\ntransmittance = 1.5\n"),
              StartsWith("my.toml:12: transmittance is 1.5"));
  EXPECT_THAT(section("[other_laser]\nrate_offset_ppm = 6\n"), HasSubstr("[other_laser] has no events"));
  EXPECT_THAT(section("[motion]\nradial_velocity_m_per_s = nan\n"),
              HasSubstr("radial_velocity_m_per_s is nan"));
  EXPECT_THAT(section("[motion]\n"),
              HasSubstr("[motion] has no radial_velocity_m_per_s, columns_per_frame or rows_per_frame"));
  EXPECT_EQ(section("[motion]\nrows_per_frame = 1\n"), "accepted");
  EXPECT_THAT(section("[motion]\nrows_per_frame = 1e4\n"),
              HasSubstr("rows_per_frame is 10000, but must be -1000 to 1000"));
  EXPECT_THAT(section("[mist]\n"), HasSubstr("unknown section 'mist'"));
  EXPECT_THAT(section("[cover_glass]\ncrosstalk_event = 1\n"), HasSubstr("did you mean 'crosstalk_events'"));
  const auto laser = [](const std::string& keys) { return refusal(with("[laser]", "[laser]\n" + keys)); };
  EXPECT_THAT(laser("start_up_power_drop = 0.5"),
              HasSubstr("my.toml:4: start_up_power_drop needs start_up_time_share"));
  EXPECT_THAT(laser("start_up_time_share = 0.5"),
              HasSubstr("needs start_up_power_drop or start_up_delay_ps"));
  EXPECT_THAT(laser("firing_offset_bits = 5"), HasSubstr("firing_offset_bits needs firing_offset_step_ns"));
  EXPECT_THAT(laser("firing_offset_step_ns = 5"),
              HasSubstr("firing_offset_step_ns needs firing_offset_bits"));
  EXPECT_THAT(laser("firing_offset_seed = 0"), HasSubstr("stops if all are 0"));
  const auto tdc = [](const std::string& keys) { return refusal(with("[laser]", keys + "\n[laser]")); };
  EXPECT_THAT(tdc("column_skew_pattern = \"ramp\""), HasSubstr("needs a column_skew_ps above 0"));
  EXPECT_THAT(tdc("column_skew_ps = 1\ncolumn_skew_pattern = \"odd\""),
              HasSubstr("my.toml:4: column_skew_pattern is \"odd\""));
  EXPECT_THAT(tdc("skew_seed = 1"), HasSubstr("skew_seed needs"));
}

TEST(Condition, IsLaidOverASensor) {
  const SensorModel thesis = parse_preset("thesis");
  EXPECT_THAT(conditions().size(), ::testing::Ge(12U));
  for (const Condition& condition : conditions()) {
    const SensorModel sensor = find_sensor("thesis+" + condition.name);
    EXPECT_EQ(sensor.name, "thesis-" + condition.name);
    EXPECT_FALSE(sensor.surroundings.none()) << condition.name;
    EXPECT_FALSE(condition.says.empty());
    SensorModel other = sensor.as_calibrated();
    EXPECT_EQ(other.signal_events_1m, thesis.signal_events_1m);
    EXPECT_EQ(other.dark_count_rate_hz, thesis.dark_count_rate_hz);
  }
  EXPECT_EQ(conditions().front().name, "glass");
  const SensorModel both = find_sensor("phone+fog+motion");
  EXPECT_EQ(both.surroundings.fog.extinction_per_m, 0.1);
  EXPECT_EQ(both.surroundings.motion.velocity_m_per_s, 10.0);
  EXPECT_EQ(both.signal_events_1m, parse_preset("phone").signal_events_1m);
  EXPECT_THROW(find_sensor("thesis+fgo"), InputError);
  EXPECT_THROW(find_sensor("thesiss+fog"), InputError);
}

class SensorFiles : public ::testing::Test {
 public:
  SensorFiles(const SensorFiles&) = delete;
  SensorFiles& operator=(const SensorFiles&) = delete;
  SensorFiles(SensorFiles&&) = delete;
  SensorFiles& operator=(SensorFiles&&) = delete;

 protected:
  SensorFiles() { std::filesystem::create_directories(folder_); }
  ~SensorFiles() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  [[nodiscard]] SensorModel parse(const std::string& text) const {
    return parse_sensor(text, folder_ / "my.toml");
  }
  [[nodiscard]] std::string refused(const std::string& text) const {
    try {
      (void)parse(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) / "sensor_files";
};

TEST_F(SensorFiles, EffectsOfTheDetector) {
  const SensorModel sensor =
      parse(with("[light]",
                 "[detector]\njitter_fwhm_ps = 120\nafterpulsing_probability = 0.01\n"
                 "afterpulsing_time_constant_ns = 15\nhot_pixel_share = 0.02\n"
                 "hot_pixels = [[3, 4], [5, 6]]\nhot_pixel_dark_count_rate_hz = 1e6\n"
                 "dead_pixel_share = 0.005\ndead_pixels = [[7, 8]]\ndefect_seed = 9\n[light]"));
  EXPECT_DOUBLE_EQ(sensor.jitter_fwhm_s, 120e-12);
  EXPECT_DOUBLE_EQ(sensor.afterpulse_probability, 0.01);
  EXPECT_DOUBLE_EQ(sensor.afterpulse_time_constant_s, 15e-9);
  EXPECT_DOUBLE_EQ(sensor.defects.hot_share, 0.02);
  EXPECT_DOUBLE_EQ(sensor.defects.hot_dark_count_rate_hz, 1e6);
  EXPECT_DOUBLE_EQ(sensor.defects.dead_share, 0.005);
  EXPECT_EQ(sensor.defects.seed, 9U);
  EXPECT_EQ(sensor.defects.hot, (std::vector<PixelPosition>{{3, 4}, {5, 6}}));
  EXPECT_EQ(sensor.defects.dead, (std::vector<PixelPosition>{{7, 8}}));
}

TEST_F(SensorFiles, DetectorKeysThatNeedOthers) {
  const auto detector = [&](const std::string& keys) {
    return refused(with("[light]", "[detector]\n" + keys + "\n[light]"));
  };
  EXPECT_THAT(detector("hot_pixel_share = 0.1"), HasSubstr("need hot_pixel_dark_count_rate_hz"));
  EXPECT_THAT(detector("hot_pixel_dark_count_rate_hz = 1"),
              HasSubstr("my.toml:7: hot_pixel_dark_count_rate_hz needs"));
  EXPECT_THAT(detector("defect_seed = 1"), HasSubstr("defect_seed needs"));
  EXPECT_THAT(detector("afterpulsing_probability = 0.1"), HasSubstr("needs afterpulsing_time_constant_ns"));
  EXPECT_THAT(detector("afterpulsing_time_constant_ns = 3"), HasSubstr("needs an afterpulsing_probability"));
  EXPECT_THAT(detector("dead_pixels = 3"), HasSubstr("must be a list of [column, row]"));
  EXPECT_THAT(detector("dead_pixels = [[1, 2, 3]]"), HasSubstr("must be a list of [column, row]"));
  EXPECT_THAT(detector("dead_pixels = [[1, 2],\n[200, 0]]"),
              HasSubstr("my.toml:8: dead_pixels: pixel [200, 0] is outside"));
  EXPECT_THAT(detector("hot_pixel_share = 0.6\ndead_pixel_share = 0.6\nhot_pixel_dark_count_rate_hz = 1"),
              HasSubstr("together at most 1"));
}

TEST_F(SensorFiles, MeasuredPulse) {
  const std::vector<double> samples = {1.0, 3.0, 0.0, 0.0,
                                       2.0};  // one period: the pulse begins with the last bin
  const std::array<std::size_t, 1> shape = {samples.size()};
  write_npy(folder_ / "pulse.npy", shape, samples);
  const std::string response = "pulse_response_file = \"pulse.npy\"\npulse_response_bin_ps = 500\n";
  const SensorModel sensor = parse(with("pulse_fwhm_ns = 1.5", response + "pulse_response_first_bin = 4"));
  ASSERT_TRUE(sensor.pulse_response);
  EXPECT_NEAR(sensor.pulse_response->end() - sensor.pulse_response->begin(), 1.5e-9, 1e-21);
  EXPECT_NEAR(sensor.pulse_response->share_before(sensor.pulse_response->begin() + 0.5e-9), 2.0 / 6.0, 1e-12);
  EXPECT_NEAR(sensor.pulse_fwhm_s, sensor.pulse_response->full_width_at_half_maximum(), 0.0);
  EXPECT_THAT(refused(with("pulse_fwhm_ns = 1.5", "pulse_fwhm_ns = 1.5\n" + response)),
              HasSubstr("give one of the two"));
  EXPECT_THAT(refused(with("pulse_fwhm_ns = 1.5", "pulse_response_file = \"pulse.npy\"")),
              HasSubstr("needs pulse_response_bin_ps"));
  EXPECT_THAT(refused(with("pulse_fwhm_ns = 1.5", "pulse_fwhm_ns = 1.5\npulse_response_bin_ps = 3")),
              HasSubstr("needs pulse_response_file"));
  EXPECT_THAT(refused(with("pulse_fwhm_ns = 1.5", response + "pulse_response_first_bin = 5")),
              HasSubstr("5 bins"));
  EXPECT_THAT(
      refused(with("pulse_fwhm_ns = 1.5", "pulse_response_file = \"no.npy\"\npulse_response_bin_ps = 500")),
      HasSubstr("my.toml:5: pulse_response_file: "));
}

TEST_F(SensorFiles, CodeWidthsOfAColumnALineOrEveryLine) {
  write("codes.csv", "tdc,a,b,c\nx,1,3,4\ny,2,2,6\n");
  const auto codes = [&](const std::string& keys) {
    return parse(with("[tdc]", "[tdc]\ntimestamp_bits = 3\ncode_widths_file = \"codes.csv\"\n" + keys))
        .tdc_codes;
  };
  EXPECT_THAT(
      codes("code_widths_row = \"x\"")->boundaries(0, 3),
      ElementsAre(0.0, DoubleEq(8.0 / 20), DoubleEq(32.0 / 20), DoubleEq(64.0 / 20), DoubleEq(72.0 / 20),
                  DoubleEq(96.0 / 20), DoubleEq(128.0 / 20), DoubleEq(136.0 / 20), 8.0));
  EXPECT_THAT(codes("code_widths_column = \"b\"")->boundaries(0, 3)[1], DoubleEq(3.0 * 8.0 / 20.0));
  // Edges 2, 2, 6: widths 2, 0, 4.
  EXPECT_THAT(codes("code_widths_row = \"y\"\ncode_widths_are_edges = true")->boundaries(0, 3),
              ElementsAre(0.0, DoubleEq(16.0 / 14), DoubleEq(16.0 / 14), DoubleEq(48.0 / 14),
                          DoubleEq(64.0 / 14), DoubleEq(64.0 / 14), DoubleEq(96.0 / 14), DoubleEq(8.0), 8.0));
  EXPECT_EQ(codes("code_widths_row = \"all\"")->tables(), 2U);
  const auto refusal_of = [&](const std::string& keys) {
    return refused(with("[tdc]", "[tdc]\ncode_widths_file = \"codes.csv\"\n" + keys));
  };
  EXPECT_THAT(refusal_of(""), HasSubstr("needs either code_widths_column or code_widths_row"));
  EXPECT_THAT(refusal_of("code_widths_row = \"z\""), HasSubstr("no line begins with 'z'"));
  EXPECT_THAT(refusal_of("code_widths_column = \"d\""), HasSubstr("no column is called 'd'"));
  EXPECT_THAT(refusal_of("code_widths_column = \"tdc\""), HasSubstr("codes.csv:2: 'x' is no number"));
  EXPECT_THAT(refusal_of("code_widths_row = \"all\"\ncode_widths_are_edges = 1"), HasSubstr("true or false"));
  EXPECT_THAT(refused(with("[tdc]", "[tdc]\ncode_widths_row = \"all\"")),
              HasSubstr("needs code_widths_file"));
  EXPECT_THAT(refusal_of("code_widths_row = \"x\"\ncode_widths_column = \"b\""),
              HasSubstr("my.toml:3: the widths are in code_widths_column, too: give one of the two"));
  EXPECT_THAT(refusal_of("code_widths_row = \"\""),
              HasSubstr("code_widths_row is empty; leave the key out if there is none"));
  write("codes.csv", "tdc,a,b,c\nx,1,-3,4\n");
  EXPECT_THAT(refusal_of("code_widths_row = \"x\""),
              HasSubstr("codes.csv: TDC code widths: table 0, code 1: the width is -3"));
  write("codes.csv", "tdc,a,b,c\nx,1,3\n");
  EXPECT_THAT(refusal_of("code_widths_row = \"x\""),
              HasSubstr("codes.csv:2: 3 fields, but the first line has 4"));
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
