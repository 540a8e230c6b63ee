// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/transient_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "dtof/container/array_address.hpp"
#include "dtof/container/hdf5_array.hpp"
#include "dtof/container/hdf5_reader.hpp"
#include "dtof/container/npz.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy_reader.hpp"
#include "dtof/recording/recorded_array.hpp"
#include "dtof/recording/recording.hpp"

namespace dtof {
namespace {

constexpr std::array kTimeAxis = {kTransientBinWidthName, kBinWidthName, kTransientStartName};

/// Name of an array without the groups that it lies in.
std::string_view last_part(std::string_view name) { return name.substr(name.rfind('/') + 1); }

/// The group of an array: "/scene/" of "/scene/cube".
std::string_view group_of(std::string_view name) { return name.substr(0, name.rfind('/') + 1); }

/// The archive's only array that is no part of a time axis.
std::string only_cube(const std::filesystem::path& path, const std::vector<std::string>& names) {
  std::vector<std::string> cubes;
  std::ranges::copy_if(names, std::back_inserter(cubes), [](const std::string& name) {
    return std::ranges::find(kTimeAxis, last_part(name)) == kTimeAxis.end();
  });
  if (cubes.empty()) {
    fail_in_file(path, "the file has no array of numbers that could be a transient cube");
  }
  if (cubes.size() > 1) {
    fail_in_file(path, fmt::format("the file has {} arrays ({}); name one, as {}:{}", cubes.size(),
                                   fmt::join(cubes, ", "), path.string(), cubes.front()));
  }
  return cubes.front();
}

/// Reads the cube `name` (empty: the only one) and the time axis beside it.
TransientFile read_members(const std::filesystem::path& path, std::string name,
                           const std::vector<std::string>& names,
                           const std::function<std::unique_ptr<ArrayReader>(const std::string&)>& open) {
  if (name.empty()) {
    name = only_cube(path, names);
  }
  TransientFile file{.array = open(name), .bin_width_s = std::nullopt, .start_s = std::nullopt};
  const auto number = [&](std::string_view member) -> std::optional<double> {
    const std::string beside = fmt::format("{}{}", group_of(name), member);
    if (std::ranges::find(names, beside) == names.end()) {
      return std::nullopt;
    }
    const std::unique_ptr<ArrayReader> array = open(beside);
    if (array->count() != 1) {
      fail_in_file(path, fmt::format("{} has {} numbers instead of one", beside, array->count()));
    }
    double value = 0.0;
    array->next({&value, 1});
    return value;
  };
  file.bin_width_s = number(kTransientBinWidthName);
  if (!file.bin_width_s) {
    if (const std::optional<double> picoseconds = number(kBinWidthName)) {
      file.bin_width_s = *picoseconds * 1e-12;
    }
  }
  file.start_s = number(kTransientStartName);
  return file;
}

}  // namespace

TransientFile read_transient_file(const std::string& name) {
  const ArrayAddress address = parse_array_address(name);
  const std::filesystem::path& path = address.file;  // clang: a lambda cannot capture a structured binding
  const std::string& array = address.array;
  if (is_hdf5(path)) {
    // A name may lack the slash in front.
    const std::string wanted = array.empty() || array.starts_with('/') ? array : "/" + array;
    return read_members(path, wanted, hdf5_names(path),
                        [&](const std::string& member) { return open_hdf5_array(path, member); });
  }
  const std::string format = format_read_in_place(path);
  if (format == "npy") {
    return {.array = open_npy(path), .bin_width_s = std::nullopt, .start_s = std::nullopt};
  }
  if (format == "npz") {
    const NpzArchive archive(path);
    return read_members(path, array, archive.names(),
                        [&](const std::string& member) { return archive.open(member); });
  }
  // A pipe, or gzip: the array is held, since the contents are not.
  const std::string contents = unpack_gzip(path, read_file(path), kLongestFile);
  if (is_zip(contents)) {
    const NpzArchive archive(path, contents);
    return read_members(path, array, archive.names(), [&](const std::string& member) {
      return std::make_unique<HeldArray>(archive.read(member));
    });
  }
  if (contents.starts_with("\x93NUMPY")) {
    return {.array = std::make_unique<HeldArray>(parse_npy(path, contents)),
            .bin_width_s = std::nullopt,
            .start_s = std::nullopt};
  }
  fail_in_file(path, "a transient cube is an NPY, NPZ or HDF5 file");
}

}  // namespace dtof
