// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/stream_csv.hpp"
#include "dtof/recording/tmf8820_json.hpp"
#include "dtof/recording/tmf8820_log.hpp"
#include "dtof/recording/tmf8829_json.hpp"

namespace dtof {
namespace {

/// Before its first histogram a log may have the lines of the sensor's start.
constexpr std::size_t kStartOfLog = std::size_t{1} << 16U;

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

/// Whether the name ends with `ending`, whatever the case of its letters.
bool name_ends(std::string name, std::string_view ending) {
  std::ranges::transform(name, name.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return name.ends_with(ending);
}

/// What a name ends with, and the kind of file that has it.
struct NameEnding {
  std::string_view ending;
  const char* format;
};

/// What the content says of a file, else its name. Throws InputError.
std::string find_format(const std::string& name, std::string_view contents) {
  constexpr std::array<NameEnding, 8> kEndings = {{{".csv", "csv"},
                                                   {".csv.gz", "csv"},
                                                   {".npy", "npy"},
                                                   {".npy.gz", "npy"},
                                                   {".mat", "mat"},
                                                   {".mat.gz", "mat"},
                                                   {".json", "tmf8820"},
                                                   {".json.gz", "tmf8820"}}};
  const std::string_view text = without_byte_order_mark(contents);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const char first = begin == std::string_view::npos ? ' ' : text[begin];
  if (contents.starts_with("\x93NUMPY")) {
    return "npy";
  }
  if (contents.starts_with("MATLAB")) {
    return "mat";
  }
  if (first == '{') {  // a TMF8829 log is an object, the TMF8820 captures are an array
    return "tmf8829";
  }
  if (first == '[' || is_tmf8820_log(text.substr(0, kStartOfLog))) {
    return "tmf8820";
  }
  if (text.substr(0, text.find('\n')).find("acquisition") != std::string_view::npos) {
    return "csv";
  }
  const auto* const found =
      std::ranges::find_if(kEndings, [&](const NameEnding& known) { return name_ends(name, known.ending); });
  if (found == kEndings.end()) {
    throw InputError(fmt::format("{}: unknown kind of recording; name it with --format", name));
  }
  return found->format;
}

/// ", 2 ... are left out", or nothing.
std::string left_out_phrase(std::size_t count, std::string_view what) {
  return count == 0 ? "" : fmt::format(", {} {} left out", count, what);
}

Recording open_tmf8820(const RecordingOptions& options, const RecordingFile& file,
                       const Resampling& resampling) {
  Tmf8820Log log;
  if (is_tmf8820_log(file.contents)) {
    log = parse_tmf8820_log(options.file, file.contents);
  } else {
    log.captures = parse_tmf8820_json(options.file, file.contents);
  }
  return from_cube(tmf8820_cube(log.captures, kTmf8820BinWidth, 0.0, options.file), resampling,
                   fmt::format("ams TMF8820, {} captures of 9 zones{}", log.captures.size(),
                               left_out_phrase(log.incomplete, "incomplete")));
}

}  // namespace

RecordingFile read_recording(const RecordingOptions& options) {
  RecordingFile file;
  std::string packed = read_file(options.file);
  // A frame as text is longer than what other files may unpack to.
  const bool stream = options.format == "csv" || name_ends(options.file, ".csv.gz");
  if (packed.starts_with("\x1f\x8b")) {
    file.contents = unpack_gzip(options.file, std::move(packed), stream ? kLongestFile : kLongestUnpacked);
  } else {
    file.contents = std::move(packed);
  }
  file.format = options.format != "auto" ? options.format : find_format(options.file, file.contents);
  return file;
}

Recording open_recording(const RecordingOptions& options, RecordingFile file) {
  Resampling resampling = options.resampling;
  if (options.acquisitions) {
    resampling.acquisitions = *options.acquisitions;
  }
  if (file.format == "csv") {
    auto stream = std::make_unique<RecordedStream>(parse_stream_csv(options.file, file.contents,
                                                                    {.np = resampling.np,
                                                                     .slots = resampling.slots,
                                                                     .columns = options.columns,
                                                                     .rows = options.rows,
                                                                     .acquisitions = options.acquisitions}));
    Recording recording;
    recording.description = fmt::format("recorded stream, {} detections", stream->detection_count());
    recording.source = std::move(stream);
    return recording;
  }
  if (file.format == "tmf8820") {
    return open_tmf8820(options, file, resampling);
  }
  if (file.format == "tmf8829") {
    const Tmf8829Log log = parse_tmf8829_json(options.file, file.contents);
    return from_cube(tmf8829_cube(log, 0.0, options.file), resampling,
                     fmt::format("ams TMF8829, {} frames{}", log.frames.size(),
                                 left_out_phrase(log.left_out, "without results or histograms")));
  }
  if (file.format == "npy") {
    if (!options.bin_width_s) {
      throw InputError(fmt::format("{}: an NPY histogram needs --bin-width", options.file));
    }
    return from_cube(
        histogram_cube(parse_npy(options.file, file.contents), *options.bin_width_s, 0.0, options.file),
        resampling, "histogram cube");
  }
  PhotonTimes photons = parse_photon_times_mat(options.file, file.contents, options.variable);
  Recording recording;
  recording.description = fmt::format("photon times, {} photons of {} x {} pixels", photons.ticks.size(),
                                      photons.columns, photons.rows);
  recording.source = std::make_unique<PhotonTimesStream>(std::move(photons), options.tick_s, resampling);
  return recording;
}

}  // namespace dtof
