// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "dtof/io/array_reader.hpp"

namespace dtof {

/// Opens a numeric dataset of any length, which is read in a process of its own (read_apart.hpp) as long as
/// the reader lives. With an empty `name` the file must have exactly one. A MATLAB variable (rows, columns,
/// bins) keeps this shape. An array of chunks that a pixel, or a column of pixels, has too many of cannot be
/// read at any place; nor can MATLAB's order without chunks. Throws InputError "<path>: <reason>" if the
/// dataset is missing or ambiguous, and "<path>: <name>: <reason>" if it is not numeric, empty or damaged, or
/// holds an integer beyond 2^53.
std::unique_ptr<ArrayReader> open_hdf5_array(const std::filesystem::path& path, const std::string& name);

}  // namespace dtof
