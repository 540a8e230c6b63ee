// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "dtof/recording/recording.hpp"

namespace dtof {

/// True for a format that is no container of arrays (NPY, NPZ, MAT, HDF5, Photon-HDF5): TDC streams, logs of
/// sensors and time tags. These can be read from memory alone.
bool is_plain_recording(std::string_view format);

/// Parses a recording of a plain format. `path`: the file of `options.file`, which is opened only if
/// `file.contents` is empty: for a log or a stream of lines, and for time tags. Throws InputError that names
/// the file (and line) and the error.
RecordedData open_plain_recording(const std::filesystem::path& path, const RecordingOptions& options,
                                  const RecordingFile& file);

/// Photon times with their description.
RecordedData recorded_times(PhotonTimes photons);

}  // namespace dtof
