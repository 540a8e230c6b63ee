// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/hdf5_array.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "dtof/container/hdf5_handle.hpp"
#include "dtof/container/read_apart.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 27U;  // as of an NPY array
constexpr std::size_t kMostNames = 1000;
constexpr int kDeepestGroup = 16;

/// MATLAB's name of the variable's class; empty for a dataset of others.
std::string matlab_class(hid_t dataset) {
  constexpr std::size_t kLongest = 64;
  return hdf5_attribute_text(dataset, "MATLAB_class", kLongest).value_or("");
}

bool is_numbers(hid_t dataset) {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const H5T_class_t kind = type.good() ? H5Tget_class(type.id()) : H5T_NO_CLASS;
  return (kind == H5T_INTEGER || kind == H5T_FLOAT) && matlab_class(dataset) != "char";
}

/// Product of the extents; none above `kMostElements`.
std::optional<std::size_t> element_count(const std::vector<std::size_t>& extents) {
  std::size_t count = 1;
  for (const std::size_t extent : extents) {
    if (extent != 0 && count > kMostElements / extent) {
      return std::nullopt;
    }
    count *= extent;
  }
  return count;
}

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
    } else if (kind == H5I_DATASET && is_numbers(object.id())) {
      names.push_back(name);
    }
  }
}

/// The numbers of a dataset; `name` for refusals.
NpyArray read_dataset(const std::filesystem::path& path, hid_t dataset, const std::string& name) {
  const auto fail = [&](const std::string& reason) {
    fail_in_file(path, fmt::format("{}: {}", name, reason));
  };
  if (!is_numbers(dataset)) {
    fail("the dataset holds no real numbers");
  }
  const auto extents = hdf5_extents(dataset);
  if (!extents) {
    fail("the dataset is damaged or has no array");
  }
  const auto count = element_count(*extents);
  if (!count) {
    fail(fmt::format("shape ({}) holds more than 2^27 elements", fmt::join(*extents, ", ")));
  }
  if (*count == 0 || H5Aexists(dataset, "MATLAB_empty") > 0) {
    fail("the array is empty");
  }
  NpyArray array{.shape = *extents, .values = std::vector<double>(*count)};
  if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()) < 0) {
    fail("the dataset is damaged, or packed by a filter that is not here");
  }
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  constexpr double kLargest = 0x1.0p53;
  if (H5Tget_class(type.id()) == H5T_INTEGER &&
      std::any_of(array.values.begin(), array.values.end(),
                  [](double value) { return std::abs(value) > kLargest; })) {
    fail("an integer is beyond 2^53");
  }
  if (!matlab_class(dataset).empty()) {
    std::reverse(array.shape.begin(), array.shape.end());
    array.values = c_order_of_reversed(array.values, array.shape);
  }
  return array;
}

std::vector<std::string> names_in(const std::filesystem::path& path) {
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

/// Opens the dataset; the name may lack the slash in front.
Hdf5Handle open_dataset(const std::filesystem::path& path, hid_t file, const std::string& name) {
  Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.good()) {
    const std::vector<std::string> names = names_in(path);
    fail_in_file(path, fmt::format("the file has no dataset '{}'{}{}", name, names.empty() ? "" : ", but ",
                                   fmt::join(names, ", ")));
  }
  return dataset;
}

NpyArray array_in(const std::filesystem::path& path, const std::string& name) {
  const QuietHdf5 quiet;
  std::string wanted = name;
  if (name.empty()) {
    const std::vector<std::string> names = names_in(path);
    if (names.empty()) {
      fail_in_file(path, "the file has no dataset of numbers");
    }
    if (names.size() > 1) {
      fail_in_file(path, fmt::format("the file has {} datasets ({}); name one, as {}:{}", names.size(),
                                     fmt::join(names, ", "), path.string(), names.front()));
    }
    wanted = names.front();
  }
  const Hdf5Handle file = open_hdf5_file(path);
  const Hdf5Handle dataset = open_dataset(path, file.id(), wanted);
  return read_dataset(path, dataset.id(), wanted);
}

bool is_cell_array_in(const std::filesystem::path& path, const std::string& name) {
  const QuietHdf5 quiet;
  const Hdf5Handle file = open_hdf5_file(path);
  const Hdf5Handle dataset(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  return dataset.good() && matlab_class(dataset.id()) == "cell";
}

Hdf5Cells cells_in(const std::filesystem::path& path, const std::string& name) {
  const QuietHdf5 quiet;
  const Hdf5Handle file = open_hdf5_file(path);
  const Hdf5Handle dataset = open_dataset(path, file.id(), name);
  const auto extents = hdf5_extents(dataset.id());
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (matlab_class(dataset.id()) != "cell" || H5Tget_class(type.id()) != H5T_REFERENCE || !extents ||
      extents->size() != 2 || H5Tequal(type.id(), H5T_STD_REF_OBJ) <= 0) {
    fail_in_file(path, fmt::format("\"{}\" is not a two-dimensional cell array", name));
  }
  constexpr std::size_t kLargestExtent = 65535;
  if (std::any_of(extents->begin(), extents->end(),
                  [](std::size_t extent) { return extent == 0 || extent > kLargestExtent; }) ||
      !element_count(*extents)) {
    fail_in_file(path, fmt::format("\"{}\" is not a two-dimensional array of at most 65535 x 65535", name));
  }
  std::vector<hobj_ref_t> references(*element_count(*extents));
  if (H5Dread(dataset.id(), H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, references.data()) < 0) {
    fail_in_file(path, fmt::format("\"{}\" is damaged", name));
  }
  const std::size_t columns = (*extents)[0];
  const std::size_t rows = (*extents)[1];
  Hdf5Cells result{.shape = {rows, columns}, .cells = std::vector<std::vector<double>>(rows * columns)};
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      const Hdf5Handle cell(
          H5Rdereference2(dataset.id(), H5P_DEFAULT, H5R_OBJECT, &references[column * rows + row]), H5Oclose);
      const std::string place = fmt::format("\"{}\": the cell of column {}, row {}", name, column, row);
      if (!cell.good() || H5Iget_type(cell.id()) != H5I_DATASET) {
        fail_in_file(path, place + " is damaged or holds no real numbers");
      }
      const auto length = hdf5_extents(cell.id());
      if (H5Aexists(cell.id(), "MATLAB_empty") <= 0 && length && element_count(*length) != 0) {
        result.cells[row * columns + column] = read_dataset(path, cell.id(), place).values;
      }
    }
  }
  return result;
}

}  // namespace

bool is_hdf5(const std::filesystem::path& path) {
  constexpr std::string_view kSignature("\x89HDF\r\n\x1a\n", 8);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return false;
  }
  // Others may put 512 bytes in front, or a power of two more: MATLAB does.
  std::ifstream file(path, std::ios::binary);
  std::string start(kSignature.size(), '\0');
  for (std::streamoff offset = 0; file; offset = offset == 0 ? 512 : offset * 2) {
    file.seekg(offset);
    if (file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kSignature) {
      return true;
    }
  }
  return false;
}

std::vector<std::string> hdf5_names(const std::filesystem::path& path) {
  return read_apart(path, [&] { return ReadAnswer{.names = names_in(path)}; }).names;
}

NpyArray read_hdf5_array(const std::filesystem::path& path, const std::string& name) {
  ReadAnswer answer = read_apart(path, [&] {
    NpyArray array = array_in(path, name);
    return ReadAnswer{.sizes = std::move(array.shape), .values = std::move(array.values)};
  });
  return {.shape = std::move(answer.sizes), .values = std::move(answer.values)};
}

bool is_hdf5_cell_array(const std::filesystem::path& path, const std::string& name) {
  return read_apart(path, [&] {
           return ReadAnswer{.sizes = {is_cell_array_in(path, name) ? 1U : 0U}};
         }).sizes.at(0) == 1;
}

Hdf5Cells read_hdf5_cells(const std::filesystem::path& path, const std::string& name) {
  // The shape, the length of each cell, and all cells' numbers.
  const ReadAnswer answer = read_apart(path, [&] {
    const Hdf5Cells cells = cells_in(path, name);
    ReadAnswer flat{.sizes = cells.shape};
    for (const std::vector<double>& cell : cells.cells) {
      flat.sizes.push_back(cell.size());
      flat.values.insert(flat.values.end(), cell.begin(), cell.end());
    }
    return flat;
  });
  Hdf5Cells cells{.shape = {answer.sizes.at(0), answer.sizes.at(1)}, .cells = {}};
  auto next = answer.values.begin();
  for (std::size_t i = 2; i < answer.sizes.size(); ++i) {
    const auto end = next + static_cast<std::ptrdiff_t>(answer.sizes[i]);
    cells.cells.emplace_back(next, end);
    next = end;
  }
  return cells;
}

}  // namespace dtof
