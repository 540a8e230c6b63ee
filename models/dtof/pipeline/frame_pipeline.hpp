// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/kept_streams.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_maps.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/region.hpp"

namespace dtof {

/// Most laser pulses of a frame: the detections of a column are held in memory.
inline constexpr double kMostAcquisitions = 1048575;

/// Throws InputError if a column of so many rows could have more detections than are held: 160 rows, two
/// slots and kMostAcquisitions make 2.7 GB.
void check_frame_memory(const SensorModel& sensor, int rows);

/// The photon model of a name of `--fidelity`, auto included, for read-outs that the engine reads. Throws
/// InputError.
Fidelity frame_fidelity(std::string_view name, double tolerance, const PhotonSource& scene,
                        std::span<const ReadoutParameters> readouts, const FrameEngine& engine);

/// The look-up table of each read-out's model behind `--table flat` (FlatCalibration), from photons of the
/// sensor as a host calibrates it. All tables are fitted to the same photons. Throws InputError.
std::vector<RangeConverter> flat_tables(const SensorModel& sensor, double klux, Fidelity fidelity,
                                        std::span<const ReadoutParameters> readouts, std::uint64_t seed,
                                        int threads);

/// A read-out and its look-up table; without a table Eq. 3.11 gives the distances.
struct TabledReadout {
  ReadoutParameters parameters;
  std::optional<RangeConverter> table;
};

/// When to stop taking frames: the 95 % interval of the rmse is at most this part of its value to either
/// side, or there were so many frames.
struct FramePrecision {
  double relative = 0.05;
  int most_frames = 1000;
};

/// What one read-out made of the frame, over the region read. Of several frames the run's results and the
/// maps are those of the first.
struct MeasuredFrame {
  ReadoutParameters parameters;
  ReadoutRun run;  ///< seconds: of all frames
  FrameMaps maps;  ///< figures: of all frames
  int frames = 1;
  bool precision_reached = true;
};

/// A frame of a scene, from its photons to distances, errors and figures, whatever engine reads them. At
/// once: tables() and measure(). Step by step, for whoever shows how far a frame is or keeps something from
/// frame to frame: read(), all columns or some, then positions() or judge().
class FramePipeline {
 public:
  struct Settings {
    Region region;
    Fidelity fidelity = Fidelity::kExact;
    std::uint64_t seed = 1;  ///< of the look-up tables' photons; that of the scene has the scene's
    int threads = 0;         ///< 0: all processors
    /// The photons of the frame will be read more than once: they are drawn once and kept, if they fit.
    bool keep_photons = true;
    /// Acquisitions at the frame's start that are dropped, as SETTLE does; read-outs see the others.
    std::uint32_t settle = 0;
  };

  /// The engine must outlive the pipeline. Throws InputError where the photon model lacks something that the
  /// sensor has, and if no acquisition is left.
  FramePipeline(PhotonSource scene, const FrameEngine& engine, Settings settings);

  [[nodiscard]] const PhotonSource& scene() const { return scene_; }
  [[nodiscard]] const Region& region() const { return settings_.region; }
  /// What the region's pixels can be judged by.
  [[nodiscard]] const FrameTruth& truth() const { return truth_; }

  /// The read-outs with their look-up tables by this rule.
  [[nodiscard]] std::vector<TabledReadout> tables(std::span<const ReadoutParameters> readouts,
                                                  TableRule rule) const;
  /// Reads the frame; with a precision, further ones of the scene until it is reached. Pixels of a frame
  /// differ in distance, frames are equals: the interval comes from the spread of the frames' mean squares.
  [[nodiscard]] MeasuredFrame measure(const TabledReadout& readout,
                                      const std::optional<FramePrecision>& precision = std::nullopt) const;

  /// Reads these columns of the region, ascending; none named: all. A pool read-out reads whole engines
  /// (ReadoutParameters::columns_together) for them, so that columns are best asked for engine by engine.
  [[nodiscard]] ReadoutRun read(const ReadoutParameters& readout, std::vector<int> columns = {}) const;
  /// Another engine reads the region from the same photons.
  [[nodiscard]] ReadoutRun read_by(const FrameEngine& engine, const ReadoutParameters& readout) const;
  /// The memory that a column's photons have is free again; who reads the column next draws them anew.
  void forget_photons(int column) { streams_->forget(column); }
  /// Places of the region's results on the code axis in bins, less the skew of each pixel's clock, which the
  /// host knows.
  [[nodiscard]] std::vector<double> positions(std::span<const PixelResult> results,
                                              const ReadoutParameters& readout) const;
  /// Distances, errors and figures of the region's results.
  [[nodiscard]] FrameMaps judge(std::span<const PixelResult> results, const TabledReadout& readout) const;

 private:
  [[nodiscard]] const StreamSource& first_frame(const FrameEngine& engine, Readout readout) const;
  [[nodiscard]] std::unique_ptr<StreamSource> photons_of(const PhotonSource& scene) const;
  [[nodiscard]] MeasuredFrame measure_once(const StreamSource& source, const TabledReadout& readout) const;
  [[nodiscard]] std::vector<double> skew_bins() const;

  PhotonSource scene_;
  const FrameEngine& engine_;
  Settings settings_;
  FrameTruth truth_;
  std::unique_ptr<StreamSource> source_;
  std::unique_ptr<KeptStreams> streams_;
};

}  // namespace dtof
