// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/container/zip_directory.hpp"
#include "dtof/io/array_reader.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/byte_source.hpp"
#include "dtof/io/npy.hpp"

struct archive;

namespace dtof {

/// True if `contents` begin as a ZIP archive does.
bool is_zip(std::string_view contents);

/// A NumPy archive (np.savez, np.savez_compressed) of any length, which is read where it lies. Its arrays are
/// stored or deflated; ZIP64 is read. Throws InputError "<path>: <reason>" for a damaged archive, and
/// "<path>:<array>: <reason>" for what is wrong with an array.
class NpzArchive {
 public:
  /// Opens a file. The archive is read while its arrays are read.
  explicit NpzArchive(std::filesystem::path path);
  /// An archive in memory; `contents` must outlive the archive and its arrays. `path` is for messages.
  NpzArchive(std::filesystem::path path, std::string_view contents);

  /// Names of the arrays without ".npy", in the order in which they lie there.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool has(std::string_view name) const;
  /// Opens the array `name`. With an empty `name` the archive must have exactly one array. Throws InputError
  /// if the array is missing or ambiguous.
  [[nodiscard]] std::unique_ptr<ArrayReader> open(const std::string& name) const;
  /// Reads the array as read_npy does.
  [[nodiscard]] NpyArray read(const std::string& name) const;

 private:
  NpzArchive(std::filesystem::path path, std::shared_ptr<const ByteSource> bytes);
  /// Number of the member.
  [[nodiscard]] std::size_t find(const std::string& name) const;

  std::filesystem::path path_;
  std::shared_ptr<const ByteSource> bytes_;
  std::vector<ZipMember> members_;
  std::vector<std::string> names_;
};

/// Names of the arrays of an archive in memory.
std::vector<std::string> npz_names(const std::filesystem::path& path, std::string_view contents);

/// Reads an array of an archive in memory, as NpzArchive::read does.
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
  /// Adds an array of any length, piece by piece.
  void add(const std::string& name, ArrayReader& array);
  void commit();

 private:
  void add_bytes(const std::string& name, std::string_view dtype, std::span<const std::size_t> shape,
                 std::size_t count, std::string_view bytes);
  void begin_member(const std::string& name, const std::string& header, std::uint64_t bytes);
  void write_member(std::string_view bytes);
  void check(long long code);

  std::filesystem::path path_;
  AtomicFile file_;
  std::exception_ptr failure_;  ///< kept, since exceptions must not cross libarchive
  bool abandoned_ = false;      ///< after an error: nothing more is written
  std::unique_ptr<archive, int (*)(archive*)> archive_;
};

}  // namespace dtof
