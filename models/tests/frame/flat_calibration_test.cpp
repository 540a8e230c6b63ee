// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/flat_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/sensor/preset.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(TableRule, NamesRoundTripAndOthersAreRefused) {
  for (const TableRule rule : {TableRule::kNone, TableRule::kFlat}) {
    EXPECT_EQ(parse_table_rule(table_rule_name(rule)), rule);
  }
  EXPECT_THAT([] { (void)parse_table_rule("round"); },
              ThrowsMessage<InputError>("unknown look-up table 'round': known are none, flat"));
}

TEST(FlatCalibration, DistancesFollowTheSensorsRange) {
  SensorModel sensor = parse_preset("thesis");
  const std::vector<double> usual = FlatCalibration(sensor).distances_m();
  ASSERT_EQ(usual.size(), 45U);
  EXPECT_DOUBLE_EQ(usual.front(), 0.1);
  EXPECT_DOUBLE_EQ(usual[17], 0.95);
  EXPECT_DOUBLE_EQ(usual[18], 1.0);
  EXPECT_DOUBLE_EQ(usual.back(), 6.2);
  sensor.integration_time_s *= 2.0;
  const std::vector<double> twice = FlatCalibration(sensor).distances_m();
  EXPECT_DOUBLE_EQ(twice[18], 2.0);
  EXPECT_DOUBLE_EQ(twice.back(), 12.4);
}

TEST(FlatCalibration, LeavesOutWhatTheSensorCannotSee) {
  SensorModel sensor = parse_preset("thesis");
  // 2R/c + 2 ns within 12 to 22 ns: 1.50 to 3.00 m.
  sensor.time_gate = TimeGate{12e-9, 22e-9};
  const std::vector<double> gated = FlatCalibration(sensor).distances_m();
  EXPECT_DOUBLE_EQ(gated.front(), 1.6);
  EXPECT_DOUBLE_EQ(gated.back(), 2.8);
  sensor.time_gate.reset();
  // The falling edge's middle is 1.5 FWHM behind 2R/c: 45 ns - 30 ns leaves 2.25 m.
  sensor.pulse_fwhm_s = 20e-9;
  EXPECT_DOUBLE_EQ(FlatCalibration(sensor).distances_m().back(), 2.2);
  sensor.pulse_fwhm_s = 30e-9;
  EXPECT_THAT([&] { FlatCalibration{sensor}; }, ThrowsMessage<InputError>(HasSubstr("--table none")));
}

TEST(FlatCalibration, NeighboursOfAReadColumnHaveItsDistance) {
  SensorModel sensor = parse_preset("thesis");
  for (const int binning : {1, 2, 3, 4}) {
    for (const bool coincidence : {false, true}) {
      sensor.binning = binning;
      sensor.coincidence_window_s.reset();
      if (coincidence) {
        sensor.coincidence_window_s = 1e-9;
      }
      const FlatCalibration calibration(sensor);
      for (std::size_t d = 0; d < calibration.distances_m().size(); ++d) {
        const int column = calibration.column(d);
        const int block = column / binning * binning;
        const int reach = coincidence ? 1 : 0;
        for (int c = block - reach; c < block + binning + reach; ++c) {
          EXPECT_EQ(calibration.targets().at(c, 0).depth_m, calibration.distances_m()[d])
              << binning << " " << coincidence << " " << c;
        }
      }
    }
  }
}

TEST(FlatCalibration, FitsPositionsToTheirDistances) {
  const SensorModel sensor = parse_preset("thesis");
  const FlatCalibration calibration(sensor);
  const std::size_t width = calibration.distances_m().size();
  std::vector<Measurement> measurements(width * FlatCalibration::kPixels);
  const auto bent = [](double metres) { return 100.0 * metres + 3.0 * metres * metres; };
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    measurements[i] = {bent(calibration.distances_m()[i % width]), 1.0};
  }
  const RangeConverter table = calibration.fit(measurements, 0.0, 7);
  for (const double metres : calibration.distances_m()) {
    EXPECT_NEAR(table.distance(bent(metres)), metres, 1e-9);
  }
}

TEST(FlatCalibration, HasAsManyPixelsAsAStudyAsksFor) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 400;
  const std::vector<ReadoutParameters> readouts = {ReadoutParameters::defaults(Readout::kCoarseHistogram)};
  const auto table = [&](int pixels) {
    const FlatCalibration calibration(sensor, pixels);
    EXPECT_EQ(calibration.targets().rows(), pixels);
    return calibration
        .fit(
            [&](const TargetMap& map) {
              return std::make_unique<PhotonSource>(sensor, map, 14.0, 5, FlatCalibration::kFrame);
            },
            readouts, 5, 2)
        .front();
  };
  // A wall at 2 m arrives at code 349.
  EXPECT_NEAR(table(16).distance(349.0), table(160).distance(349.0), 0.05);
  EXPECT_NE(table(16).distance(349.0), table(160).distance(349.0));
  EXPECT_THROW(FlatCalibration(sensor, 0), InputError);
}

TEST(FlatCalibration, FrameAndScenesFitTheSameTable) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 400;
  const std::vector<ReadoutParameters> readouts = {ReadoutParameters::defaults(Readout::kSifh),
                                                   ReadoutParameters::defaults(Readout::kPoolPointerLean)};
  TargetMap targets(3, 160, {2.0, 0.6});
  targets.at(1, 5).depth_m = 3.0;
  const SceneStudy study(sensor, 14.0, readouts, 5, 1);
  const std::vector<SceneMeasurement> measured = study.measure({"wall", targets, 3});
  const SceneStudy plain(sensor, 14.0, readouts, 5, 1, TableRule::kNone);
  const std::vector<SceneMeasurement> without = plain.measure({"wall", targets, 3});

  const FlatCalibration calibration(sensor);
  const std::vector<RangeConverter> tables = calibration.fit(
      [&](const TargetMap& map) {
        return std::make_unique<PhotonSource>(sensor, map, 14.0, 5, FlatCalibration::kFrame);
      },
      readouts, 5, 2);
  const PhotonSource scene(sensor, targets, 14.0, 5, scene_frame(0));
  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  for (std::size_t r = 0; r < readouts.size(); ++r) {
    const std::vector<ColumnStream> streams = {scene.column(0), scene.column(1), scene.column(2)};
    const auto read = make_readout_model(readouts[r])->run_columns(streams, sensor.acquisitions);
    for (int column = 0; column < 3; ++column) {
      const std::vector<PixelResult>& results = read[static_cast<std::size_t>(column)];
      for (std::size_t row = 0; row < results.size(); ++row) {
        const double position = code_position(results[row], readouts[r].fraction_bits);
        const std::size_t i = row * 3 + static_cast<std::size_t>(column);
        EXPECT_EQ(measured[r].distance_m[i], tables[r].distance(position));
        EXPECT_EQ(without[r].distance_m[i], scale.depth(position));
      }
    }
  }
}

// A pair of columns: no other read-out judges its left column.
TEST(FlatCalibration, ColumnsThatUseEachOtherAreFittedInPairs) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 400;
  const FlatCalibration calibration(sensor);
  const ReadoutParameters alone = ReadoutParameters::defaults(Readout::kFifh);
  const ReadoutParameters together = ReadoutParameters::defaults(Readout::kPoolPointer);
  const auto photons = [&](const TargetMap& targets) {
    return std::make_unique<PhotonSource>(sensor, targets, 14.0, 5, FlatCalibration::kFrame);
  };
  const std::vector<RangeConverter> both = calibration.fit(photons, std::vector{alone, together}, 5, 2);
  const RangeConverter first = calibration.fit(photons, std::vector{alone}, 5, 2).front();

  const PhotonSource pairs(sensor, calibration.paired_targets(), 14.0, 5, FlatCalibration::kFrame);
  const auto width = static_cast<int>(calibration.distances_m().size());
  std::vector<Measurement> measurements(static_cast<std::size_t>(width) * FlatCalibration::kPixels);
  for (int d = 0; d < width; ++d) {
    const std::vector<ColumnStream> pair = {pairs.column(width + d), pairs.column(d)};
    const auto results = make_readout_model(together)->run_columns(pair, sensor.acquisitions);
    for (std::size_t row = 0; row < FlatCalibration::kPixels; ++row) {
      measurements[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(d)] =
          to_measurement(results[1][row], together.fraction_bits);
    }
  }
  const RangeConverter second = calibration.fit(measurements, std::ldexp(1.0, -together.fraction_bits), 5);
  for (double position = 0.0; position < 1024.0; position += 8.0) {
    EXPECT_EQ(both[0].distance(position), first.distance(position));
    EXPECT_EQ(both[1].distance(position), second.distance(position));
  }
}

TEST(FlatCalibration, NoFrameOfASceneSharesItsPhotons) {
  EXPECT_EQ(scene_frame(0), 0U);
  for (std::uint32_t n = 0; n < 5; ++n) {
    EXPECT_NE(scene_frame(n), FlatCalibration::kFrame);
    EXPECT_LT(scene_frame(n), scene_frame(n + 1));
  }
}

}  // namespace
}  // namespace dtof
