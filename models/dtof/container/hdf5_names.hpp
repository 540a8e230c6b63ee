// SPDX-License-Identifier: Apache-2.0
// Names of the datasets of numbers. For a process of its own only (read_apart.hpp).
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <vector>

#include "dtof/container/hdf5_handle.hpp"

namespace dtof {

/// Names as hdf5_names returns them.
std::vector<std::string> hdf5_names_in(const std::filesystem::path& path);

/// Name of the only dataset of numbers. Throws InputError if there is none, or are several.
std::string only_hdf5_name(const std::filesystem::path& path);

/// Opens a dataset; the name may lack the slash in front. Throws InputError if there is none of this name.
Hdf5Handle open_hdf5_dataset(const std::filesystem::path& path, hid_t file, const std::string& name,
                             hid_t access = H5P_DEFAULT);

}  // namespace dtof
