// SPDX-License-Identifier: Apache-2.0
#include "study/video_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "frame/flat_calibration.hpp"
#include "photon/photon_source.hpp"
#include "readout/model.hpp"
#include "readout/pool_pointer2.hpp"
#include "study/readout_variant.hpp"

namespace dtof {
VideoStudy::VideoStudy(SensorModel sensor, std::span<const ReadoutParameters> readouts, double table_klux,
                       std::uint64_t seed, int threads)
    : sensor_(std::move(sensor)),
      readouts_(readouts.begin(), readouts.end()),
      seed_(seed),
      threads_(threads) {
  const auto pool2 = std::ranges::find(readouts_, Readout::kPoolPointer2, &ReadoutParameters::readout);
  if (pool2 == readouts_.end()) {
    throw InputError("video: poolPointer 2 must be among the read-outs, for its prior is judged");
  }
  pool2_ = static_cast<std::size_t>(pool2 - readouts_.begin());
  for (const ReadoutParameters& readout : readouts_) {
    titles_.push_back(variant_title(readout, sensor_));
  }
  titles_.emplace_back(kWithPrior);
  const FlatCalibration calibration(sensor_);
  const auto photons = [&](const TargetMap& targets) {
    return std::make_unique<PhotonSource>(sensor_, targets, table_klux, seed_, FlatCalibration::kFrame);
  };
  tables_ = calibration.fit(photons, readouts_, seed_, threads_);
  tables_.push_back(tables_[pool2_]);
}

std::vector<std::vector<ErrorShares>> VideoStudy::measure(const Sequence& sequence,
                                                          Progress* progress) const {
  const PoolPointer2Parameters pool2 = pool_pointer2_parameters(readouts_[pool2_]);
  const int columns = sequence.parameters.columns;
  const auto width = static_cast<std::size_t>(columns);
  const int together = pool2.engine_columns;
  const auto engines = static_cast<std::size_t>((columns + together - 1) / together);
  std::vector<std::vector<PoolPrior>> priors(engines);
  std::vector<std::vector<ErrorShares>> shares;
  for (int frame = 0; frame < sequence.frames; ++frame) {
    SequenceFrame seen = sequence_frame(sequence, frame);
    const PhotonSource source(sensor_, seen.targets, seen.klux, seed_,
                              scene_frame(static_cast<std::uint32_t>(frame)));
    const StudyScene scene{"frame", std::move(seen.targets), columns};
    const auto rows = static_cast<std::size_t>(scene.targets.rows());
    const SceneMeasurement blank{std::vector<double>(width * rows), std::vector<double>(width * rows)};
    std::vector<SceneMeasurement> measurements(titles_.size(), blank);
    // poolPointer 2 hears the columns of an engine, the others at most their own.
    parallel_for(engines, threads_, [&](std::size_t engine) {
      const int first = static_cast<int>(engine) * together;
      std::vector<ColumnStream> streams;
      for (int column = first; column < std::min(first + together, columns); ++column) {
        streams.push_back(source.column(column));
      }
      const auto store = [&](std::size_t estimator, int fraction_bits,
                             const std::vector<std::vector<PixelResult>>& results) {
        for (std::size_t column = 0; column < results.size(); ++column) {
          for (std::size_t row = 0; row < rows; ++row) {
            const std::size_t place = row * width + static_cast<std::size_t>(first) + column;
            const Measurement measured = to_measurement(results[column][row], fraction_bits);
            measurements[estimator].distance_m[place] = tables_[estimator].distance(measured.position);
            measurements[estimator].confidence[place] = measured.confidence;
          }
        }
      };
      for (std::size_t r = 0; r < readouts_.size(); ++r) {
        store(r, readouts_[r].fraction_bits,
              make_readout_model(readouts_[r])->run_columns(streams, sensor_.acquisitions));
      }
      const auto column = [&](int index) -> const ColumnStream& {
        return streams[static_cast<std::size_t>(index)];
      };
      store(readouts_.size(), readouts_[pool2_].fraction_bits,
            run_pool_pointer2(static_cast<int>(streams.size()), column, sensor_.np, sensor_.acquisitions,
                              pool2, &priors[engine]));
    });
    const SceneTruth truth = scene_truth(scene);
    std::vector<ErrorShares>& of_frame = shares.emplace_back();
    for (const SceneMeasurement& measurement : measurements) {
      of_frame.push_back(score_scene(truth, measurement).all);
    }
    if (progress != nullptr) {
      progress->advance();
    }
  }
  return shares;
}

ErrorShares pooled(std::span<const ErrorShares> frames) {
  ErrorShares sum;
  double squares = 0.0;
  for (const ErrorShares& frame : frames) {
    const auto pixels = static_cast<double>(frame.pixels);
    sum.pixels += frame.pixels;
    sum.above_3_percent += frame.above_3_percent * pixels;
    sum.above_10_percent += frame.above_10_percent * pixels;
    squares += frame.rmse * frame.rmse * pixels;
  }
  if (sum.pixels > 0) {
    const auto pixels = static_cast<double>(sum.pixels);
    sum.above_3_percent /= pixels;
    sum.above_10_percent /= pixels;
    sum.rmse = std::sqrt(squares / pixels);
  }
  return sum;
}

}  // namespace dtof
