// SPDX-License-Identifier: Apache-2.0
#include "video/video_reader.hpp"

#include <algorithm>
#include <utility>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "video/prior_engine.hpp"

namespace dtof {

VideoReader::VideoReader(SensorModel sensor, std::span<const ReadoutParameters> readouts, double table_klux,
                         std::uint64_t seed, int threads)
    : sensor_(std::move(sensor)),
      readouts_(readouts.begin(), readouts.end()),
      seed_(seed),
      threads_(threads) {
  tables_ = flat_tables(sensor_, table_klux, Fidelity::kExact, readouts_, seed_, threads_);
  for (const ReadoutParameters& readout : readouts_) {
    titles_.emplace_back(readout_title(readout.readout));
  }
  const auto pool = std::ranges::find(readouts_, Readout::kPoolPointer, &ReadoutParameters::readout);
  if (pool != readouts_.end()) {
    pool_ = static_cast<std::size_t>(pool - readouts_.begin());
    titles_.push_back(titles_[*pool_] + ", prior");
    tables_.push_back(tables_[*pool_]);
  }
}

VideoFrame VideoReader::read_frame(const SequenceFrame& frame, std::uint32_t number,
                                   std::vector<PoolPrior>& priors) const {
  const PhotonSource scene(sensor_, frame.targets, frame.klux, seed_, scene_frame(number));
  const ModelEngine engine(
      {.threads = threads_, .own_rows = true, .observer = [](std::size_t, std::size_t) {}});
  const FramePipeline pipeline(scene, engine,
                               {.region = Region::whole(scene.columns(), scene.rows()),
                                .seed = seed_,
                                .threads = threads_,
                                .keep_photons = titles_.size() > 1});
  VideoFrame seen{.targets = frame.targets, .distance_m = {}, .shares = {}};
  const auto add = [&](const ReadoutParameters& readout, const ReadoutRun& run) {
    const RangeConverter& table = tables_[seen.distance_m.size()];
    std::vector<double> distances = pipeline.positions(run.results, readout);
    std::ranges::transform(distances, distances.begin(),
                           [&](double position) { return table.distance(position); });
    seen.distance_m.push_back(std::move(distances));
  };
  for (const ReadoutParameters& readout : readouts_) {
    add(readout, pipeline.read(readout));
  }
  if (pool_) {
    add(readouts_[*pool_], pipeline.read_by(PriorEngine(priors, threads_), readouts_[*pool_]));
  }
  const auto width = static_cast<std::size_t>(scene.columns());
  for (const std::vector<double>& distance_m : seen.distance_m) {
    ErrorShareCounter counter;
    for (std::size_t pixel = 0; pixel < distance_m.size(); ++pixel) {
      const PixelTarget& target =
          seen.targets.at(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
      if (target.returns_signal() && target.depth_m < sensor_range_m(sensor_)) {
        counter.add(target.depth_m, distance_m[pixel]);
      }
    }
    seen.shares.push_back(counter.shares());
  }
  return seen;
}

std::vector<std::vector<ErrorShares>> VideoReader::read(const Sequence& sequence, Progress* progress,
                                                        const Watcher& watch) const {
  std::vector<std::vector<ErrorShares>> shares;
  std::vector<PoolPrior> priors;
  for (int frame = 0; frame < sequence.frames; ++frame) {
    const VideoFrame seen =
        read_frame(sequence_frame(sequence, frame), static_cast<std::uint32_t>(frame), priors);
    shares.push_back(seen.shares);
    if (watch) {
      watch(frame, seen);
    }
    if (progress != nullptr) {
      progress->advance();
    }
  }
  return shares;
}

}  // namespace dtof
