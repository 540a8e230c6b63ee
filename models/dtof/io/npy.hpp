// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dtof {

/// Most elements of an array that is held: four histogram cubes of 200 x 160 pixels and 1024 bins; as doubles
/// 1 GiB.
inline constexpr std::size_t kMostHeldElements = std::size_t{1} << 27U;

/// An array in C order, converted to double.
struct NpyArray {
  std::vector<std::size_t> shape;  ///< empty: a single number
  std::vector<double> values;
};

/// Reads NPY format 1.0, 2.0 and 3.0 (numpy.lib.format): integers (i1, i2, i4, i8, u1, u2, u4, u8) and
/// floating-point numbers (f2, f4, f8), either byte order, C or Fortran order, at most 2^27 elements. A shape
/// may be as old NumPy wrote it on Python 2, (2L, 3L). Throws
/// InputError "<path>: <reason>" for anything else, an empty array, a truncated file or bytes left over. Also
/// refused are integers beyond +-2^53, which a double cannot hold.
NpyArray read_npy(const std::filesystem::path& path);

/// Parses contents that were read from `path`, as read_npy does.
NpyArray parse_npy(const std::filesystem::path& path, std::string_view file);

/// Reorders elements into C order. In `elements` the first axis of `shape` varies fastest, as in MATLAB and
/// Fortran.
std::vector<double> c_order_of_reversed(std::span<const double> elements, std::span<const std::size_t> shape);

/// Header of an NPY file of format 1.0 in C order. `dtype` is NumPy's name, e.g. "<f4".
std::string npy_header(std::string_view dtype, std::span<const std::size_t> shape);

/// Writes f8 in C order, format 1.0. Throws std::logic_error unless values.size() is the product of `shape`.
void write_npy(const std::filesystem::path& path, std::span<const std::size_t> shape,
               std::span<const double> values);

}  // namespace dtof
