// SPDX-License-Identifier: Apache-2.0
#include "io/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <regex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "elements are copied as they stand in the file");

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

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

/// Value of one key of the header, a Python dict that numpy writes with these three keys.
std::string header_value(const std::filesystem::path& path, const std::string& header, const char* key,
                         const char* pattern) {
  std::smatch match;
  if (!std::regex_search(header, match, std::regex(fmt::format("'{}'\\s*:\\s*{}", key, pattern)))) {
    fail(path, fmt::format("the NPY header has no readable '{}'", key));
  }
  return match[1];
}

std::vector<std::size_t> parse_shape(const std::filesystem::path& path, const std::string& text) {
  std::vector<std::size_t> shape;
  const std::regex number("[0-9]+");
  for (auto it = std::sregex_iterator(text.begin(), text.end(), number); it != std::sregex_iterator(); ++it) {
    const std::string digits = it->str();
    std::size_t value = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), value).ec != std::errc()) {
      fail(path, fmt::format("the NPY shape ({}) is too large", text));
    }
    shape.push_back(value);
  }
  return shape;
}

const Dtype& find_dtype(const std::filesystem::path& path, const std::string& descr) {
  for (const Dtype& dtype : kDtypes) {
    if (descr.substr(1) == dtype.name && (descr[0] == '<' || (descr[0] == '|' && dtype.size == 1))) {
      return dtype;
    }
  }
  fail(path, fmt::format("dtype '{}' is not one of little-endian u1, u2, u4, i4, i8, f4, f8", descr));
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) {
  const std::string file = read_file(path);
  if (!std::string_view(file).starts_with(kMagic)) {
    fail(path, "not an NPY file");
  }
  if (file.size() < 10) {
    fail(path, "the NPY header ends early");
  }
  const int version = static_cast<unsigned char>(file[6]);
  if (version != 1 && version != 2) {
    fail(path, fmt::format("NPY format {}.{} is not 1.0 or 2.0", version, static_cast<int>(file[7])));
  }
  const std::size_t length_size = version == 1 ? 2 : 4;
  const std::size_t header_begin = 8 + length_size;
  if (file.size() < header_begin) {
    fail(path, "the NPY header ends early");
  }
  const auto header_length = static_cast<std::size_t>(version == 1 ? element<std::uint16_t>(&file[8])
                                                                   : element<std::uint32_t>(&file[8]));
  if (file.size() - header_begin < header_length) {
    fail(path, "the NPY header ends early");
  }
  // No real header is near this size, and std::regex recurses on its input.
  if (header_length > 4096) {
    fail(path, fmt::format("the NPY header has {} bytes, more than 4096", header_length));
  }
  const std::string header = file.substr(header_begin, header_length);
  const Dtype& dtype = find_dtype(path, header_value(path, header, "descr", "'([^']+)'"));
  const bool fortran = header_value(path, header, "fortran_order", "(True|False)") == "True";
  NpyArray array;
  array.shape = parse_shape(path, header_value(path, header, "shape", "\\(([0-9, ]*)\\)"));

  const std::size_t available = (file.size() - header_begin - header_length) / dtype.size;
  std::size_t count = 1;
  for (const std::size_t extent : array.shape) {
    if (extent != 0 && count > available / extent) {
      fail(path, fmt::format("shape ({}) of {} needs more than the file's {} elements: truncated",
                             fmt::join(array.shape, ", "), dtype.name, available));
    }
    count *= extent;
  }
  const std::size_t data_begin = header_begin + header_length;
  if (file.size() - data_begin != count * dtype.size) {
    fail(path, fmt::format("shape ({}) of {} needs {} bytes, the file has {}", fmt::join(array.shape, ", "),
                           dtype.name, count * dtype.size, file.size() - data_begin));
  }
  if (count == 0) {
    fail(path, fmt::format("shape ({}) holds nothing", fmt::join(array.shape, ", ")));
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
