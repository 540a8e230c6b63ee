// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "dtof/io/npy.hpp"

namespace dtof {

// libhdf5 trusts what a file says, and a damaged file can crash it. All functions here therefore run it in a
// process of its own (read_apart.hpp).

/// True for an HDF5 file, which includes MATLAB's version 7.3. False for a pipe, since HDF5 needs random
/// access.
bool is_hdf5(const std::filesystem::path& path);

/// Names of the numeric datasets, as "/group/name", alphabetical within each group; at most 1000. Throws
/// InputError "<path>: <reason>" for a damaged file.
std::vector<std::string> hdf5_names(const std::filesystem::path& path);

/// Reads all of a dataset as open_hdf5_array (hdf5_reader.hpp) does, at most 2^27 elements.
NpyArray read_hdf5_array(const std::filesystem::path& path, const std::string& name);

/// A cell array of MATLAB's version 7.3; each cell holds a vector of numbers.
struct Hdf5Cells {
  std::vector<std::size_t> shape;          ///< rows, columns
  std::vector<std::vector<double>> cells;  ///< [row][column]
};

/// True if the dataset is such a cell array; false also if no dataset has this name.
bool is_hdf5_cell_array(const std::filesystem::path& path, const std::string& name);

/// Reads such a cell array, which is held. Throws InputError as read_hdf5_array does.
Hdf5Cells read_hdf5_cells(const std::filesystem::path& path, const std::string& name);

}  // namespace dtof
