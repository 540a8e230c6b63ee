// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/frame/frame_maps.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/pipeline/frame_engine.hpp"

namespace dtof {

inline constexpr int kOneThread = 1;  ///< a page's worker has one

/// What the detections of a session's frame come from: a scene, or a recording.
class PlaygroundPhotons {
 public:
  PlaygroundPhotons() = default;
  PlaygroundPhotons(const PlaygroundPhotons&) = delete;
  PlaygroundPhotons& operator=(const PlaygroundPhotons&) = delete;
  PlaygroundPhotons(PlaygroundPhotons&&) = delete;
  PlaygroundPhotons& operator=(PlaygroundPhotons&&) = delete;
  virtual ~PlaygroundPhotons() = default;

  [[nodiscard]] virtual const StreamSource& source() const = 0;
  /// Sensor whose NP, SLOTS and pulse set the read-outs' parameters.
  [[nodiscard]] virtual const SensorModel& sensor() const = 0;
  /// True distances in m, row-major; NaN: unknown.
  [[nodiscard]] virtual const std::vector<float>& truth_m() const = 0;
  /// Reflectivity of each pixel's target, or of a recording the number of a pixel's detections. Row-major.
  [[nodiscard]] virtual std::vector<float> brightness() const = 0;

  virtual void calibrate(std::span<const ReadoutParameters> readouts) = 0;
  /// Results of these columns (ascending), row-major.
  [[nodiscard]] virtual std::vector<PixelResult> read(const ReadoutParameters& readout,
                                                      std::vector<int> columns) const = 0;
  /// The next read of a column may draw its detections again.
  virtual void drop(int column) = 0;
  /// Distances, errors and figures of the read-out with this index in calibrate().
  [[nodiscard]] virtual FrameMaps judge(std::span<const PixelResult> results, std::size_t readout) const = 0;
};

struct PlaygroundRequest;
struct PlaygroundFiles;

/// Both throw InputError for an illegal request or file. `engine` must outlive the result.
std::unique_ptr<PlaygroundPhotons> make_scene_photons(const PlaygroundRequest& request,
                                                      const PlaygroundFiles& files,
                                                      const FrameEngine& engine);
std::unique_ptr<PlaygroundPhotons> make_recorded_photons(const PlaygroundRequest& request,
                                                         const PlaygroundFiles& files,
                                                         const FrameEngine& engine);

/// The sensor file's sensor, or else the request's preset.
SensorModel playground_sensor(const PlaygroundRequest& request, const PlaygroundFiles& files);

}  // namespace dtof
