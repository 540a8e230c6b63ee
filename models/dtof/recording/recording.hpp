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
#include "dtof/io/npy.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/resampling.hpp"
#include "dtof/recording/stream_csv.hpp"

namespace dtof {

inline constexpr std::array<std::string_view, 9> kRecordingFormats = {
    "csv", "npy", "npz", "mat", "hdf5", "photon-hdf5", "picoquant", "tmf8820", "tmf8829"};

/// The member of an NPZ archive that says how wide the bins of its histograms are, in ps.
inline constexpr std::string_view kBinWidthName = "bin_width_ps";

/// How a recorded file becomes a stream.
struct RecordingOptions {
  std::string file;             ///< of an archive also "file.h5:/cube" (container/array_address.hpp)
  std::string format = "auto";  ///< auto (by content, else by name), or one of kRecordingFormats
  std::optional<double> bin_width_s = std::nullopt;  ///< of histograms in arrays
  double tick_s = 8e-12;                             ///< MAT: duration of a tick
  std::string variable = "photon_times";
  std::optional<std::uint32_t> acquisitions = std::nullopt;
  std::optional<int> columns = std::nullopt;  ///< CSV: of the sensor; none: the last that detected something
  std::optional<int> rows = std::nullopt;     ///< CSV: likewise
  Resampling resampling = {};                 ///< for measured histograms and photon times
};

/// A file that has been read, once, so that it may be a pipe.
struct RecordingFile {
  /// Unpacked, if it was gzip; empty for hdf5, photon-hdf5 and picoquant, which are read in pieces.
  std::string contents;
  std::string format;  ///< one of kRecordingFormats
};

/// What a file holds, before photons are drawn from it.
struct RecordedData {
  std::string description;
  std::variant<HistogramCube, PhotonTimes, RecordedStream> data;
};

/// A recorded frame; distances as the file knows them.
struct Recording {
  std::string description;
  std::unique_ptr<StreamSource> source;
  /// True distance in m, index = row * columns + column, NaN = unknown; empty: the file knows none.
  std::vector<double> true_distance;
};

/// Reads `options.file` and finds its kind: `options.format`, for auto what the content says, else the name.
/// Throws InputError.
RecordingFile read_recording(const RecordingOptions& options);

/// What a file that has been read holds. Throws InputError that names the file
/// (and line) and what is wrong with it.
RecordedData open_recorded_data(const RecordingOptions& options, const RecordingFile& file);

/// The array in a file of format npy, npz, mat or hdf5, as it stands there. Of an archive without a name in
/// `options.file` it is "histograms" or "depth_m", as `dtof convert` names them, else the only one. A MATLAB
/// variable without a name in `options.file` is `options.variable`. Throws InputError.
NpyArray open_array(const RecordingOptions& options, const RecordingFile& file);

/// The frame of a file that has been read; its contents are released. Throws InputError that names the file
/// (and line) and what is wrong with it.
Recording open_recording(const RecordingOptions& options, RecordingFile file);

}  // namespace dtof
