// SPDX-License-Identifier: Apache-2.0
// HDF5 files of one dataset for tests, in every layout.
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace dtof::test {

struct Hdf5Layout {
  std::vector<hsize_t> chunk = {};  ///< empty: contiguous; axes as in the array
  bool compact = false;
  bool deflate = false;
  bool shuffle = false;
  bool fletcher32 = false;
  std::string external = {};  ///< file with the numbers
  bool matlab = false;        ///< a variable of MATLAB's, whose axes the file has in reverse
};

/// The array as MATLAB lays it out: the first axis of `shape` varies fastest.
inline std::vector<double> matlab_order(const std::vector<hsize_t>& shape,
                                        const std::vector<double>& values) {
  std::vector<double> reversed(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::size_t left = i;
    std::size_t place = 0;
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      place = place * shape[axis] + left % shape[axis];
      left /= shape[axis];
    }
    reversed[place] = values[i];
  }
  return reversed;
}

/// Writes /a of a type of the file; values in C order of `shape`, which is () for a single number. Without
/// values nothing is written into the dataset.
inline void write_hdf5(const std::filesystem::path& path, std::vector<hsize_t> shape,
                       std::vector<double> values, hid_t type = H5T_IEEE_F64LE, Hdf5Layout layout = {}) {
  if (layout.matlab) {
    // matlab_order counts the places with the last axis outermost, as the file has them.
    values = values.empty() ? values : matlab_order(shape, values);
    std::reverse(shape.begin(), shape.end());
    std::reverse(layout.chunk.begin(), layout.chunk.end());
  }
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = shape.empty() ? H5Screate(H5S_SCALAR)
                                    : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t created = H5Pcreate(H5P_DATASET_CREATE);
  if (layout.compact) {
    H5Pset_layout(created, H5D_COMPACT);
  }
  if (!layout.chunk.empty()) {
    H5Pset_chunk(created, static_cast<int>(layout.chunk.size()), layout.chunk.data());
  }
  if (!layout.external.empty()) {
    H5Pset_external(created, layout.external.c_str(), 0, H5F_UNLIMITED);
  }
  if (layout.shuffle) {
    H5Pset_shuffle(created);
  }
  if (layout.deflate) {
    H5Pset_deflate(created, 1);
  }
  if (layout.fletcher32) {
    H5Pset_fletcher32(created);
  }
  const hid_t dataset = H5Dcreate2(file, "/a", type, space, H5P_DEFAULT, created, H5P_DEFAULT);
  if (!values.empty()) {
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  if (layout.matlab) {
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, 6);
    const hid_t one = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(dataset, "MATLAB_class", text, one, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, text, "double");
    H5Aclose(attribute);
    H5Sclose(one);
    H5Tclose(text);
  }
  H5Dclose(dataset);
  H5Pclose(created);
  H5Sclose(space);
  H5Fclose(file);
}

}  // namespace dtof::test
