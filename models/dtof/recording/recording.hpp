// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/recording/resampling.hpp"

namespace dtof {

/// How a recorded file becomes a stream.
struct RecordingOptions {
  std::string file;
  std::string format = "auto";  ///< auto (by content, else by name), csv, npy, mat, tmf8820, tmf8829
  std::optional<double> bin_width_s = std::nullopt;  ///< NPY: width of a histogram bin
  double tick_s = 8e-12;                             ///< MAT: duration of a tick
  std::string variable = "photon_times";
  std::optional<std::uint32_t> acquisitions = std::nullopt;
  std::optional<int> columns = std::nullopt;  ///< CSV: of the sensor; none: the last that detected something
  std::optional<int> rows = std::nullopt;     ///< CSV: likewise
  Resampling resampling = {};                 ///< for measured histograms and photon times
};

/// A file that has been read, once, so that it may be a pipe.
struct RecordingFile {
  std::string contents;  ///< unpacked, if it was gzip
  std::string format;    ///< csv, npy, mat, tmf8820 or tmf8829
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

/// The frame of a file that has been read; its contents are released. Throws InputError that names the file
/// (and line) and what is wrong with it.
Recording open_recording(const RecordingOptions& options, RecordingFile file);

}  // namespace dtof
