// SPDX-License-Identifier: Apache-2.0
#include "measured_data/measured_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/tmf8829_json.hpp"

namespace dtof {
namespace {

PhotonTimes without_earlier(const PhotonTimes& photons, double from_tick) {
  PhotonTimes kept{photons.columns, photons.rows, {}, {0}};
  for (std::size_t pixel = 0; pixel + 1 < photons.begin.size(); ++pixel) {
    for (std::size_t i = photons.begin[pixel]; i < photons.begin[pixel + 1]; ++i) {
      if (photons.ticks[i] >= from_tick) {
        kept.ticks.push_back(photons.ticks[i]);
      }
    }
    kept.begin.push_back(kept.ticks.size());
  }
  return kept;
}

std::ptrdiff_t photons_near(std::span<const double> ticks, double surface) {
  return std::ranges::count_if(ticks, [&](double tick) { return std::abs(tick - surface) < kSurfaceTicks; });
}

}  // namespace

MeasuredScene tmf8829_scene(const std::filesystem::path& path) {
  const Tmf8829Log log = read_tmf8829_json(path);
  HistogramCube cube = tmf8829_cube(log, 0.0, path.string());
  MeasuredScene scene;
  scene.title = "TMF8829 log";
  scene.description = fmt::format(
      "Log of an ams TMF8829, {} frames{}. It holds the histograms of the sensor's row 0 only; read-outs "
      "that "
      "pool "
      "pixels need neighbours in a column, so each frame is a column here and the {} zones of row 0 are its "
      "rows. "
      "Truth: the distance that the sensor itself reported.",
      log.frames.size(),
      log.left_out == 0 ? "" : fmt::format(", {} without results or histograms left out", log.left_out),
      cube.rows);
  scene.columns = cube.columns;
  scene.rows = cube.rows;
  for (const double distance : cube.true_distance) {
    scene.true_m.push_back(std::isnan(distance) ? 0.0 : distance);
  }
  scene.frame = [cube = std::move(cube)](const Resampling& resampling) -> std::unique_ptr<StreamSource> {
    return std::make_unique<HistogramStream>(cube, resampling);
  };
  return scene;
}

MeasuredScene two_surfaces_scene(TwoSurfaces recording) {
  const auto same_size = [&](const MatMatrix& matrix) {
    return matrix.columns == recording.photons.columns && matrix.rows == recording.photons.rows;
  };
  if (!same_size(recording.first) || !same_size(recording.second)) {
    throw InputError(fmt::format("surfaces of {} x {} and {} x {} pixels, photon times of {} x {}",
                                 recording.first.columns, recording.first.rows, recording.second.columns,
                                 recording.second.rows, recording.photons.columns, recording.photons.rows));
  }
  const PhotonTimes photons = without_earlier(recording.photons, recording.from_tick);
  const auto distance = [&](double tick) {
    return 0.5 * kSpeedOfLight * (tick * recording.tick_s + recording.shift_s);
  };
  MeasuredScene scene;
  scene.columns = photons.columns;
  scene.rows = photons.rows;
  const auto count = static_cast<std::size_t>(scene.columns) * static_cast<std::size_t>(scene.rows);
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    const auto ticks = std::span(photons.ticks)
                           .subspan(photons.begin[pixel], photons.begin[pixel + 1] - photons.begin[pixel]);
    const double first = recording.first.values[pixel];
    const double second = recording.second.values[pixel];
    const std::ptrdiff_t near_first = photons_near(ticks, first);
    const std::ptrdiff_t near_second = photons_near(ticks, second);
    const bool second_is_stronger = near_second > near_first;
    const double stronger = distance(second_is_stronger ? second : first);
    const bool known = near_first + near_second > 0 && std::isfinite(stronger) && stronger > 0.0;
    scene.true_m.push_back(known ? stronger : 0.0);
    const double other = distance(second_is_stronger ? first : second);
    if (recording.from_tick <= 0.0) {
      scene.other_m.push_back(known && std::isfinite(other) ? other : scene.true_m.back());
    }
  }
  const double mean =
      static_cast<double>(photons.ticks.size()) / static_cast<double>(std::max<std::size_t>(1, count));
  scene.title = recording.from_tick > 0.0 ? "Photon times, the surface behind" : "Photon times, two surfaces";
  scene.description = fmt::format(
      "Photon arrival times, {} x {} pixels, {:.1f} photons per pixel in the mean{}. Truth: the surface, as "
      "estimated "
      "from all photons, that more of the pixel's photons come from.",
      scene.columns, scene.rows, mean,
      recording.from_tick > 0.0
          ? fmt::format(" after tick {:g}; earlier ones are left out", recording.from_tick)
          : "");
  scene.frame = [photons, tick_s = recording.tick_s,
                 shift_s = recording.shift_s](Resampling resampling) -> std::unique_ptr<StreamSource> {
    resampling.time_shift = shift_s;
    return std::make_unique<PhotonTimesStream>(photons, tick_s, resampling);
  };
  return scene;
}

}  // namespace dtof
