// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dtof {

/// An array of an NPY file, in C order, converted to double.
struct NpyArray {
  std::vector<std::size_t> shape;  ///< empty: a single number
  std::vector<double> values;
};

/// Reads NPY format 1.0, 2.0 and 3.0 (numpy.lib.format) of integers (i1, i2, i4, i8, u1, u2, u4, u8) and
/// floating-point numbers (f2, f4, f8), little- or big-endian, C or Fortran order, at most 2^27 elements.
/// Throws InputError "<path>: <reason>" for anything else, an empty array, an integer beyond +-2^53, which a
/// double cannot hold, a truncated file or bytes left over.
NpyArray read_npy(const std::filesystem::path& path);

/// The same of contents that `path` has already given.
NpyArray parse_npy(const std::filesystem::path& path, std::string_view file);

/// Elements of an array of this shape in C order, from elements of which the first axis is the fastest one,
/// as MATLAB and Fortran have them.
std::vector<double> c_order_of_reversed(std::span<const double> elements, std::span<const std::size_t> shape);

/// What stands in front of the elements in an NPY file of format 1.0, C order; `dtype` as NumPy names it,
/// e.g.
/// "<f4".
std::string npy_header(std::string_view dtype, std::span<const std::size_t> shape);

/// Writes f8 in C order, format 1.0; the product of `shape` must be values.size() (std::logic_error).
void write_npy(const std::filesystem::path& path, std::span<const std::size_t> shape,
               std::span<const double> values);

}  // namespace dtof
