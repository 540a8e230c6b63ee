// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/hdf5_array.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>

#include "dtof/container/hdf5_handle.hpp"
#include "dtof/container/hdf5_names.hpp"
#include "dtof/container/hdf5_numbers.hpp"
#include "dtof/container/hdf5_reader.hpp"
#include "dtof/container/read_apart.hpp"
#include "dtof/io/array_reader.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

/// The numbers of a cell; `place` for refusals.
std::vector<double> numbers_of_cell(const std::filesystem::path& path, hid_t cell, const std::string& place) {
  const Hdf5Numbers numbers(path, cell, place);
  if (numbers.count() > kMostHeldElements) {
    fail_in_file(path, fmt::format("{}: shape ({}) holds more than 2^27 elements", place,
                                   fmt::join(numbers.shape(), ", ")));
  }
  std::vector<double> values(numbers.count());
  numbers.read(0, values);
  return values;
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
  const Hdf5Handle dataset = open_hdf5_dataset(path, file.id(), name);
  const auto extents = hdf5_extents(dataset.id());
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (matlab_class(dataset.id()) != "cell" || H5Tget_class(type.id()) != H5T_REFERENCE || !extents ||
      extents->size() != 2 || H5Tequal(type.id(), H5T_STD_REF_OBJ) <= 0) {
    fail_in_file(path, fmt::format("\"{}\" is not a two-dimensional cell array", name));
  }
  constexpr std::size_t kLargestExtent = 65535;
  if (std::any_of(extents->begin(), extents->end(),
                  [](std::size_t extent) { return extent == 0 || extent > kLargestExtent; }) ||
      (*extents)[0] * (*extents)[1] > kMostHeldElements) {
    fail_in_file(path, fmt::format("\"{}\" is not a two-dimensional array of at most 65535 x 65535", name));
  }
  std::vector<hobj_ref_t> references((*extents)[0] * (*extents)[1]);
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
      if (H5Aexists(cell.id(), "MATLAB_empty") <= 0 && length &&
          std::ranges::find(*length, std::size_t{0}) == length->end()) {
        result.cells[row * columns + column] = numbers_of_cell(path, cell.id(), place);
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
  return read_apart(path, [&] { return ReadAnswer{.names = hdf5_names_in(path)}; }).names;
}

NpyArray read_hdf5_array(const std::filesystem::path& path, const std::string& name) {
  const std::unique_ptr<ArrayReader> array = open_hdf5_array(path, name);
  return read_whole(name.empty() ? path.string() : fmt::format("{}: {}", path.string(), name), *array);
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
