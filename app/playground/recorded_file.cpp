// SPDX-License-Identifier: Apache-2.0
#include "playground/recorded_file.hpp"

#include <fmt/format.h>

#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/plain_recording.hpp"
#include "dtof/recording/recording.hpp"
#include "dtof/recording/recording_format.hpp"

namespace dtof {
namespace {

/// MATLAB 7.3 has a text in front of what makes it HDF5.
bool is_hdf5_text(std::string_view contents) {
  return contents.starts_with("\x89HDF\r\n\x1a\n") || contents.starts_with("MATLAB 7.3 MAT-file");
}

/// Throws InputError if photons were measured, but none of them within T_int.
void require_photons_in_range(const ResampledStream& stream, const std::string& name, double range_s) {
  std::vector<int> columns(static_cast<std::size_t>(stream.columns()));
  std::iota(columns.begin(), columns.end(), 0);
  const PhotonCount photons = stream.count_photons(columns, {0, stream.rows()});
  if (photons.all > 0 && photons.outside == photons.all) {
    throw InputError(fmt::format("{}: all {} photons are outside the range, 0 to {:g} ns", name, photons.all,
                                 range_s * 1e9));
  }
}

/// Most photons of a recording that a page draws without a budget, as many times as read-outs ask for them.
constexpr double kMostPhotons = 0x1.0p26;

/// Throws InputError if without a budget so many photons are drawn that the page would stand still.
void require_few_photons(const HistogramCube& cube, const Resampling& resampling) {
  const double photons = std::accumulate(cube.counts.begin(), cube.counts.end(), 0.0);
  if (!resampling.photon_budget && photons > kMostPhotons) {
    cube.fail(fmt::format(
        "its {:.0f} photons are more than the {:.0f} that a page draws: give the photons per pixel", photons,
        kMostPhotons));
  }
}

RecordedData open_data(const RecordingOptions& options, const RecordingFile& file) {
  const std::string& name = options.file;
  if (is_plain_recording(file.format)) {
    return open_plain_recording(name, options, file);
  }
  if (file.format == "mat" && !options.bin_width_s) {
    return recorded_times(parse_photon_times_mat(name, file.contents, options.variable));
  }
  if (file.format != "mat" && file.format != "npy") {
    throw InputError(name + ": not a recording that a page reads");
  }
  if (!options.bin_width_s) {
    throw InputError(fmt::format("{}: an NPY histogram needs the width of a bin in ps", name));
  }
  const NpyArray array = file.format == "npy" ? parse_npy(name, file.contents)
                                              : parse_mat_array(name, file.contents, options.variable);
  return {.description = {}, .data = histogram_cube(array, *options.bin_width_s, 0.0, name)};
}

}  // namespace

std::string playground_recording_line(const PlaygroundFiles& files) {
  const std::string& name = files.recording_name;
  if (is_hdf5_text(files.recording)) {
    throw InputError(
        name +
        ": HDF5 (also MATLAB 7.3 and Photon-HDF5) needs libhdf5, which a page does not have; dtof "
        "convert makes an NPZ or a CSV of it");
  }
  const std::string format = find_recording_format(name, files.recording);
  if (format.empty()) {
    return "";
  }
  const bool has_width = format == "csv" || format == "picoquant" || format == "tmf8829";
  const bool lacks_width = format == "npy" || format == "vl53l8ch";
  return fmt::format("{}\t{}\t{}", format, format == "csv" ? 0 : 1,
                     has_width     ? "no"
                     : lacks_width ? "must"
                                   : "may");
}

std::unique_ptr<StreamSource> open_recorded_file(const PlaygroundFiles& files, const Resampling& resampling) {
  RecordingOptions options{.file = files.recording_name, .resampling = resampling};
  const RecordingFile file{.contents = files.recording,
                           .format = find_recording_format(files.recording_name, files.recording)};
  if (files.bin_width_ps > 0.0) {
    options.bin_width_s = files.bin_width_ps * 1e-12;
  }
  RecordedData recorded = open_data(options, file);
  if (auto* const stream = std::get_if<RecordedStream>(&recorded.data)) {
    return std::make_unique<RecordedStream>(std::move(*stream));
  }
  std::unique_ptr<ResampledStream> drawn;
  if (auto* const photons = std::get_if<PhotonTimes>(&recorded.data)) {
    drawn = std::make_unique<PhotonTimesStream>(std::move(*photons), options.tick_s, resampling);
  } else {
    require_few_photons(std::get<HistogramCube>(recorded.data), resampling);
    drawn = std::make_unique<HistogramStream>(std::get<HistogramCube>(std::move(recorded.data)), resampling);
  }
  require_photons_in_range(*drawn, files.recording_name, resampling.integration_time);
  return drawn;
}

}  // namespace dtof
