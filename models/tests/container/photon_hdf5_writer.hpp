// SPDX-License-Identifier: Apache-2.0
// Photon-HDF5 files for tests, as phconvert lays them out.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace dtof::test {

class PhotonHdf5Writer {
 public:
  /// A file that says it is `format`.
  explicit PhotonHdf5Writer(const std::filesystem::path& path, const std::string& format = "Photon-HDF5")
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {
    if (!format.empty()) {
      const hid_t space = H5Screate(H5S_SCALAR);
      const hid_t type = text_type(format);
      const hid_t attribute = H5Acreate2(file_, "format_name", type, space, H5P_DEFAULT, H5P_DEFAULT);
      H5Awrite(attribute, type, format.data());
      H5Aclose(attribute);
      H5Tclose(type);
      H5Sclose(space);
    }
  }
  PhotonHdf5Writer(const PhotonHdf5Writer&) = delete;
  PhotonHdf5Writer& operator=(const PhotonHdf5Writer&) = delete;
  PhotonHdf5Writer(PhotonHdf5Writer&&) = delete;
  PhotonHdf5Writer& operator=(PhotonHdf5Writer&&) = delete;
  ~PhotonHdf5Writer() { H5Fclose(file_); }

  /// An array of a type of the file, packed in pieces where a length of pieces is given.
  void array(const std::string& name, const std::vector<std::int64_t>& values, hid_t type = H5T_STD_I64LE,
             std::vector<hsize_t> extents = {}, hsize_t chunk = 0) const {
    if (extents.empty()) {
      extents = {values.size()};
    }
    const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    if (chunk != 0) {
      H5Pset_chunk(layout, 1, &chunk);
      H5Pset_deflate(layout, 6);
    }
    write(name, type, space, layout, H5T_NATIVE_INT64, values.empty() ? nullptr : values.data());
    H5Pclose(layout);
  }
  void number(const std::string& name, double value, hid_t type = H5T_IEEE_F64LE) const {
    write(name, type, H5Screate(H5S_SCALAR), H5P_DEFAULT, H5T_NATIVE_DOUBLE, &value);
  }
  void text(const std::string& name, const std::string& value) const {
    const hid_t type = text_type(value);
    write(name, type, H5Screate(H5S_SCALAR), H5P_DEFAULT, type, value.data());
    H5Tclose(type);
  }
  /// A spot as phconvert writes it.
  void spot(const std::string& group, const std::vector<std::int64_t>& timestamps,
            const std::vector<std::int64_t>& nanotimes, const std::vector<std::int64_t>& detectors,
            double tcspc_unit_s = 16e-12, double bins = 4096) const {
    array(group + "/timestamps", timestamps);
    array(group + "/nanotimes", nanotimes, H5T_STD_U16LE);
    if (!detectors.empty()) {
      array(group + "/detectors", detectors, H5T_STD_U8LE);
    }
    number(group + "/timestamps_specs/timestamps_unit", 50e-9);
    number(group + "/nanotimes_specs/tcspc_unit", tcspc_unit_s);
    number(group + "/nanotimes_specs/tcspc_num_bins", bins, H5T_STD_I64LE);
  }

 private:
  static hid_t text_type(const std::string& value) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, value.size());
    return type;
  }
  void write(const std::string& name, hid_t type, hid_t space, hid_t layout, hid_t memory,
             const void* values) const {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t dataset = H5Dcreate2(file_, name.c_str(), type, space, links, layout, H5P_DEFAULT);
    if (values != nullptr) {
      H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    }
    H5Dclose(dataset);
    H5Pclose(links);
    H5Sclose(space);
  }

  hid_t file_;
};

}  // namespace dtof::test
