// SPDX-License-Identifier: Apache-2.0
// A dataset of numbers, read block by block. For a process of its own only (read_apart.hpp).
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace dtof {

/// MATLAB's name of the variable's class; empty for a dataset of others.
std::string matlab_class(hid_t dataset);

/// True for integers and floating-point numbers, apart from MATLAB's text.
bool holds_numbers(hid_t dataset);

/// The numbers of a dataset in C order and as doubles. A variable of MATLAB has MATLAB's axes.
class Hdf5Numbers {
 public:
  /// `name` is for messages; the dataset must live as long. Throws InputError "<path>: <name>: <reason>" for
  /// a dataset without real numbers, an empty or a damaged one, and for packed chunks above 1 GiB.
  Hdf5Numbers(const std::filesystem::path& path, hid_t dataset, const std::string& name);

  [[nodiscard]] const std::vector<std::size_t>& shape() const { return shape_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  /// True if the elements of a pixel lie close together in the file, and so do those of a column of pixels:
  /// each is read at little cost. The last axis is the bins, the one before it the columns.
  [[nodiscard]] bool any_place() const { return any_place_; }
  /// Bytes of unpacked chunks to hold so that no chunk is unpacked twice, within a limit; 0 without chunks.
  [[nodiscard]] std::size_t chunk_cache_bytes() const { return chunk_cache_bytes_; }

  /// Elements from number `first` on that are read well at once: at most `most`, and whole chunks if they
  /// fit. A caller that begins at 0 and continues behind each window reads all.
  [[nodiscard]] std::size_t window(std::size_t first, std::size_t most) const;
  /// Reads elements from number `first` on. Throws InputError for damaged data, and an integer beyond 2^53.
  void read(std::size_t first, std::span<double> values) const;

 private:
  /// Elements of a range that form a box: one index of the outer axes, some of axis `axis`, all of the inner.
  struct Block {
    std::vector<std::size_t> begin;
    std::vector<std::size_t> extents;
    std::size_t axis = 0;
    std::size_t step = 1;  ///< elements of one index of `axis`
    std::size_t count = 1;
  };
  [[noreturn]] void fail(const std::string& reason) const;
  void find_count();
  void find_layout();
  void find_costs(std::size_t chunk_bytes);
  [[nodiscard]] std::size_t chunks_on(std::size_t axis) const;
  [[nodiscard]] Block block_at(std::size_t first, std::size_t most) const;
  void read_block(const Block& block, std::span<double> values) const;

  std::string label_;
  hid_t dataset_;
  std::vector<std::size_t> shape_;
  std::size_t count_ = 1;
  bool integer_ = false;
  bool matlab_ = false;             ///< the file has the axes in reverse
  std::vector<std::size_t> chunk_;  ///< extents of a chunk, axes as in `shape_`; empty: no chunks
  bool any_place_ = false;
  std::size_t chunk_cache_bytes_ = 0;
};

}  // namespace dtof
