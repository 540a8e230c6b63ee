// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/frame_pipeline.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/pixel_sampler.hpp"
#include "dtof/core/settled_source.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/metrics/depth.hpp"

namespace dtof {

void check_frame_memory(const SensorModel& sensor, int rows) {
  constexpr double kMostDetections = 160.0 * 2.0 * kMostAcquisitions;
  const double detections = static_cast<double>(rows) * sensor.slots * sensor.acquisitions;
  if (detections > kMostDetections) {
    throw InputError(fmt::format(
        "{} acquisitions of {} rows and {} slots: a column could have {:.2g} detections, more than the "
        "{:.2g} (2.7 GB) that are held",
        sensor.acquisitions, rows, sensor.slots, detections, kMostDetections));
  }
}

Fidelity frame_fidelity(std::string_view name, double tolerance, const PhotonSource& scene,
                        std::span<const ReadoutParameters> readouts, const FrameEngine& engine) {
  std::vector<Readout> sampled;
  for (const ReadoutParameters& parameters : readouts) {
    if (engine.reads_samples(parameters.readout)) {
      sampled.push_back(parameters.readout);
    }
  }
  const PhotonUse use = sampled.empty() ? PhotonUse::kStream : PhotonUse::kSampler;
  return parse_fidelity(name, scene, {.tolerance = tolerance, .use = use, .readouts = sampled});
}

std::vector<RangeConverter> flat_tables(const SensorModel& sensor, double klux, Fidelity fidelity,
                                        std::span<const ReadoutParameters> readouts, std::uint64_t seed,
                                        int threads) {
  const SensorModel calibrated = sensor.as_calibrated();
  const FlatCalibration calibration(calibrated);
  const auto photons = [&](const TargetMap& targets) {
    return make_source(fidelity, PhotonSource(calibrated, targets, klux, seed, FlatCalibration::kFrame));
  };
  return calibration.fit(photons, readouts, seed, threads);
}

FramePipeline::FramePipeline(PhotonSource scene, const FrameEngine& engine, Settings settings)
    : scene_(std::move(scene)),
      engine_(engine),
      settings_(std::move(settings)),
      truth_(frame_truth(scene_.targets(), scene_.model(), settings_.region.columns, settings_.region.rows)),
      source_(photons_of(scene_)),
      streams_(
          std::make_unique<KeptStreams>(*source_, settings_.keep_photons ? KeptStreams::kMostBytes : 0)) {}

std::unique_ptr<StreamSource> FramePipeline::photons_of(const PhotonSource& scene) const {
  std::unique_ptr<StreamSource> source = make_source(settings_.fidelity, scene);
  return settings_.settle == 0 ? std::move(source)
                               : std::make_unique<SettledSource>(std::move(source), settings_.settle);
}

std::vector<TabledReadout> FramePipeline::tables(std::span<const ReadoutParameters> readouts,
                                                 TableRule rule) const {
  std::vector<TabledReadout> tabled;
  tabled.reserve(readouts.size());
  for (const ReadoutParameters& parameters : readouts) {
    tabled.push_back({parameters, std::nullopt});
  }
  if (rule == TableRule::kFlat) {
    std::vector<RangeConverter> tables = flat_tables(scene_.model(), scene_.klux(), settings_.fidelity,
                                                     readouts, settings_.seed, settings_.threads);
    for (std::size_t r = 0; r < tabled.size(); ++r) {
      tabled[r].table = std::move(tables[r]);
    }
  }
  return tabled;
}

const StreamSource& FramePipeline::first_frame(const FrameEngine& engine, Readout readout) const {
  const bool sampled = dynamic_cast<const SampledSource*>(source_.get()) != nullptr;
  if (sampled && engine.reads_samples(readout)) {
    return *source_;
  }
  return *streams_;
}

/// Timing skew of the region's pixels; empty without any.
std::vector<double> FramePipeline::skew_bins() const {
  std::vector<double> skews;
  const SensorModel& sensor = scene_.model();
  const TimingSkew& skew = sensor.surroundings.skew;
  if (skew.none()) {
    return skews;
  }
  const RowRange rows = region().rows;
  for (int row = rows.first; row < rows.first + rows.count; ++row) {
    for (const int column : region().columns) {
      skews.push_back(skew.of_pixel(column, row, scene_.columns()) / sensor.time_resolution_s());
    }
  }
  return skews;
}

ReadoutRun FramePipeline::read(const ReadoutParameters& readout, std::vector<int> columns) const {
  const StreamSource& photons = first_frame(engine_, readout.readout);
  if (columns.empty()) {
    return engine_.read(photons, readout, region());
  }
  return engine_.read(photons, readout, {.columns = std::move(columns), .rows = region().rows});
}

ReadoutRun FramePipeline::read_by(const FrameEngine& engine, const ReadoutParameters& readout) const {
  return engine.read(first_frame(engine, readout.readout), readout, region());
}

std::vector<double> FramePipeline::positions(std::span<const PixelResult> results,
                                             const ReadoutParameters& readout) const {
  const std::vector<double> skews = skew_bins();
  std::vector<double> positions;
  positions.reserve(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    positions.push_back(code_position(results[i], readout.fraction_bits) - (skews.empty() ? 0.0 : skews[i]));
  }
  return positions;
}

FrameMaps FramePipeline::judge(std::span<const PixelResult> results, const TabledReadout& readout) const {
  return frame_maps(results, readout.parameters, scene_.model(), readout.table, truth_.metres, skew_bins());
}

MeasuredFrame FramePipeline::measure_once(const StreamSource& source, const TabledReadout& readout) const {
  MeasuredFrame frame;
  frame.parameters = readout.parameters;
  frame.run = engine_.read(source, readout.parameters, region());
  frame.maps = judge(frame.run.results, readout);
  return frame;
}

MeasuredFrame FramePipeline::measure(const TabledReadout& readout,
                                     const std::optional<FramePrecision>& precision) const {
  MeasuredFrame frame = measure_once(first_frame(engine_, readout.parameters.readout), readout);
  if (!precision) {
    return frame;
  }
  std::vector<double> mean_squares = {frame.maps.mean_square};
  constexpr int kFewestFrames = 4;
  const auto reached = [&] {
    // A root's relative error is half its square's.
    return frame.frames >= kFewestFrames &&
           0.5 * estimate_mean(mean_squares).relative_half_width() <= precision->relative;
  };
  while (!(frame.precision_reached = reached()) && frame.frames < precision->most_frames) {
    const auto next = photons_of(scene_.at_frame(scene_frame(static_cast<std::uint32_t>(frame.frames))));
    const MeasuredFrame other = measure_once(*next, readout);
    frame.run.seconds += other.run.seconds;
    frame.maps.figures.merge(other.maps.figures);
    mean_squares.push_back(other.maps.mean_square);
    ++frame.frames;
  }
  return frame;
}

}  // namespace dtof
