// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "dtof/container/array_address.hpp"
#include "dtof/container/hdf5_array.hpp"
#include "dtof/container/npz.hpp"
#include "dtof/container/photon_hdf5.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/byte_stream.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/photon_hdf5_cube.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/picoquant.hpp"
#include "dtof/recording/plain_recording.hpp"
#include "dtof/recording/recorded_array.hpp"
#include "dtof/recording/recording_format.hpp"

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

/// Format of a log or stream that is read line by line from its file; empty for another file, and for a pipe
/// whose contents decide.
std::string line_format(const RecordingOptions& options, const std::filesystem::path& path) {
  const std::string& asked = options.format;
  if (asked == "csv" || asked == "tmf8821" || asked == "tmf8828" || asked == "vl53l8ch") {
    return asked;
  }
  if (asked != "auto" && asked != "tmf8820") {
    return "";
  }
  const std::string start = file_start(path, kStartOfRecording);
  if (asked == "auto" && !start.empty() && find_recording_format(path.string(), start) == "csv") {
    return "csv";
  }
  const std::string found = format_of_contents(start);
  const bool lines = found == "vl53l8ch" || (found == "tmf8820" && first_character(start) != '[');
  return lines && (asked == "auto" || asked == found) ? found : "";
}

/// Cells of MATLAB 7.3 as photon times.
PhotonTimes times_of_cells(const std::filesystem::path& path, const Hdf5Cells& cells,
                           const std::string& name) {
  PhotonTimes photons{.columns = static_cast<int>(cells.shape[1]),
                      .rows = static_cast<int>(cells.shape[0]),
                      .ticks = {},
                      .begin = {0}};
  for (std::size_t pixel = 0; pixel < cells.cells.size(); ++pixel) {
    const std::vector<double>& times = cells.cells[pixel];
    if (!std::all_of(times.begin(), times.end(), [](double tick) { return std::isfinite(tick); })) {
      fail_in_file(path, fmt::format("\"{}\": column {}, row {} holds a time that is not finite", name,
                                     pixel % cells.shape[1], pixel / cells.shape[1]));
    }
    photons.ticks.insert(photons.ticks.end(), times.begin(), times.end());
    photons.begin.push_back(photons.ticks.size());
  }
  return photons;
}

/// Why histograms that have to be held are too many.
constexpr const char* kFarApart =
    "more than 2^27 counts, and those of a pixel or of a column of pixels lie far apart in the file; in an "
    "NPY file, which dtof convert writes, they have no limit";
constexpr const char* kForwardAlone =
    "more than 2^27 counts that are deflated or in Fortran order; in C order, in an NPY file or stored in an "
    "NPZ archive, they have no limit (dtof convert writes deflated ones as NPY)";

/// Histograms of an array; those of a file that is read in place stay there if they can be read at any place.
RecordedData open_histograms(const RecordingOptions& options, const RecordingFile& file) {
  const double bin_width = bin_width_of(options, file);
  HistogramFile histograms =
      histogram_file(open_array_reader(options, file), bin_width, 0.0, array_label(options, file));
  RecordedData data{.description = "histogram cube", .data = {}};
  if (is_read_in_place(file) && histograms.counts->any_place()) {
    data.data = std::move(histograms);
  } else {
    if (histograms.counts->count() > kMostHeldElements) {
      histograms.cube.fail(file.format == "hdf5" ? kFarApart : kForwardAlone);
    }
    data.data = held_cube(std::move(histograms));
  }
  return data;
}

}  // namespace

RecordingFile read_recording(const RecordingOptions& options) {
  RecordingFile file;
  const std::filesystem::path path = parse_array_address(options.file).file;
  constexpr std::size_t kMagic = 16;
  if (options.format.ends_with("hdf5") || (options.format == "auto" && is_hdf5(path))) {
    if (!is_hdf5(path)) {
      (void)ByteStream(path);  // a file that cannot be read has its own refusal
      fail_in_file(path, "not an HDF5 file, or a pipe");
    }
    // An array that is named is asked for as it is.
    const bool whole = options.format == "auto" && parse_array_address(options.file).array.empty();
    file.format = whole && is_photon_hdf5(path)     ? "photon-hdf5"
                  : options.format == "photon-hdf5" ? "photon-hdf5"
                                                    : "hdf5";
    return file;
  }
  if (options.format == "picoquant" || (options.format == "auto" && is_picoquant(file_start(path, kMagic)))) {
    file.format = "picoquant";
    return file;
  }
  if (std::string format = line_format(options, path); !format.empty()) {
    file.format = std::move(format);
    return file;
  }
  if (std::string format = format_read_in_place(path);
      !format.empty() && (options.format == "auto" || options.format == format)) {
    file.format = std::move(format);
    return file;
  }
  std::string packed = read_file(path);
  if (packed.starts_with("\x1f\x8b")) {
    file.contents = unpack_gzip(path, std::move(packed));
  } else {
    file.contents = std::move(packed);
  }
  file.format =
      options.format != "auto" ? options.format : find_recording_format(path.string(), file.contents);
  if (file.format.empty()) {
    fail_in_file(path, "unknown kind of recording; name it with --format");
  }
  return file;
}

RecordedData open_recorded_data(const RecordingOptions& options, const RecordingFile& file) {
  const std::filesystem::path path = parse_array_address(options.file).file;
  if (is_plain_recording(file.format)) {
    return open_plain_recording(path, options, file);
  }
  if (file.format == "photon-hdf5") {
    std::string description;
    HistogramCube cube = photon_hdf5_cube(path, description);
    return {.description = std::move(description), .data = std::move(cube)};
  }
  // A cell array of MATLAB has photon times, another variable histograms.
  if (file.format == "mat" && !options.bin_width_s) {
    return recorded_times(parse_photon_times_mat(path, file.contents, variable_of(options)));
  }
  if (file.format == "hdf5" && is_hdf5_cell_array(path, variable_of(options))) {
    const std::string name = variable_of(options);
    return recorded_times(times_of_cells(path, read_hdf5_cells(path, name), name));
  }
  return open_histograms(options, file);
}

Recording open_recording(const RecordingOptions& options, RecordingFile file) {
  Resampling resampling = options.resampling;
  if (options.acquisitions) {
    resampling.acquisitions = *options.acquisitions;
  }
  RecordedData measurement = open_recorded_data(options, file);
  file = {};  // its contents
  Recording recording;
  recording.description = std::move(measurement.description);
  if (auto* const cube = std::get_if<HistogramCube>(&measurement.data)) {
    recording.true_distance = cube->true_distance;
    forget_truth_without_photons(*cube, recording.true_distance);
    recording.source = std::make_unique<HistogramStream>(std::move(*cube), resampling);
  } else if (auto* const histograms = std::get_if<HistogramFile>(&measurement.data)) {
    recording.source = std::make_unique<HistogramFileStream>(std::move(*histograms), resampling);
  } else if (auto* const photons = std::get_if<PhotonTimes>(&measurement.data)) {
    recording.source = std::make_unique<PhotonTimesStream>(std::move(*photons), options.tick_s, resampling);
  } else {
    recording.source =
        std::make_unique<RecordedStream>(std::get<RecordedStream>(std::move(measurement.data)));
  }
  return recording;
}

}  // namespace dtof
