// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/io/atomic_file.hpp"
#include "dtof/io/npy.hpp"

struct archive;

namespace dtof {

/// Whether a file begins as a ZIP archive does.
bool is_zip(std::string_view contents);

/// Names of the arrays in an archive of NumPy (np.savez, np.savez_compressed), without their ".npy", in the
/// file's order. `path` names the file in refusals. Throws InputError "<path>: <reason>" for a damaged
/// archive.
std::vector<std::string> npz_names(const std::filesystem::path& path, std::string_view contents);

/// The array `name`, as parse_npy reads it; without a name the only one. Throws InputError where there is no
/// such array, and where several are and none is named.
NpyArray parse_npz(const std::filesystem::path& path, std::string_view contents, const std::string& name);

/// Writes an archive for numpy.load; equal arrays give equal files. It appears whole with `commit`, or not at
/// all (AtomicFile).
class NpzWriter {
 public:
  explicit NpzWriter(const std::filesystem::path& path);
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;
  NpzWriter(NpzWriter&&) = delete;
  NpzWriter& operator=(NpzWriter&&) = delete;
  ~NpzWriter();

  /// Their number must be the product of `shape` (std::logic_error).
  void add(const std::string& name, std::span<const std::size_t> shape, std::span<const double> values);
  void add(const std::string& name, std::span<const std::size_t> shape, std::span<const float> values);
  void commit();

 private:
  void add_bytes(const std::string& name, std::string_view dtype, std::span<const std::size_t> shape,
                 std::size_t count, std::string_view bytes);
  void check(long long code);

  std::filesystem::path path_;
  AtomicFile file_;
  std::exception_ptr failure_;  ///< of the file, which must not leave through the library's code
  bool abandoned_ = false;      ///< nothing is written any more
  std::unique_ptr<archive, int (*)(archive*)> archive_;
};

}  // namespace dtof
