// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/recording/histogram_file.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/resampling.hpp"
#include "dtof/recording/stream_csv.hpp"

namespace dtof {

/// "tmf8820": captures as JSON, or the serial log of any sensor of the family, whose zones the log tells;
/// "tmf8821" and "tmf8828": a serial log of two captures per result, of four results per frame.
inline constexpr std::array<std::string_view, 12> kRecordingFormats = {
    "csv",       "npy",     "npz",     "mat",     "hdf5",    "photon-hdf5",
    "picoquant", "tmf8820", "tmf8821", "tmf8828", "tmf8829", "vl53l8ch"};

/// Member of an NPZ archive with the bin width of its histograms, in ps.
inline constexpr std::string_view kBinWidthName = "bin_width_ps";

/// Options for reading a recorded file as a stream.
struct RecordingOptions {
  std::string file;             ///< path; for an archive also "file.h5:/cube" (container/array_address.hpp)
  std::string format = "auto";  ///< auto (by content, else by name), or one of kRecordingFormats
  std::optional<double> bin_width_s = std::nullopt;  ///< bin width of histograms in arrays and logs
  double tick_s = 8e-12;                             ///< MAT: duration of a tick
  std::string variable = "photon_times";
  std::optional<std::uint32_t> acquisitions = std::nullopt;
  /// CSV: columns of the sensor; none: up to the last one that detected something.
  std::optional<int> columns = std::nullopt;
  /// CSV: rows of the sensor; none: up to the last one that detected something.
  std::optional<int> rows = std::nullopt;
  Resampling resampling = {};  ///< for histograms and photon times
};

/// Contents of a file, which is read once, so it may be a pipe.
struct RecordingFile {
  /// Contents, unpacked if they were gzip; empty for what is read piece by piece: npy and npz of regular
  /// files, hdf5, photon-hdf5, picoquant, and logs of lines unless their format was found in a pipe.
  std::string contents;
  std::string format;  ///< one of kRecordingFormats
};

/// Contents of a file, before photons are drawn from them. Histograms that can be read at any place stay in
/// their file.
struct RecordedData {
  std::string description;
  std::variant<HistogramCube, HistogramFile, PhotonTimes, RecordedStream> data;
};

/// A recorded frame with the true distances that the file holds.
struct Recording {
  std::string description;
  std::unique_ptr<StreamSource> source;
  /// True distance in m, index = row * columns + column, NaN = unknown; empty: the file has none.
  std::vector<double> true_distance;
};

/// Reads `options.file` and finds its format: `options.format`, or for "auto" the format of the content, else
/// that of the name. Throws InputError.
RecordingFile read_recording(const RecordingOptions& options);

/// Parses a file's contents. Throws InputError that names the file (and line) and the error.
RecordedData open_recorded_data(const RecordingOptions& options, const RecordingFile& file);

/// Makes the frame of a file and releases its contents. Throws InputError that names the file (and line) and
/// the error.
Recording open_recording(const RecordingOptions& options, RecordingFile file);

}  // namespace dtof
