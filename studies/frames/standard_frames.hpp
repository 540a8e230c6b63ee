// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/core/readout.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/report/table.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// One scene through every read-out, with several sensors beside each other.
struct StandardFramesSettings {
  std::vector<SensorModel> sensors;
  std::vector<Readout> readouts;
  Scene scene = Scene::kRoom;
  double klux = 14.0;
  int frames = 4;  ///< with other photons each, at least 2
  std::uint64_t seed = 1;
  int threads = 0;
};

/// A read-out's frames with one sensor.
struct StandardFrame {
  std::string sensor;
  std::uint32_t acquisitions = 0;
  Readout readout = Readout::kEzPointer;
  std::uint64_t pixels = 0;  ///< of all frames
  Estimate above_3_percent;
  Estimate above_10_percent;
  double rmse = 0.0;  ///< of the relative error, over all frames
  /// Share of the errors above 10 % that are among the tenth of the pixels with the least confidence; mean
  /// over the frames that have such errors, NaN if none has.
  double found_by_confidence = 0.0;
};

/// Models, exact photons, look-up tables by FlatCalibration: the first frame's figures are those of `dtof
/// frame`. Sensor by sensor. Throws InputError for fewer than two frames, or no sensor or read-out.
std::vector<StandardFrame> run_standard_frames(const StandardFramesSettings& settings);

/// A frame that RTL read out, each pixel equal to the model's.
struct CheckedFrame {
  std::string sensor;
  Readout readout = Readout::kEzPointer;
  int columns = 0;
  int rows = 0;
  std::uint32_t acquisitions = 0;
  std::uint64_t cycles = 0;
};

/// Reads the columns of the first engine out in RTL, with every sensor, and compares each pixel with the
/// model. Throws RtlError for a difference, and InputError for a read-out whose RTL is not compiled.
std::vector<CheckedFrame> check_standard_frames(const StandardFramesSettings& settings, Readout readout);

/// The page: read-outs down, sensors across.
std::string standard_frames_report(const StandardFramesSettings& settings,
                                   const std::vector<StandardFrame>& frames,
                                   const std::vector<CheckedFrame>& checked, const std::string& command_line);
Table standard_frames_csv(const std::vector<StandardFrame>& frames);

}  // namespace dtof
