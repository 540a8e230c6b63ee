// SPDX-License-Identifier: Apache-2.0
#include "rivals/rival_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "dtof/core/parallel.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/pooled_matched_filter.hpp"

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
  std::size_t frames = 1;
  bool needs_laser_off = false;
  for (const std::unique_ptr<Rival>& rival : rivals_) {
    frames = std::max(frames, static_cast<std::size_t>(rival->frames()));
    needs_laser_off = needs_laser_off || rival->laser_off_frames() > 0;
  }
  const PhotonSource source(sensor_, scene.targets, klux_, seed_, frame);
  SensorModel without_laser = sensor_;
  without_laser.signal_events_1m = 0.0;
  const PhotonSource background(without_laser, scene.targets, klux_, seed_, frame);
  const auto width = static_cast<std::size_t>(scene.columns);
  const auto rows = static_cast<std::size_t>(scene.targets.rows());
  const std::size_t rows_of_rival = pooled ? 2 : 1;
  Positions positions(rows_of_rival * rivals_.size(), std::vector<Measurement>(width * rows));
  parallel_for(width, threads_, [&](std::size_t index) {
    const int column = picked_column(scene, static_cast<int>(index));
    std::vector<ColumnStream> streams;  // the oldest first
    std::vector<ColumnStream> laser_off;
    for (std::size_t before = frames; before-- > 1;) {
      streams.push_back(source.at_frame(earlier_frame(frame, before)).column(column));
      if (needs_laser_off) {
        laser_off.push_back(background.at_frame(earlier_frame(frame, before)).column(column));
      }
    }
    streams.push_back(source.column(column));
    for (std::size_t r = 0; r < rivals_.size(); ++r) {
      const Rival& rival = *rivals_[r];
      std::vector<RivalWords> words;
      std::vector<Measurement> alone;
      for (std::size_t row = 0; row < rows; ++row) {
        std::vector<std::span<const Detection>> pixel;
        const std::size_t first = frames - static_cast<std::size_t>(rival.frames());
        const std::size_t first_lit = first + static_cast<std::size_t>(rival.laser_off_frames());
        for (std::size_t f = first; f < frames; ++f) {
          pixel.push_back((f < first_lit ? laser_off : streams)[f].row(static_cast<int>(row)));
        }
        words.push_back(rival.read_pixel(pixel));
        alone.push_back(rival.decode(words.back()));
        positions[r * rows_of_rival][row * width + index] = alone.back();
      }
      if (pooled) {
        const std::vector<Measurement> helped = pool_pixels(rival, words, alone);
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
