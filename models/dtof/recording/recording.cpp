// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/stream_csv.hpp"
#include "dtof/recording/tmf8820_json.hpp"
#include "dtof/recording/tmf8829_json.hpp"

namespace dtof {
namespace {

// A pixel whose histogram is empty measured nothing: its result is no measurement of the true distance.
void forget_truth_without_photons(const HistogramCube& cube, std::vector<double>& true_distance) {
  for (std::size_t i = 0; i < true_distance.size(); ++i) {
    const auto pixel =
        std::span(cube.counts)
            .subspan(i * static_cast<std::size_t>(cube.bins), static_cast<std::size_t>(cube.bins));
    if (std::all_of(pixel.begin(), pixel.end(), [](double count) { return count == 0.0; })) {
      true_distance[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

Recording from_cube(HistogramCube cube, const Resampling& resampling, std::string what) {
  Recording recording;
  recording.true_distance = cube.true_distance;
  forget_truth_without_photons(cube, recording.true_distance);
  recording.description = std::move(what);
  recording.source = std::make_unique<HistogramStream>(std::move(cube), resampling);
  return recording;
}

}  // namespace

std::string recording_format(const RecordingOptions& options) {
  if (options.format != "auto") {
    return options.format;
  }
  const std::string& file = options.file;
  if (file.ends_with(".csv")) {
    return "csv";
  }
  if (file.ends_with(".npy")) {
    return "npy";
  }
  if (file.ends_with(".mat")) {
    return "mat";
  }
  if (file.ends_with(".json") || file.ends_with(".json.gz")) {
    // A TMF8829 log is an object, the TMF8820 captures are an array.
    const std::string text = read_file_or_gzip(file);
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    return begin != std::string::npos && text[begin] == '{' ? "tmf8829" : "tmf8820";
  }
  throw InputError(fmt::format("{}: unknown kind of recording; name it with --format", file));
}

Recording open_recording(const RecordingOptions& options) {
  const std::string format = recording_format(options);
  Resampling resampling = options.resampling;
  if (options.acquisitions) {
    resampling.acquisitions = *options.acquisitions;
  }
  if (format == "csv") {
    auto stream = std::make_unique<RecordedStream>(
        read_stream_csv(options.file, {.np = resampling.np,
                                       .slots = resampling.slots,
                                       .columns = options.columns,
                                       .rows = options.rows,
                                       .acquisitions = options.acquisitions}));
    Recording recording;
    recording.description = fmt::format("recorded stream, {} detections", stream->detection_count());
    recording.source = std::move(stream);
    return recording;
  }
  if (format == "tmf8820") {
    const std::vector<Tmf8820Capture> captures = read_tmf8820_json(options.file);
    return from_cube(tmf8820_cube(captures), resampling,
                     fmt::format("ams TMF8820, {} captures of 9 zones", captures.size()));
  }
  if (format == "tmf8829") {
    const std::vector<Tmf8829Frame> frames = read_tmf8829_json(options.file);
    return from_cube(tmf8829_cube(frames), resampling, fmt::format("ams TMF8829, {} frames", frames.size()));
  }
  if (format == "npy") {
    if (!options.bin_width_s) {
      throw InputError(fmt::format("{}: an NPY histogram needs --bin-width", options.file));
    }
    return from_cube(histogram_cube(read_npy(options.file), *options.bin_width_s), resampling,
                     "histogram cube");
  }
  PhotonTimes photons = read_photon_times_mat(options.file, options.variable);
  Recording recording;
  recording.description = fmt::format("photon times, {} photons of {} x {} pixels", photons.ticks.size(),
                                      photons.columns, photons.rows);
  recording.source = std::make_unique<PhotonTimesStream>(std::move(photons), options.tick_s, resampling);
  return recording;
}

}  // namespace dtof
