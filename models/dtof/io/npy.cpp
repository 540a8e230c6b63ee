// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>

#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy_header.hpp"

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "elements are written as they stand in memory");

constexpr std::string_view kMagic = "\x93NUMPY";

/// Calls `visit` with the number of each element in C order and its number where the first axis varies
/// fastest.
template <typename Visit>
void for_each_reversed(std::span<const std::size_t> shape, const Visit& visit) {
  const std::size_t count = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  std::vector<std::size_t> place(shape.size(), 0);
  for (std::size_t index = 0; index < count; ++index) {
    std::size_t source = 0;
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      source = source * shape[axis] + place[axis];
    }
    visit(index, source);
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      if (++place[axis] < shape[axis]) {
        break;
      }
      place[axis] = 0;
    }
  }
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) { return parse_npy(path, read_file(path)); }

NpyArray parse_npy(const std::filesystem::path& path, std::string_view file) {
  const NpyHeader header(path, file, file.size());
  NpyArray array{.shape = header.shape(), .values = {}};
  if (header.count() > kMostHeldElements) {
    fail_in_file(path, fmt::format("shape ({}) holds more than 2^27 elements", fmt::join(array.shape, ", ")));
  }
  array.values.resize(header.count());
  const std::string_view elements = file.substr(static_cast<std::size_t>(header.data_begin()));
  if (header.in_c_order()) {
    header.decode(path, elements, 0, array.values);
    return array;
  }
  for_each_reversed(array.shape, [&](std::size_t index, std::size_t source) {
    header.decode(path, elements.substr(source * header.element_bytes()), index,
                  std::span(array.values).subspan(index, 1));
  });
  return array;
}

std::vector<double> c_order_of_reversed(std::span<const double> elements,
                                        std::span<const std::size_t> shape) {
  std::vector<double> reordered(elements.size());
  for_each_reversed(shape,
                    [&](std::size_t index, std::size_t source) { reordered[index] = elements[source]; });
  return reordered;
}

std::string npy_header(std::string_view dtype, std::span<const std::size_t> shape) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}", dtype,
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  // Data starts at a multiple of 64 bytes; the header ends in a newline.
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreamble = 10;
  const std::size_t total = (kPreamble + header.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  header.resize(total - kPreamble - 1, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string file(kMagic);
  file.append("\x01\x00", 2);
  file.append(reinterpret_cast<const char*>(&length), sizeof length);
  return file + header;
}

void write_npy(const std::filesystem::path& path, std::span<const std::size_t> shape,
               std::span<const double> values) {
  if (std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>()) != values.size()) {
    throw std::logic_error("write_npy: shape and number of values disagree");
  }
  AtomicFile file(path);
  file.append(npy_header("<f8", shape));
  file.append({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  file.commit();
}

}  // namespace dtof
