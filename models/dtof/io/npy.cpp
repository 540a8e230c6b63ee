// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "elements are written as they stand in memory");

// Four histogram cubes of 200 x 160 pixels and 1024 bins; as doubles 1 GiB.
constexpr std::size_t kMostElements = std::size_t{1} << 27U;
constexpr std::string_view kMagic = "\x93NUMPY";

template <typename T>
T element(const char* bytes, bool big_endian) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes, raw.size());
  if (big_endian) {
    std::ranges::reverse(raw);
  }
  return std::bit_cast<T>(raw);
}

template <typename T>
double number(const char* bytes, bool big_endian) {
  return static_cast<double>(element<T>(bytes, big_endian));
}

/// IEEE 754's half precision: a sign, five bits of exponent, ten of fraction.
double half(const char* bytes, bool big_endian) {
  const auto bits = element<std::uint16_t>(bytes, big_endian);
  const int exponent = bits >> 10U & 0x1F;
  const int fraction = bits & 0x3FF;
  constexpr int kSpecial = 31;
  double magnitude = 0.0;
  if (exponent == kSpecial) {
    magnitude =
        fraction == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  } else {
    magnitude = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  }
  return (bits & 0x8000U) != 0 ? -magnitude : magnitude;
}

struct Dtype {
  const char* name;
  std::size_t size;
  double (*read)(const char*, bool);
};
constexpr std::array<Dtype, 11> kDtypes = {{{"i1", 1, number<std::int8_t>},
                                            {"i2", 2, number<std::int16_t>},
                                            {"i4", 4, number<std::int32_t>},
                                            {"i8", 8, number<std::int64_t>},
                                            {"u1", 1, number<std::uint8_t>},
                                            {"u2", 2, number<std::uint16_t>},
                                            {"u4", 4, number<std::uint32_t>},
                                            {"u8", 8, number<std::uint64_t>},
                                            {"f2", 2, half},
                                            {"f4", 4, number<float>},
                                            {"f8", 8, number<double>}}};

/// The dtype and byte order of a file.
struct Elements {
  const Dtype* dtype;
  bool big_endian;
};

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
  std::vector<std::size_t> shape;
  for (std::size_t begin = text.find_first_not_of(", "); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(", ", begin), text.size());
    std::size_t value = 0;
    const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    if (error == std::errc::result_out_of_range) {
      fail_in_file(path, fmt::format("the NPY shape ({}) is too large", text));
    }
    // NumPy on Python 2 wrote (2L, 3L).
    const std::string_view suffix = text.substr(static_cast<std::size_t>(rest - text.data()),
                                                end - static_cast<std::size_t>(rest - text.data()));
    if (error != std::errc() || (!suffix.empty() && suffix != "L")) {
      fail_header(path, kKey);
    }
    shape.push_back(value);
    begin = text.find_first_not_of(", ", end);
  }
  return shape;
}

Elements find_elements(const std::filesystem::path& path, std::string_view header) {
  constexpr std::string_view kKey = "descr";
  const std::string_view descr = enclosed(path, behind_key(path, header, kKey), '\'', '\'', kKey);
  if (descr.empty()) {
    fail_header(path, kKey);
  }
  for (const Dtype& dtype : kDtypes) {
    if (descr.substr(1) == dtype.name &&
        (descr[0] == '<' || descr[0] == '>' || (descr[0] == '|' && dtype.size == 1))) {
      return {&dtype, descr[0] == '>'};
    }
  }
  fail_in_file(path,
               fmt::format("dtype '{}' is not one of i1, i2, i4, i8, u1, u2, u4, u8, f2, f4, f8, little- or "
                           "big-endian",
                           descr));
}

/// An integer beyond 2^53 has no place in a double of its own.
void check_integer(const std::filesystem::path& path, const Dtype& dtype, double value,
                   std::span<const std::size_t> shape, std::size_t index) {
  constexpr double kLargest = 0x1.0p53;
  if (dtype.name[0] == 'f' || std::abs(value) <= kLargest) {
    return;
  }
  std::vector<std::size_t> place(shape.size());
  for (std::size_t axis = shape.size(); axis-- > 0;) {
    place[axis] = index % shape[axis];
    index /= shape[axis];
  }
  fail_in_file(path,
               fmt::format("element [{}]: the integer {:.0f} is beyond 2^53", fmt::join(place, ", "), value));
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) { return parse_npy(path, read_file(path)); }

NpyArray parse_npy(const std::filesystem::path& path, std::string_view file) {
  if (!file.starts_with(kMagic)) {
    fail_in_file(path, "not an NPY file");
  }
  if (file.size() < 10) {
    fail_in_file(path, "the NPY header ends early");
  }
  const int version = static_cast<unsigned char>(file[6]);
  constexpr int kNewestVersion = 3;  // as 2, with names of fields in UTF-8
  if (version < 1 || version > kNewestVersion) {
    fail_in_file(path,
                 fmt::format("NPY format {}.{} is not 1.0, 2.0 or 3.0", version, static_cast<int>(file[7])));
  }
  const std::size_t length_size = version == 1 ? 2 : 4;
  const std::size_t header_begin = 8 + length_size;
  if (file.size() < header_begin) {
    fail_in_file(path, "the NPY header ends early");
  }
  const std::size_t header_length =
      version == 1 ? element<std::uint16_t>(&file[8], false) : element<std::uint32_t>(&file[8], false);
  if (file.size() - header_begin < header_length) {
    fail_in_file(path, "the NPY header ends early");
  }
  const std::string_view header = file.substr(header_begin, header_length);
  const auto [dtype, big_endian] = find_elements(path, header);
  const bool fortran = parse_fortran_order(path, header);
  NpyArray array;
  array.shape = parse_shape(path, header);
  if (std::ranges::find(array.shape, std::size_t{0}) != array.shape.end()) {
    fail_in_file(path,
                 fmt::format("the array is empty: shape ({}) has no element", fmt::join(array.shape, ", ")));
  }

  const std::size_t available = (file.size() - header_begin - header_length) / dtype->size;
  std::size_t count = 1;
  for (const std::size_t extent : array.shape) {
    if (count > available / extent) {
      fail_in_file(path, fmt::format("shape ({}) of {} needs more than the file's {} elements: truncated",
                                     fmt::join(array.shape, ", "), dtype->name, available));
    }
    count *= extent;
  }
  const std::size_t data_begin = header_begin + header_length;
  if (file.size() - data_begin != count * dtype->size) {
    fail_in_file(path,
                 fmt::format("shape ({}) of {} needs {} bytes, the file has {}", fmt::join(array.shape, ", "),
                             dtype->name, count * dtype->size, file.size() - data_begin));
  }
  if (count > kMostElements) {
    fail_in_file(path, fmt::format("shape ({}) holds more than 2^27 elements", fmt::join(array.shape, ", ")));
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
    array.values[i] = dtype->read(&file[data_begin + source * dtype->size], big_endian);
    check_integer(path, *dtype, array.values[i], array.shape, i);
  }
  return array;
}

std::vector<double> c_order_of_reversed(std::span<const double> elements,
                                        std::span<const std::size_t> shape) {
  std::vector<double> reordered(elements.size());
  std::vector<std::size_t> index(shape.size(), 0);
  for (double& value : reordered) {
    std::size_t source = 0;
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      source = source * shape[axis] + index[axis];
    }
    value = elements[source];
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      if (++index[axis] < shape[axis]) {
        break;
      }
      index[axis] = 0;
    }
  }
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
