// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/hdf5_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstddef>

#include "dtof/container/hdf5_numbers.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kMostNames = 1000;
constexpr int kDeepestGroup = 16;

void collect_names(hid_t group, const std::string& prefix, int depth, std::vector<std::string>& names) {
  H5G_info_t info{};
  if (depth > kDeepestGroup || H5Gget_info(group, &info) < 0) {
    return;
  }
  for (hsize_t i = 0; i < info.nlinks && names.size() < kMostNames; ++i) {
    std::array<char, 1024> text{};
    if (H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, text.data(), text.size(),
                           H5P_DEFAULT) <= 0) {
      continue;
    }
    const std::string name = prefix + "/" + text.data();
    if (name == "/#refs#" || name == "/#subsystem#") {  // MATLAB's own, which variables point into
      continue;
    }
    const Hdf5Handle object(H5Oopen(group, text.data(), H5P_DEFAULT), H5Oclose);
    if (!object.good()) {
      continue;
    }
    const H5I_type_t kind = H5Iget_type(object.id());
    if (kind == H5I_GROUP) {
      collect_names(object.id(), name, depth + 1, names);
    } else if (kind == H5I_DATASET && holds_numbers(object.id())) {
      names.push_back(name);
    }
  }
}

}  // namespace

std::vector<std::string> hdf5_names_in(const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  const Hdf5Handle file = open_hdf5_file(path);
  const Hdf5Handle root(H5Gopen2(file.id(), "/", H5P_DEFAULT), H5Gclose);
  std::vector<std::string> names;
  if (!root.good()) {
    fail_in_file(path, "the HDF5 file is damaged or ends early");
  }
  collect_names(root.id(), "", 0, names);
  return names;
}

std::string only_hdf5_name(const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  const std::vector<std::string> names = hdf5_names_in(path);
  if (names.empty()) {
    fail_in_file(path, "the file has no dataset of numbers");
  }
  if (names.size() > 1) {
    fail_in_file(path, fmt::format("the file has {} datasets ({}); name one, as {}:{}", names.size(),
                                   fmt::join(names, ", "), path.string(), names.front()));
  }
  return names.front();
}

Hdf5Handle open_hdf5_dataset(const std::filesystem::path& path, hid_t file, const std::string& name,
                             hid_t access) {
  Hdf5Handle dataset(H5Dopen2(file, name.c_str(), access), H5Dclose);
  if (!dataset.good()) {
    const std::vector<std::string> names = hdf5_names_in(path);
    fail_in_file(path, fmt::format("the file has no dataset '{}'{}{}", name, names.empty() ? "" : ", but ",
                                   fmt::join(names, ", ")));
  }
  return dataset;
}

}  // namespace dtof
