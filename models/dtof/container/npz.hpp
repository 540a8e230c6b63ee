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

/// True if `contents` begin as a ZIP archive does.
bool is_zip(std::string_view contents);

/// Names of the arrays in a NumPy archive (np.savez, np.savez_compressed), without ".npy", in file order.
/// `path` is for error messages. Throws InputError "<path>: <reason>" for a damaged archive.
std::vector<std::string> npz_names(const std::filesystem::path& path, std::string_view contents);

/// Reads the array `name` as parse_npy does. With an empty `name` the archive must have exactly one array.
/// Throws InputError if the array is missing or ambiguous.
NpyArray parse_npz(const std::filesystem::path& path, std::string_view contents, const std::string& name);

/// Writes an archive for numpy.load; equal arrays give equal files. The file appears whole at `commit`, or
/// not at all (AtomicFile).
class NpzWriter {
 public:
  explicit NpzWriter(const std::filesystem::path& path);
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;
  NpzWriter(NpzWriter&&) = delete;
  NpzWriter& operator=(NpzWriter&&) = delete;
  ~NpzWriter();

  /// Adds an array in C order. Throws std::logic_error unless values.size() is the product of `shape`.
  void add(const std::string& name, std::span<const std::size_t> shape, std::span<const double> values);
  void add(const std::string& name, std::span<const std::size_t> shape, std::span<const float> values);
  void commit();

 private:
  void add_bytes(const std::string& name, std::string_view dtype, std::span<const std::size_t> shape,
                 std::size_t count, std::string_view bytes);
  void check(long long code);

  std::filesystem::path path_;
  AtomicFile file_;
  std::exception_ptr failure_;  ///< kept, since exceptions must not cross libarchive
  bool abandoned_ = false;      ///< after an error: nothing more is written
  std::unique_ptr<archive, int (*)(archive*)> archive_;
};

}  // namespace dtof
