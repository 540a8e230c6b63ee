// SPDX-License-Identifier: Apache-2.0
#include "measured_data/measured_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/recording/histogram_file.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/recording_format.hpp"
#include "dtof/report/table.hpp"
#include "measured_data/strongest_return.hpp"

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

[[noreturn]] void fail(const RecordedSceneOptions& options, const std::string& reason) {
  throw InputError(fmt::format("{}: {}", options.recording.file, reason));
}

/// Distance of light that returns at a time, m.
double distance_at(double time_s) { return 0.5 * kSpeedOfLight * time_s; }

/// True distances from the photons themselves. `events_of` fills a pixel's events, in ascending time, within
/// `span_s`.
void find_returns(MeasuredScene& scene, const RecordedSceneOptions& options, double span_s, double window_s,
                  const std::function<void(std::size_t, std::vector<TimedEvents>&)>& events_of) {
  const auto count = static_cast<std::size_t>(scene.columns) * static_cast<std::size_t>(scene.rows);
  scene.true_m.assign(count, 0.0);
  std::size_t without = 0;
  std::vector<TimedEvents> events;
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    events.clear();
    events_of(pixel, events);
    const std::optional<double> time = strongest_return(events, window_s, span_s);
    const double distance = time ? distance_at(*time + options.shift_s) : 0.0;
    scene.true_m[pixel] = std::max(0.0, distance);
    without += distance > 0.0 ? 0 : 1;
  }
  if (without == count) {
    fail(options,
         fmt::format("none of its {} pixels has a return: chance explains the number of photons in the "
                     "fullest {:g} ns of each (--return-window); --truth gives distances",
                     count, window_s * 1e9));
  }
  scene.truth.origin = TruthOrigin::kStrongestReturn;
  scene.truth.window_s = window_s;
  scene.truth.without_return = without;
}

/// True distances of the recording, those of pixels without photons left out; empty if it has none.
std::vector<double> own_truth(const HistogramCube& cube) {
  std::vector<double> truth;
  for (std::size_t pixel = 0; pixel < cube.true_distance.size(); ++pixel) {
    const auto bins = static_cast<std::size_t>(cube.bins);
    const auto counts = std::span(cube.counts).subspan(pixel * bins, bins);
    const bool dark = std::ranges::all_of(counts, [](double photons) { return photons == 0.0; });
    const double distance = cube.true_distance[pixel];
    truth.push_back(dark || std::isnan(distance) ? 0.0 : distance);
  }
  const bool known = std::ranges::any_of(truth, [](double distance) { return distance > 0.0; });
  return known ? truth : std::vector<double>();
}

MeasuredScene histogram_scene(HistogramCube cube, const RecordedSceneOptions& options) {
  MeasuredScene scene;
  scene.columns = cube.columns;
  scene.rows = cube.rows;
  scene.true_m = own_truth(cube);
  if (scene.true_m.empty() && !options.truth_is_given) {
    const auto bins = static_cast<std::size_t>(cube.bins);
    const double window = std::max(options.return_window_s.value_or(kReturnWindow), cube.bin_width);
    find_returns(scene, options, static_cast<double>(cube.bins) * cube.bin_width, window,
                 [&](std::size_t pixel, std::vector<TimedEvents>& events) {
                   for (std::size_t bin = 0; bin < bins; ++bin) {
                     const double middle = cube.offset + (static_cast<double>(bin) + 0.5) * cube.bin_width;
                     events.push_back({middle, cube.counts[pixel * bins + bin]});
                   }
                 });
  }
  scene.frame = [cube = std::move(cube),
                 shift_s = options.shift_s](Resampling resampling) -> std::unique_ptr<StreamSource> {
    resampling.time_shift = shift_s;
    return std::make_unique<HistogramStream>(cube, resampling);
  };
  return scene;
}

MeasuredScene photon_times_scene(PhotonTimes photons, const RecordedSceneOptions& options) {
  MeasuredScene scene;
  scene.columns = photons.columns;
  scene.rows = photons.rows;
  const double tick_s = options.recording.tick_s;
  if (!options.truth_is_given && !photons.ticks.empty()) {
    const auto [first, last] = std::ranges::minmax(photons.ticks);
    find_returns(scene, options, (last - first + 1.0) * tick_s,
                 options.return_window_s.value_or(kReturnWindow),
                 [&](std::size_t pixel, std::vector<TimedEvents>& events) {
                   for (std::size_t i = photons.begin[pixel]; i < photons.begin[pixel + 1]; ++i) {
                     events.push_back({photons.ticks[i] * tick_s, 1.0});
                   }
                   std::ranges::sort(events, {}, &TimedEvents::time_s);
                 });
  }
  scene.frame = [photons = std::move(photons), tick_s,
                 shift_s = options.shift_s](Resampling resampling) -> std::unique_ptr<StreamSource> {
    resampling.time_shift = shift_s;
    return std::make_unique<PhotonTimesStream>(photons, tick_s, resampling);
  };
  return scene;
}

}  // namespace

MeasuredScene recorded_scene(const RecordedSceneOptions& options, RecordingFile file) {
  const bool is_tmf8829 = file.format == "tmf8829";
  const bool is_plane = file.format == "tmf8820" && first_character(file.contents) == '[';
  RecordedData recorded = open_recorded_data(options.recording, file);
  file = {};  // its contents
  MeasuredScene scene;
  if (auto* const histograms = std::get_if<HistogramFile>(&recorded.data)) {
    recorded.data = held_cube(std::move(*histograms));
  }
  if (auto* const cube = std::get_if<HistogramCube>(&recorded.data)) {
    cube->validate();
    scene = histogram_scene(std::move(*cube), options);
  } else if (auto* const photons = std::get_if<PhotonTimes>(&recorded.data)) {
    scene = photon_times_scene(std::move(*photons), options);
  } else {
    fail(options,
         "a TDC stream is one frame as it was recorded, from which no others can be drawn; dtof "
         "replay reads it out");
  }
  if (scene.truth.origin == TruthOrigin::kUnknown) {
    if (options.return_window_s) {
      throw InputError("--return-window has no effect: the recording has true distances");
    }
    scene.truth.origin = is_plane ? TruthOrigin::kPlane : TruthOrigin::kSensor;
  }
  scene.title = "Recording: " + recorded.description.substr(0, recorded.description.find(','));
  scene.contents = recorded.description;
  scene.is_tmf8829 = is_tmf8829;
  return scene;
}

void leave_out_beyond_range(MeasuredScene& scene, double integration_time, const std::string& name) {
  const double range_m = distance_at(integration_time);
  std::size_t beyond = 0;
  for (double& truth : scene.true_m) {
    beyond += truth >= range_m ? 1 : 0;
    truth = truth >= range_m ? 0.0 : truth;
  }
  if (std::ranges::none_of(scene.true_m, [](double truth) { return truth > 0.0; })) {
    throw InputError(
        beyond == 0 ? fmt::format("{}: no pixel has a known distance", name)
                    : fmt::format("{}: every true distance is beyond the range, {:.2f} m (light there and "
                                  "back in {:g} ns): --t-int changes it",
                                  name, range_m, integration_time * 1e9));
  }
  scene.truth.range_m = range_m;
  scene.truth.beyond_range = beyond;
}

std::string truth_csv(const MeasuredScene& scene) {
  Table csv({"column", "row", "true_m", "other_m"});
  for (std::size_t pixel = 0; pixel < scene.true_m.size(); ++pixel) {
    const auto width = static_cast<std::size_t>(scene.columns);
    const double truth = scene.true_m[pixel];
    csv.add({fmt::format("{}", pixel % width), fmt::format("{}", pixel / width),
             truth > 0.0 ? fmt::format("{:.6f}", truth) : "",
             truth > 0.0 && !scene.other_m.empty() ? fmt::format("{:.6f}", scene.other_m[pixel]) : ""});
  }
  return csv.csv();
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
  scene.mean_photons =
      static_cast<double>(photons.ticks.size()) / static_cast<double>(std::max<std::size_t>(1, count));
  scene.from_tick = recording.from_tick;
  scene.title = recording.from_tick > 0.0 ? "Photon times, the surface behind" : "Photon times, two surfaces";
  scene.truth.origin = TruthOrigin::kSurface;
  scene.frame = [photons, tick_s = recording.tick_s,
                 shift_s = recording.shift_s](Resampling resampling) -> std::unique_ptr<StreamSource> {
    resampling.time_shift = shift_s;
    return std::make_unique<PhotonTimesStream>(photons, tick_s, resampling);
  };
  return scene;
}

}  // namespace dtof
