// SPDX-License-Identifier: Apache-2.0
#include "video/video_reader.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "dtof/core/parallel.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/readout/model.hpp"

namespace dtof {

VideoReader::VideoReader(SensorModel sensor, std::span<const ReadoutParameters> readouts, double table_klux,
                         std::uint64_t seed, int threads)
    : sensor_(std::move(sensor)),
      readouts_(readouts.begin(), readouts.end()),
      seed_(seed),
      threads_(threads) {
  const FlatCalibration calibration(sensor_);
  const auto photons = [&](const TargetMap& targets) {
    return std::make_unique<PhotonSource>(sensor_, targets, table_klux, seed_, FlatCalibration::kFrame);
  };
  tables_ = calibration.fit(photons, readouts_, seed_, threads_);
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

std::vector<VideoReader::Block> VideoReader::blocks() const {
  // Read-outs whose pixels are on their own go with the first ones that hear each other.
  std::vector<Block> blocks;
  for (std::size_t r = 0; r < readouts_.size(); ++r) {
    const int together = readouts_[r].columns_together();
    if (together > 1 && std::ranges::find(blocks, together, &Block::columns) == blocks.end()) {
      blocks.push_back({together, {}});
    }
  }
  if (blocks.empty()) {
    constexpr int kAnyNumber = 8;
    blocks.push_back({kAnyNumber, {}});
  }
  for (std::size_t r = 0; r < readouts_.size(); ++r) {
    const auto own = std::ranges::find(blocks, readouts_[r].columns_together(), &Block::columns);
    (own == blocks.end() ? blocks.front() : *own).readouts.push_back(r);
  }
  return blocks;
}

void VideoReader::read_block(const Block& block, int first, const PhotonSource& source,
                             std::vector<PoolPrior>& prior, VideoFrame& seen) const {
  std::vector<ColumnStream> streams;
  for (int column = first; column < std::min(first + block.columns, source.columns()); ++column) {
    streams.push_back(source.column(column));
  }
  const auto width = static_cast<std::size_t>(source.columns());
  const auto store = [&](std::size_t estimator, int fraction_bits,
                         const std::vector<std::vector<PixelResult>>& results) {
    for (std::size_t column = 0; column < results.size(); ++column) {
      for (std::size_t row = 0; row < results[column].size(); ++row) {
        const Measurement measured = to_measurement(results[column][row], fraction_bits);
        seen.distance_m[estimator][row * width + static_cast<std::size_t>(first) + column] =
            tables_[estimator].distance(measured.position);
      }
    }
  };
  for (const std::size_t r : block.readouts) {
    store(r, readouts_[r].fraction_bits,
          make_readout_model(readouts_[r])->run_columns(streams, sensor_.acquisitions));
    if (r == pool_) {
      const auto column = [&](int index) -> const ColumnStream& {
        return streams[static_cast<std::size_t>(index)];
      };
      store(readouts_.size(), readouts_[r].fraction_bits,
            run_pool_pointer(static_cast<int>(streams.size()), column, sensor_.np, sensor_.acquisitions,
                             pool_pointer_parameters(readouts_[r]), &prior));
    }
  }
}

std::vector<std::vector<ErrorShares>> VideoReader::read(const Sequence& sequence, Progress* progress,
                                                        const Watcher& watch) const {
  const std::vector<Block> all_blocks = blocks();
  const int columns = sequence.parameters.columns;
  std::vector<std::vector<ErrorShares>> shares;
  std::vector<std::vector<PoolPrior>> priors(
      static_cast<std::size_t>(columns));  // of the block that begins there
  for (int frame = 0; frame < sequence.frames; ++frame) {
    SequenceFrame next = sequence_frame(sequence, frame);
    const PhotonSource source(sensor_, next.targets, next.klux, seed_,
                              scene_frame(static_cast<std::uint32_t>(frame)));
    VideoFrame seen{.targets = std::move(next.targets), .distance_m = {}, .shares = {}};
    const auto width = static_cast<std::size_t>(columns);
    seen.distance_m.assign(titles_.size(),
                           std::vector<double>(width * static_cast<std::size_t>(seen.targets.rows())));
    for (const Block& block : all_blocks) {
      const auto count = static_cast<std::size_t>((columns + block.columns - 1) / block.columns);
      parallel_for(count, threads_, [&](std::size_t index) {
        const int first = static_cast<int>(index) * block.columns;
        read_block(block, first, source, priors[static_cast<std::size_t>(first)], seen);
      });
    }
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
