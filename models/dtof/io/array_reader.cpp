// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/array_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "dtof/core/progress.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {

ArrayReader::ArrayReader(std::vector<std::size_t> shape)
    : shape_(std::move(shape)),
      count_(std::accumulate(shape_.begin(), shape_.end(), std::size_t{1}, std::multiplies<>())) {}

HeldArray::HeldArray(NpyArray array)
    : ArrayReader(std::move(array.shape)), values_(std::move(array.values)) {}

void HeldArray::next(std::span<double> values) {
  read_at(next_, values);
  next_ += values.size();
}

void HeldArray::read_at(std::size_t first, std::span<double> values) const {
  std::ranges::copy(std::span(values_).subspan(first, values.size()), values.begin());
}

NpyArray read_whole(const std::filesystem::path& path, ArrayReader& array) {
  if (array.count() > kMostHeldElements) {
    fail_in_file(path,
                 fmt::format("shape ({}) holds more than 2^27 elements", fmt::join(array.shape(), ", ")));
  }
  NpyArray whole{.shape = array.shape(), .values = std::vector<double>(array.count())};
  array.next(whole.values);
  return whole;
}

void for_each_piece(ArrayReader& array, const std::function<void(std::span<const double>)>& take) {
  constexpr std::size_t kPiece = std::size_t{1} << 16U;
  std::vector<double> values;
  for (std::size_t left = array.count(); left > 0; left -= values.size()) {
    check_interruption();
    values.resize(std::min(kPiece, left));
    array.next(values);
    take(values);
  }
}

void write_npy(const std::filesystem::path& path, ArrayReader& array) {
  AtomicFile file(path);
  file.append(npy_header("<f8", array.shape()));
  for_each_piece(array, [&](std::span<const double> values) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the bytes of numbers
    file.append({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  });
  file.commit();
}

}  // namespace dtof
