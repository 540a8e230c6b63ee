// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "dtof/container/npz.hpp"
#include "dtof/io/array_reader.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/recording.hpp"

namespace dtof {

/// "npy" or "npz" for a regular file whose first bytes say so: its arrays are read where they lie. Empty for
/// another file, for gzip and for a pipe.
std::string format_read_in_place(const std::filesystem::path& path);

/// True for a file of format hdf5, and of format npy or npz that is not held: format_read_in_place.
bool is_read_in_place(const RecordingFile& file);

/// The archive of a file of format npz. `file` must outlive it.
NpzArchive open_archive(const RecordingOptions& options, const RecordingFile& file);

/// Opens the array in a file of format npy, npz, mat or hdf5. An array that cannot be read in place is held,
/// and may have 2^27 elements. If `options.file` names no array, the array is "histograms" or "depth_m" (the
/// names that `dtof convert` writes), else the archive's only one; in a MATLAB file it is `options.variable`.
/// `file` must outlive the reader. Throws InputError.
std::unique_ptr<ArrayReader> open_array_reader(const RecordingOptions& options, const RecordingFile& file);

/// Reads the array of open_array_reader, unchanged. Throws InputError for more than 2^27 elements.
NpyArray open_array(const RecordingOptions& options, const RecordingFile& file);

/// `options.file` with the name of the variable behind a colon if it is a MATLAB file (of version 5) whose
/// name has none; for error messages.
std::string array_label(const RecordingOptions& options, const RecordingFile& file);

/// The variable of a MATLAB file: what the file's name names, else the option.
std::string variable_of(const RecordingOptions& options);

/// Width of the bins of an array: as it is given, else as an archive of `dtof convert` says. Throws
/// InputError if neither says so.
double bin_width_of(const RecordingOptions& options, const RecordingFile& file);

}  // namespace dtof
