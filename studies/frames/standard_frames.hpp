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
#include "page/page.hpp"

namespace dtof {

/// Settings: one scene, read out by several read-outs with several sensors.
struct StandardFramesSettings {
  std::vector<SensorModel> sensors;
  std::vector<Readout> readouts;
  Scene scene = Scene::kRoom;
  double klux = 14.0;
  int frames = 4;  ///< frames with different photons, at least 2
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Figures of a read-out's frames with one sensor.
struct StandardFrame {
  std::string sensor;
  std::uint32_t acquisitions = 0;
  Readout readout = Readout::kEzPointer;
  std::uint64_t pixels = 0;  ///< over all frames
  Estimate above_3_percent;
  Estimate above_10_percent;
  double rmse = 0.0;  ///< root mean square of the relative error, over all frames
  /// Share of the errors above 10 % that lie among the tenth of the pixels with least confidence. Mean over
  /// the frames with such errors; NaN without.
  double found_by_confidence = 0.0;
};

/// Reads frames with the models, exact photons and look-up tables by FlatCalibration. The first frame's
/// figures equal those of `dtof frame`. Sorted by sensor. Throws InputError for fewer than two frames, or
/// without sensor or read-out.
std::vector<StandardFrame> run_standard_frames(const StandardFramesSettings& settings);

/// A frame read out by the RTL, with all pixels equal to the model's.
struct CheckedFrame {
  std::string sensor;
  Readout readout = Readout::kEzPointer;
  int columns = 0;
  int rows = 0;
  std::uint32_t acquisitions = 0;
  std::uint64_t cycles = 0;
};

/// Reads out the columns of the first engine in RTL with every sensor, and compares each pixel with the
/// model. Throws RtlError for a difference, InputError for a read-out without compiled RTL.
std::vector<CheckedFrame> check_standard_frames(const StandardFramesSettings& settings, Readout readout);

/// What frames.mustache shows: in its tables a row per read-out, a column per sensor.
PageData standard_frames_page(const StandardFramesSettings& settings,
                              const std::vector<StandardFrame>& frames,
                              const std::vector<CheckedFrame>& checked, const std::string& command_line);
Table standard_frames_csv(const std::vector<StandardFrame>& frames);

}  // namespace dtof
