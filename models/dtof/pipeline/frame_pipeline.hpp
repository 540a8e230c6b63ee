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
#include "dtof/pipeline/frame_limits.hpp"
#include "dtof/pipeline/region.hpp"

namespace dtof {

/// Throws InputError if the detections of a column of `rows` rows might exceed the memory limit, which is 2.7
/// GB (160 rows, two slots and kMostAcquisitions).
void check_frame_memory(const SensorModel& sensor, int rows);

/// Photon model for the name given with `--fidelity`; "auto" chooses for `readouts` as `engine` reads them.
/// Throws InputError for an unknown name or an illegal tolerance.
Fidelity frame_fidelity(std::string_view name, double tolerance, const PhotonSource& scene,
                        std::span<const ReadoutParameters> readouts, const FrameEngine& engine);

/// Look-up table of each read-out's model for `--table flat` (FlatCalibration). All tables are fitted to the
/// same photons, drawn for the sensor as a host calibrates it (SensorModel::as_calibrated). Throws InputError
/// as FlatCalibration does.
std::vector<RangeConverter> flat_tables(const SensorModel& sensor, double klux, Fidelity fidelity,
                                        std::span<const ReadoutParameters> readouts, std::uint64_t seed,
                                        int threads);

/// A read-out and its look-up table. Without a table, Eq. 3.11 gives the distances.
struct TabledReadout {
  ReadoutParameters parameters;
  std::optional<RangeConverter> table;
};

/// Stop rule for a series of frames: the 95 % interval of the rmse is within +- `relative` of its value, or
/// `most_frames` were read.
struct FramePrecision {
  double relative = 0.05;
  int most_frames = 1000;
};

/// Measurement of a read-out over the region. With several frames, `run`'s results and the maps are those of
/// the first.
struct MeasuredFrame {
  ReadoutParameters parameters;
  ReadoutRun run;  ///< seconds: total of all frames
  FrameMaps maps;  ///< figures: over all frames
  int frames = 1;
  bool precision_reached = true;
};

/// Takes a frame of a scene from photons to distances, errors and figures, with any engine.
///
/// In one go: tables() and measure(). In steps, to show progress or keep data from frame to frame: read() for
/// all or some columns, then positions() or judge().
class FramePipeline {
 public:
  struct Settings {
    Region region;
    Fidelity fidelity = Fidelity::kExact;
    std::uint64_t seed = 1;  ///< for the photons of the look-up tables; the scene has its own seed
    int threads = 0;         ///< 0: all processors
    /// Keep the photons of the frame in memory, if they fit, because they are read more than once.
    bool keep_photons = true;
    /// Number of acquisitions dropped at the frame's start, as by the register SETTLE.
    std::uint32_t settle = 0;
  };

  /// `engine` must outlive the pipeline. Throws InputError if the photon model lacks an effect that the
  /// sensor has, or if no acquisition is left.
  FramePipeline(PhotonSource scene, const FrameEngine& engine, Settings settings);

  [[nodiscard]] const PhotonSource& scene() const { return scene_; }
  [[nodiscard]] const Region& region() const { return settings_.region; }
  /// True distances of the region's pixels.
  [[nodiscard]] const FrameTruth& truth() const { return truth_; }

  /// Pairs each read-out with its look-up table by `rule`.
  [[nodiscard]] std::vector<TabledReadout> tables(std::span<const ReadoutParameters> readouts,
                                                  TableRule rule) const;
  /// Reads the frame. With `precision`, reads further frames of the scene until the precision is reached. The
  /// interval comes from the spread of the frames' mean squares, because pixels of one frame differ in
  /// distance, whereas frames are equivalent.
  [[nodiscard]] MeasuredFrame measure(const TabledReadout& readout,
                                      const std::optional<FramePrecision>& precision = std::nullopt) const;

  /// Reads the given columns of the region (ascending), or all if `columns` is empty. A pool read-out always
  /// processes whole engines (ReadoutParameters::columns_together), so ask for columns engine by engine.
  [[nodiscard]] ReadoutRun read(const ReadoutParameters& readout, std::vector<int> columns = {}) const;
  /// Reads the region from the same photons with another engine.
  [[nodiscard]] ReadoutRun read_by(const FrameEngine& engine, const ReadoutParameters& readout) const;
  /// Frees the memory of a column's photons; the next read draws them again.
  void drop_photons(int column) { streams_->drop(column); }
  /// Positions of the region's results on the code axis, in bins, minus the timing skew of each pixel, which
  /// the host knows.
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
