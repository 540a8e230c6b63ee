// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "dtof/io/npy.hpp"

namespace dtof {

// libhdf5 trusts what a file says, and a damaged one can bring it down: it works in a process of its own
// (read_apart.hpp), which is then missed by nobody.

/// Whether a file is HDF5: MATLAB's files of version 7.3 are. A pipe is none, since HDF5 is read here and
/// there in the file.
bool is_hdf5(const std::filesystem::path& path);

/// Names of the datasets of numbers, "/group/name", in the alphabetical order of each group; at most 1000.
/// Throws InputError "<path>: <reason>" for a damaged file.
std::vector<std::string> hdf5_names(const std::filesystem::path& path);

/// A dataset of numbers in C order; without a name the only one. MATLAB's axes are in MATLAB's order: a
/// variable (rows, columns, bins) has this shape. Throws InputError where there is no such dataset, where
/// several are and none is named, and for a dataset that holds no numbers, is empty, damaged, has more than
/// 2^27 elements or an integer beyond 2^53.
NpyArray read_hdf5_array(const std::filesystem::path& path, const std::string& name);

/// A cell array of MATLAB's version 7.3: a vector of numbers in each cell.
struct Hdf5Cells {
  std::vector<std::size_t> shape;          ///< rows, columns
  std::vector<std::vector<double>> cells;  ///< [row][column]
};

/// Whether the dataset is such a cell array; false where there is none of the name.
bool is_hdf5_cell_array(const std::filesystem::path& path, const std::string& name);

/// Throws InputError as above.
Hdf5Cells read_hdf5_cells(const std::filesystem::path& path, const std::string& name);

}  // namespace dtof
