// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/hdf5_handle.hpp"

#include <cstring>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

/// Text of a scalar that `read` reads as the type is.
template <typename Read>
std::optional<std::string> text_of(hid_t type, hid_t space, std::size_t longest, const Read& read) {
  if (type < 0 || H5Tget_class(type) != H5T_STRING || space < 0 || H5Sget_simple_extent_npoints(space) != 1) {
    return std::nullopt;
  }
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    if (read(type, &text) < 0 || text == nullptr) {
      return std::nullopt;
    }
    std::string found(text, ::strnlen(text, longest));
    H5free_memory(text);
    return found;
  }
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || size > longest) {
    return std::nullopt;
  }
  std::string found(size, '\0');
  if (read(type, found.data()) < 0) {
    return std::nullopt;
  }
  return found.substr(0, found.find('\0'));
}

}  // namespace

Hdf5Handle open_hdf5_file(const std::filesystem::path& path) {
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) {
    fail_in_file(path, "the HDF5 file is damaged or ends early");
  }
  return file;
}

std::optional<std::string> hdf5_attribute_text(hid_t object, const char* name, std::size_t longest) {
  if (H5Aexists(object, name) <= 0) {
    return std::nullopt;
  }
  const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  return text_of(type.id(), space.id(), longest,
                 [&](hid_t kind, void* into) { return H5Aread(attribute.id(), kind, into); });
}

std::optional<std::string> hdf5_text(hid_t dataset, std::size_t longest) {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  return text_of(type.id(), space.id(), longest, [&](hid_t kind, void* into) {
    return H5Dread(dataset, kind, H5S_ALL, H5S_ALL, H5P_DEFAULT, into);
  });
}

std::optional<std::vector<std::size_t>> hdf5_extents(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  if (!space.good() || H5Sget_simple_extent_type(space.id()) == H5S_NULL) {
    return std::nullopt;
  }
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 0) {
    return std::nullopt;
  }
  std::vector<hsize_t> extents(static_cast<std::size_t>(rank));
  if (rank > 0 && H5Sget_simple_extent_dims(space.id(), extents.data(), nullptr) < 0) {
    return std::nullopt;
  }
  return std::vector<std::size_t>(extents.begin(), extents.end());
}

}  // namespace dtof
