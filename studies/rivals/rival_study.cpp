// SPDX-License-Identifier: Apache-2.0
#include "rivals/rival_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "dtof/core/parallel.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/readout/pooled_matched_filter.hpp"
#include "dtof/rival/rival_reader.hpp"

namespace dtof {
namespace {

constexpr std::size_t kMedianReach = 2;

/// Frames before a frame; scenes and the calibration have others.
constexpr std::uint32_t earlier_frame(std::uint32_t frame, std::size_t before) {
  return frame + 2 * static_cast<std::uint32_t>(before);
}

/// What the host makes of a column of pixels that help each other.
std::vector<Measurement> pool_pixels(const Rival& rival, std::span<const RivalWords> words,
                                     std::span<const Measurement> alone) {
  std::vector<Measurement> pooled(alone.begin(), alone.end());
  std::vector<std::vector<double>> scores;
  for (const RivalWords& pixel : words) {
    scores.push_back(rival.evidence(pixel));
  }
  if (scores.front().empty()) {
    std::vector<double> positions;
    for (const Measurement& pixel : alone) {
      positions.push_back(pixel.position);
    }
    const std::vector<double> middle = running_median(positions, kMedianReach);
    for (std::size_t row = 0; row < pooled.size(); ++row) {
      pooled[row].position = middle[row];
    }
    return pooled;
  }
  const std::vector<MatchedFilter::Result> results = pool_column(scores);
  for (std::size_t row = 0; row < pooled.size(); ++row) {
    pooled[row] = {results[row].position, results[row].score};
  }
  return pooled;
}

}  // namespace

int pooling_operations(const Rival& rival) {
  constexpr int kOfACode = 10;   // two messages of a running maximum, sums, the largest belief
  constexpr int kOfAMedian = 8;  // comparisons of five values
  const std::vector<std::span<const Detection>> dark(static_cast<std::size_t>(rival.frames()));
  const std::size_t codes = rival.evidence(rival.read_pixel(dark)).size();
  return codes == 0 ? kOfAMedian : kOfACode * static_cast<int>(codes);
}

std::vector<double> running_median(std::span<const double> values, std::size_t reach) {
  std::vector<double> middle;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t begin = i - std::min(i, reach);
    const std::span<const double> near =
        values.subspan(begin, std::min(i + reach + 1, values.size()) - begin);
    middle.push_back(median({near.begin(), near.end()}));
  }
  return middle;
}

RivalStudy::RivalStudy(SensorModel sensor, double klux, std::span<const RivalEntry> rivals, bool pooled,
                       std::uint64_t seed, int threads, TableRule table)
    : sensor_(std::move(sensor)),
      klux_(klux),
      pooled_(pooled),
      seed_(seed),
      threads_(threads),
      scale_(sensor_.integration_time_s, sensor_.np, sensor_.pulse_fwhm_s) {
  for (const RivalEntry& entry : rivals) {
    rivals_.push_back(entry.make(sensor_));
    for (const char* suffix : {"", ", pooled"}) {
      if (*suffix == '\0' || pooled_) {
        titles_.push_back(fmt::format("{}{}", entry.title, suffix));
      }
    }
  }
  if (table == TableRule::kNone) {
    return;
  }
  const FlatCalibration calibration(sensor_);
  const StudyScene scene{"calibration", calibration.targets(),
                         static_cast<int>(calibration.distances_m().size())};
  for (const std::vector<Measurement>& positions : read(scene, FlatCalibration::kFrame, false)) {
    converters_.push_back(calibration.fit(positions, 0.0, seed_));
  }
}

RivalStudy::Positions RivalStudy::read(const StudyScene& scene, std::uint32_t frame, bool pooled) const {
  std::vector<std::uint32_t> frames;
  for (std::size_t before = most_frames(rivals_); before-- > 0;) {
    frames.push_back(earlier_frame(frame, before));
  }
  const RivalReader reader(sensor_, scene.targets, klux_, seed_, std::move(frames), rivals_);
  const auto width = static_cast<std::size_t>(scene.columns);
  const auto rows = static_cast<std::size_t>(scene.targets.rows());
  const std::size_t rows_of_rival = pooled ? 2 : 1;
  Positions positions(rows_of_rival * rivals_.size(), std::vector<Measurement>(width * rows));
  parallel_for(width, threads_, [&](std::size_t index) {
    const std::vector<std::vector<RivalWords>> words =
        reader.column(picked_column(scene, static_cast<int>(index)));
    for (std::size_t r = 0; r < rivals_.size(); ++r) {
      std::vector<Measurement> alone;
      for (std::size_t row = 0; row < rows; ++row) {
        alone.push_back(rivals_[r]->decode(words[r][row]));
        positions[r * rows_of_rival][row * width + index] = alone.back();
      }
      if (pooled) {
        const std::vector<Measurement> helped = pool_pixels(*rivals_[r], words[r], alone);
        for (std::size_t row = 0; row < rows; ++row) {
          positions[r * rows_of_rival + 1][row * width + index] = helped[row];
        }
      }
    }
  });
  return positions;
}

std::vector<SceneMeasurement> RivalStudy::measure(const StudyScene& scene) const {
  const Positions positions = read(scene, scene_frame(0), pooled_);
  std::vector<SceneMeasurement> measurements(titles_.size());
  for (std::size_t e = 0; e < titles_.size(); ++e) {
    const std::size_t rival = pooled_ ? e / 2 : e;
    for (const Measurement& pixel : positions[e]) {
      measurements[e].distance_m.push_back(converters_.empty() ? scale_.depth(pixel.position)
                                                               : converters_[rival].distance(pixel.position));
      measurements[e].confidence.push_back(pixel.confidence);
    }
  }
  return measurements;
}

}  // namespace dtof
