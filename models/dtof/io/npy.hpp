// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace dtof {

/// An array of an NPY file, in C order, converted to double (integers beyond 2^53 are rounded).
struct NpyArray {
  std::vector<std::size_t> shape;  ///< empty: a single number
  std::vector<double> values;
};

/// Reads NPY format 1.0 and 2.0 (numpy.lib.format) of dtype u1, u2, u4, i4, i8, f4 or f8, little-endian, C or
/// Fortran order, at most 2^27 elements. Throws InputError "<path>: <reason>" for anything else, a truncated
/// file or bytes left over.
NpyArray read_npy(const std::filesystem::path& path);

/// Writes f8 in C order, format 1.0; the product of `shape` must be values.size() (std::logic_error).
void write_npy(const std::filesystem::path& path, std::span<const std::size_t> shape,
               std::span<const double> values);

}  // namespace dtof
