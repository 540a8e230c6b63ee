// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/hdf5_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dtof/container/hdf5_handle.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"

namespace dtof {
namespace {

/// More elements than any disk holds, so that their bytes can be counted.
constexpr std::size_t kMostCounted = std::size_t{1} << 59U;
constexpr std::size_t kLargestPackedChunk = std::size_t{1} << 30U;
/// Unpacked chunks that the library may hold.
constexpr std::size_t kMostChunkBytes = std::size_t{1} << 29U;
/// Several threads, each with a column of its own, share these chunks.
constexpr std::size_t kMostColumnBytes = kMostChunkBytes / 8;
constexpr std::size_t kMostChunksOfPixel = 16;

std::size_t rounded_up_quotient(std::size_t value, std::size_t by) { return (value + by - 1) / by; }

/// The product, or a number above `kMostCounted` if it is larger.
std::size_t limited_product(std::size_t a, std::size_t b) {
  return b != 0 && a > kMostCounted / b ? kMostCounted + 1 : a * b;
}

}  // namespace

std::string matlab_class(hid_t dataset) {
  constexpr std::size_t kLongest = 64;
  return hdf5_attribute_text(dataset, "MATLAB_class", kLongest).value_or("");
}

bool holds_numbers(hid_t dataset) {
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  const H5T_class_t kind = type.good() ? H5Tget_class(type.id()) : H5T_NO_CLASS;
  return (kind == H5T_INTEGER || kind == H5T_FLOAT) && matlab_class(dataset) != "char";
}

Hdf5Numbers::Hdf5Numbers(const std::filesystem::path& path, hid_t dataset, const std::string& name)
    : label_(fmt::format("{}: {}", path.string(), name)), dataset_(dataset) {
  if (!holds_numbers(dataset)) {
    fail("the dataset holds no real numbers");
  }
  const auto extents = hdf5_extents(dataset);
  if (!extents) {
    fail("the dataset is damaged or has no array");
  }
  shape_ = *extents;
  matlab_ = !matlab_class(dataset).empty();
  if (matlab_) {
    std::ranges::reverse(shape_);
  }
  find_count();
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  integer_ = H5Tget_class(type.id()) == H5T_INTEGER;
  find_layout();
}

void Hdf5Numbers::fail(const std::string& reason) const { fail_in_file(label_, reason); }

void Hdf5Numbers::find_count() {
  for (const std::size_t extent : shape_) {
    count_ = limited_product(count_, extent);
  }
  if (std::ranges::find(shape_, std::size_t{0}) != shape_.end() || H5Aexists(dataset_, "MATLAB_empty") > 0) {
    fail("the array is empty");
  }
  if (count_ > kMostCounted) {
    fail(fmt::format("shape ({}) holds more than 2^59 elements", fmt::join(shape_, ", ")));
  }
}

void Hdf5Numbers::find_layout() {
  const Hdf5Handle created(H5Dget_create_plist(dataset_), H5Pclose);
  const H5D_layout_t layout = created.good() ? H5Pget_layout(created.id()) : H5D_LAYOUT_ERROR;
  if (layout == H5D_VIRTUAL || (created.good() && H5Pget_external_count(created.id()) > 0)) {
    fail("the dataset's numbers are in other files, which are not read");
  }
  any_place_ = !matlab_ && (layout == H5D_CONTIGUOUS || layout == H5D_COMPACT);
  if (layout != H5D_CHUNKED || shape_.empty()) {
    return;
  }
  std::vector<hsize_t> extents(shape_.size());
  const int rank = H5Pget_chunk(created.id(), static_cast<int>(extents.size()), extents.data());
  if (rank != static_cast<int>(extents.size()) || std::ranges::find(extents, hsize_t{0}) != extents.end()) {
    fail("the dataset is damaged or has no array");
  }
  chunk_.assign(extents.begin(), extents.end());
  if (matlab_) {
    std::ranges::reverse(chunk_);
  }
  const Hdf5Handle type(H5Dget_type(dataset_), H5Tclose);
  std::size_t bytes = H5Tget_size(type.id());
  for (const std::size_t extent : chunk_) {
    bytes = limited_product(bytes, extent);
  }
  if (bytes > kLargestPackedChunk && H5Pget_nfilters(created.id()) > 0) {
    fail("the dataset has packed chunks above 1 GiB");
  }
  find_costs(bytes);
}

void Hdf5Numbers::find_costs(std::size_t chunk_bytes) {
  // From first to last, all chunks beside each other on the axes inside the first chunked one are in use.
  std::size_t row_bytes = chunk_bytes;
  const auto outer = std::ranges::find_if(chunk_, [](std::size_t extent) { return extent > 1; });
  for (std::size_t axis = static_cast<std::size_t>(outer - chunk_.begin()) + 1; axis < shape_.size();
       ++axis) {
    row_bytes = limited_product(row_bytes, chunks_on(axis));
  }
  // The chunks that hold a column of pixels.
  const std::size_t last = shape_.size() - 1;
  std::size_t column_bytes = limited_product(chunk_bytes, chunks_on(last));
  for (std::size_t axis = 0; axis + 1 < last; ++axis) {
    column_bytes = limited_product(column_bytes, chunks_on(axis));
  }
  any_place_ = chunks_on(last) <= kMostChunksOfPixel && column_bytes <= kMostColumnBytes;
  // Zero means the library's own choice; a chunk that does not fit would be unpacked for each block of it.
  const std::size_t wanted = any_place_ ? std::max(row_bytes, 8 * column_bytes) : row_bytes;
  chunk_cache_bytes_ = std::max(chunk_bytes, std::min(wanted, kMostChunkBytes));
}

std::size_t Hdf5Numbers::chunks_on(std::size_t axis) const {
  return rounded_up_quotient(shape_[axis], chunk_[axis]);
}

Hdf5Numbers::Block Hdf5Numbers::block_at(std::size_t first, std::size_t most) const {
  Block block{.begin = std::vector<std::size_t>(shape_.size()),
              .extents = std::vector<std::size_t>(shape_.size(), 1)};
  if (shape_.empty()) {
    return block;
  }
  for (std::size_t axis = shape_.size(); axis-- > 0;) {
    block.begin[axis] = first % shape_[axis];
    first /= shape_[axis];
  }
  block.axis = shape_.size() - 1;
  while (block.axis > 0 && block.begin[block.axis] == 0 && block.step * shape_[block.axis] <= most) {
    block.extents[block.axis] = shape_[block.axis];
    block.step *= shape_[block.axis];
    --block.axis;
  }
  block.extents[block.axis] = std::min(shape_[block.axis] - block.begin[block.axis], most / block.step);
  block.count = block.step * block.extents[block.axis];
  return block;
}

std::size_t Hdf5Numbers::window(std::size_t first, std::size_t most) const {
  const Block block = block_at(first, std::min(most, count_ - first));
  if (chunk_.empty()) {
    return block.count;
  }
  const std::size_t begin = block.begin[block.axis];
  const std::size_t end = begin + block.extents[block.axis];
  const std::size_t whole_chunks = end - end % chunk_[block.axis];
  return end < shape_[block.axis] && whole_chunks > begin ? block.step * (whole_chunks - begin) : block.count;
}

void Hdf5Numbers::read(std::size_t first, std::span<double> values) const {
  for (std::size_t done = 0; done < values.size();) {
    const Block block = block_at(first + done, values.size() - done);
    read_block(block, values.subspan(done, block.count));
    done += block.count;
  }
  constexpr double kLargest = 0x1.0p53;
  if (integer_ && std::ranges::any_of(values, [](double value) { return std::abs(value) > kLargest; })) {
    fail("an integer is beyond 2^53");
  }
}

void Hdf5Numbers::read_block(const Block& block, std::span<double> values) const {
  std::vector<hsize_t> begin(block.begin.begin(), block.begin.end());
  std::vector<hsize_t> extents(block.extents.begin(), block.extents.end());
  if (matlab_) {
    std::ranges::reverse(begin);
    std::ranges::reverse(extents);
  }
  const Hdf5Handle space(H5Dget_space(dataset_), H5Sclose);
  // The library is slow where the shapes in memory and in the file differ.
  const Hdf5Handle memory(extents.empty()
                              ? H5Screate(H5S_SCALAR)
                              : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr),
                          H5Sclose);
  std::vector<double> reversed(matlab_ ? values.size() : 0);
  if ((!extents.empty() &&
       H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin.data(), nullptr, extents.data(), nullptr) < 0) ||
      H5Dread(dataset_, H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT,
              matlab_ ? reversed.data() : values.data()) < 0) {
    fail("the dataset is damaged, or packed by a filter that is not here");
  }
  if (matlab_) {
    std::ranges::copy(c_order_of_reversed(reversed, block.extents), values.begin());
  }
}

}  // namespace dtof
