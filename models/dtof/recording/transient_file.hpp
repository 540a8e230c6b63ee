// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "dtof/io/array_reader.hpp"

namespace dtof {

/// Members of an archive with the time axis of its transient cube, in s.
inline constexpr std::string_view kTransientBinWidthName = "bin_width_s";
inline constexpr std::string_view kTransientStartName = "start_s";

/// A transient cube as a file holds it.
struct TransientFile {
  std::unique_ptr<ArrayReader> array;
  std::optional<double> bin_width_s;  ///< none: the file does not say
  std::optional<double> start_s;      ///< left edge of the first bin; none: the file does not say
};

/// Reads a transient cube: an NPY file, or an array of an NPZ archive, an HDF5 file or a MATLAB file of
/// version 7.3. `name` may name the array (container/array_address.hpp). Without a name the cube is the only
/// array beside `bin_width_s`, `bin_width_ps` and `start_s`, which give the time axis. A cube in a regular
/// file may have any length; one from a pipe or in gzip is held. Throws InputError "<path>: <reason>".
TransientFile read_transient_file(const std::string& name);

}  // namespace dtof
