// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "elements are copied as they stand in the file");

// Four histogram cubes of 200 x 160 pixels and 1024 bins; as doubles 1 GiB.
constexpr std::size_t kMostElements = std::size_t{1} << 27U;
constexpr std::string_view kMagic = "\x93NUMPY";

template <typename T>
double element(const char* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

struct Dtype {
  const char* name;
  std::size_t size;
  double (*read)(const char*);
};
constexpr std::array<Dtype, 7> kDtypes = {{{"u1", 1, element<std::uint8_t>},
                                           {"u2", 2, element<std::uint16_t>},
                                           {"u4", 4, element<std::uint32_t>},
                                           {"i4", 4, element<std::int32_t>},
                                           {"i8", 8, element<std::int64_t>},
                                           {"f4", 4, element<float>},
                                           {"f8", 8, element<double>}}};

[[noreturn]] void fail_header(const std::filesystem::path& path, std::string_view key) {
  fail_in_file(path, fmt::format("the NPY header has no readable '{}'", key));
}

/// Text behind "'key':" in the header, a Python dict that numpy writes with its three keys.
std::string_view behind_key(const std::filesystem::path& path, std::string_view header,
                            std::string_view key) {
  const std::string quoted = fmt::format("'{}'", key);
  if (const std::size_t found = header.find(quoted); found != std::string_view::npos) {
    header.remove_prefix(found + quoted.size());
    const std::size_t colon = header.find_first_not_of(' ');
    if (colon != std::string_view::npos && header[colon] == ':') {
      header.remove_prefix(colon + 1);
      header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
      return header;
    }
  }
  fail_header(path, key);
}

/// What stands between `open`, with which `text` must begin, and the next `close`.
std::string_view enclosed(const std::filesystem::path& path, std::string_view text, char open, char close,
                          std::string_view key) {
  const std::size_t end = text.find(close, 1);
  if (!text.starts_with(open) || end == std::string_view::npos) {
    fail_header(path, key);
  }
  return text.substr(1, end - 1);
}

bool parse_fortran_order(const std::filesystem::path& path, std::string_view header) {
  constexpr std::string_view kKey = "fortran_order";
  const std::string_view text = behind_key(path, header, kKey);
  if (!text.starts_with("True") && !text.starts_with("False")) {
    fail_header(path, kKey);
  }
  return text.starts_with("True");
}

std::vector<std::size_t> parse_shape(const std::filesystem::path& path, std::string_view header) {
  constexpr std::string_view kKey = "shape";
  const std::string_view text = enclosed(path, behind_key(path, header, kKey), '(', ')', kKey);
  if (text.find_first_not_of("0123456789, ") != std::string_view::npos) {
    fail_header(path, kKey);
  }
  std::vector<std::size_t> shape;
  for (std::size_t begin = text.find_first_not_of(", "); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(", ", begin), text.size());
    std::size_t value = 0;
    if (std::from_chars(text.data() + begin, text.data() + end, value).ec != std::errc()) {
      fail_in_file(path, fmt::format("the NPY shape ({}) is too large", text));
    }
    shape.push_back(value);
    begin = text.find_first_not_of(", ", end);
  }
  return shape;
}

const Dtype& find_dtype(const std::filesystem::path& path, std::string_view header) {
  constexpr std::string_view kKey = "descr";
  const std::string_view descr = enclosed(path, behind_key(path, header, kKey), '\'', '\'', kKey);
  if (descr.empty()) {
    fail_header(path, kKey);
  }
  for (const Dtype& dtype : kDtypes) {
    if (descr.substr(1) == dtype.name && (descr[0] == '<' || (descr[0] == '|' && dtype.size == 1))) {
      return dtype;
    }
  }
  fail_in_file(path, fmt::format("dtype '{}' is not one of little-endian u1, u2, u4, i4, i8, f4, f8", descr));
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) {
  const std::string file = read_file(path);
  if (!std::string_view(file).starts_with(kMagic)) {
    fail_in_file(path, "not an NPY file");
  }
  if (file.size() < 10) {
    fail_in_file(path, "the NPY header ends early");
  }
  const int version = static_cast<unsigned char>(file[6]);
  if (version != 1 && version != 2) {
    fail_in_file(path, fmt::format("NPY format {}.{} is not 1.0 or 2.0", version, static_cast<int>(file[7])));
  }
  const std::size_t length_size = version == 1 ? 2 : 4;
  const std::size_t header_begin = 8 + length_size;
  if (file.size() < header_begin) {
    fail_in_file(path, "the NPY header ends early");
  }
  const auto header_length = static_cast<std::size_t>(version == 1 ? element<std::uint16_t>(&file[8])
                                                                   : element<std::uint32_t>(&file[8]));
  if (file.size() - header_begin < header_length) {
    fail_in_file(path, "the NPY header ends early");
  }
  const std::string_view header = std::string_view(file).substr(header_begin, header_length);
  const Dtype& dtype = find_dtype(path, header);
  const bool fortran = parse_fortran_order(path, header);
  NpyArray array;
  array.shape = parse_shape(path, header);

  const std::size_t available = (file.size() - header_begin - header_length) / dtype.size;
  std::size_t count = 1;
  for (const std::size_t extent : array.shape) {
    if (extent != 0 && count > available / extent) {
      fail_in_file(path, fmt::format("shape ({}) of {} needs more than the file's {} elements: truncated",
                                     fmt::join(array.shape, ", "), dtype.name, available));
    }
    count *= extent;
  }
  const std::size_t data_begin = header_begin + header_length;
  if (file.size() - data_begin != count * dtype.size) {
    fail_in_file(path,
                 fmt::format("shape ({}) of {} needs {} bytes, the file has {}", fmt::join(array.shape, ", "),
                             dtype.name, count * dtype.size, file.size() - data_begin));
  }
  if (count > kMostElements) {
    fail_in_file(path, fmt::format("shape ({}) holds more than 2^27 elements", fmt::join(array.shape, ", ")));
  }
  if (count == 0) {
    fail_in_file(path, fmt::format("shape ({}) holds nothing", fmt::join(array.shape, ", ")));
  }

  array.values.resize(count);
  std::vector<std::size_t> index(array.shape.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t source = i;
    if (fortran) {
      source = 0;
      for (std::size_t axis = index.size(); axis-- > 0;) {
        source = source * array.shape[axis] + index[axis];
      }
      for (std::size_t axis = index.size(); axis-- > 0;) {
        if (++index[axis] < array.shape[axis]) {
          break;
        }
        index[axis] = 0;
      }
    }
    array.values[i] = dtype.read(&file[data_begin + source * dtype.size]);
  }
  return array;
}

void write_npy(const std::filesystem::path& path, std::span<const std::size_t> shape,
               std::span<const double> values) {
  if (std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>()) != values.size()) {
    throw std::logic_error("write_npy: shape and number of values disagree");
  }
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}{}), }}",
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  // Data starts at a multiple of 64 bytes; the header ends in a newline.
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPreamble = 10;
  const std::size_t total = (kPreamble + header.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  header.resize(total - kPreamble - 1, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  AtomicFile file(path);
  file.append(kMagic);
  file.append(std::string_view("\x01\x00", 2));
  file.append({reinterpret_cast<const char*>(&length), sizeof length});
  file.append(header);
  file.append({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  file.commit();
}

}  // namespace dtof
