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
  std::string format = "auto";  ///< auto (by file name, JSON by content), csv, npy, mat, tmf8820, tmf8829
  std::optional<double> bin_width_s;  ///< NPY: width of a histogram bin
  double tick_s = 8e-12;              ///< MAT: duration of a tick
  std::string variable = "photon_times";
  std::optional<std::uint32_t> acquisitions;
  std::optional<int> columns;  ///< CSV: of the sensor; none: the last that detected something
  std::optional<int> rows;     ///< CSV: likewise
  Resampling resampling;       ///< for measured histograms and photon times
};

/// A recorded frame; distances as the file knows them.
struct Recording {
  std::string description;
  std::unique_ptr<StreamSource> source;
  /// True distance in m, index = row * columns + column, NaN = unknown; empty: the file knows none.
  std::vector<double> true_distance;
};

/// Kind of the file: `options.format`, for auto what name and content say. Throws InputError.
std::string recording_format(const RecordingOptions& options);

/// Throws InputError that names the file (and line) and what is wrong with it.
Recording open_recording(const RecordingOptions& options);

}  // namespace dtof
