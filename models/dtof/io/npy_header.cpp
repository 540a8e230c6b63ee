// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/npy_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "elements are read as they stand in memory");

constexpr std::string_view kNpyMagic = "\x93NUMPY";

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

}  // namespace

std::uint64_t NpyHeader::length(const std::filesystem::path& path, std::string_view start) {
  if (!start.starts_with(kNpyMagic)) {
    fail_in_file(path, "not an NPY file");
  }
  constexpr std::size_t kVersionAndShortLength = 10;
  if (start.size() < kVersionAndShortLength) {
    fail_in_file(path, "the NPY header ends early");
  }
  const int version = static_cast<unsigned char>(start[6]);
  constexpr int kNewestVersion = 3;  // as 2, with names of fields in UTF-8
  if (version < 1 || version > kNewestVersion) {
    fail_in_file(path,
                 fmt::format("NPY format {}.{} is not 1.0, 2.0 or 3.0", version, static_cast<int>(start[7])));
  }
  if (version > 1 && start.size() < kPreamble) {
    fail_in_file(path, "the NPY header ends early");
  }
  return version == 1 ? kVersionAndShortLength + element<std::uint16_t>(&start[8], false)
                      : kPreamble + std::uint64_t{element<std::uint32_t>(&start[8], false)};
}

NpyHeader::NpyHeader(const std::filesystem::path& path, std::string_view begin, std::uint64_t file_bytes)
    : data_begin_(length(path, begin.substr(0, kPreamble))) {
  if (begin.size() < data_begin_) {
    fail_in_file(path, "the NPY header ends early");
  }
  constexpr std::size_t kVersion = 6;
  const std::size_t text_begin = begin[kVersion] == 1 ? kPreamble - 2 : kPreamble;
  const std::string_view text = begin.substr(text_begin, static_cast<std::size_t>(data_begin_) - text_begin);
  const auto [dtype, big_endian] = find_elements(path, text);
  read_ = dtype->read;
  element_bytes_ = dtype->size;
  integer_ = dtype->name[0] != 'f';
  big_endian_ = big_endian;
  fortran_ = parse_fortran_order(path, text);
  shape_ = parse_shape(path, text);
  if (std::ranges::find(shape_, std::size_t{0}) != shape_.end()) {
    fail_in_file(path, fmt::format("the array is empty: shape ({}) has no element", fmt::join(shape_, ", ")));
  }
  const std::uint64_t available = (file_bytes - data_begin_) / element_bytes_;
  for (const std::size_t extent : shape_) {
    if (count_ > available / extent) {
      fail_in_file(path, fmt::format("shape ({}) of {} needs more than the file's {} elements: truncated",
                                     fmt::join(shape_, ", "), dtype->name, available));
    }
    count_ *= extent;
  }
  if (file_bytes - data_begin_ != count_ * element_bytes_) {
    fail_in_file(path,
                 fmt::format("shape ({}) of {} needs {} bytes, the file has {}", fmt::join(shape_, ", "),
                             dtype->name, count_ * element_bytes_, file_bytes - data_begin_));
  }
}

bool NpyHeader::in_c_order() const {
  return !fortran_ || std::ranges::count_if(shape_, [](std::size_t extent) { return extent > 1; }) < 2;
}

void NpyHeader::decode(const std::filesystem::path& path, std::string_view bytes, std::size_t first,
                       std::span<double> values) const {
  decode_unchecked(bytes, values);
  for (std::size_t i = 0; integer_ && i < values.size(); ++i) {
    check(path, values[i], first + i);
  }
}

void NpyHeader::decode_unchecked(std::string_view bytes, std::span<double> values) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = read_(&bytes[i * element_bytes_], big_endian_);
  }
}

void NpyHeader::check(const std::filesystem::path& path, double value, std::size_t index) const {
  constexpr double kLargest = 0x1.0p53;  // an integer beyond has no place in a double of its own
  if (!integer_ || std::abs(value) <= kLargest) {
    return;
  }
  std::vector<std::size_t> place(shape_.size());
  for (std::size_t axis = shape_.size(); axis-- > 0;) {
    place[axis] = index % shape_[axis];
    index /= shape_[axis];
  }
  fail_in_file(path,
               fmt::format("element [{}]: the integer {:.0f} is beyond 2^53", fmt::join(place, ", "), value));
}

}  // namespace dtof
