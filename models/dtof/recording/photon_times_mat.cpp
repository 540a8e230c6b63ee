// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/photon_times_mat.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

// The MATLAB 5 format as far as it is read here: "MAT-File Format", The MathWorks. After a header of 128
// bytes the file is a row of elements, each a tag (type, size) and data. The reader is our own because the
// files come from anywhere, and libraries for the whole format trust their sizes.
constexpr std::size_t kHeaderSize = 128;
constexpr std::size_t kTagSize = 8;
constexpr std::size_t kLongestUnpackedVariable = std::size_t{1} << 30U;
constexpr std::size_t kLargestExtent = std::numeric_limits<std::uint16_t>::max();

enum ElementType : std::uint32_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kSingle = 7,
  kDouble = 9,
  kInt64 = 12,
  kUint64 = 13,
  kMatrix = 14,
  kCompressed = 15,
};

enum ArrayClass : std::uint8_t {
  kCellClass = 1,
  kSparseClass = 5,
  kFirstNumericClass = 6,
  kLastNumericClass = 15
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

template <typename T>
T value_at(std::string_view bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, &bytes[offset], sizeof value);
  return value;
}

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
};

/// Takes the first element of `rest`; none if it is damaged.
std::optional<Element> take_element(std::string_view& rest) {
  if (rest.size() < kTagSize) {
    return std::nullopt;
  }
  const auto word = value_at<std::uint32_t>(rest, 0);
  // Up to four bytes stand in the tag itself, their number in its upper half.
  if (const std::uint32_t small_size = word >> 16U; small_size != 0) {
    if (small_size > 4) {
      return std::nullopt;
    }
    const Element element{word & 0xFFFFU, rest.substr(4, small_size)};
    rest.remove_prefix(kTagSize);
    return element;
  }
  const auto size = value_at<std::uint32_t>(rest, 4);
  if (rest.size() - kTagSize < size) {
    return std::nullopt;
  }
  const Element element{word, rest.substr(kTagSize, size)};
  const std::size_t padded = (kTagSize + size + 7) / 8 * 8;
  rest.remove_prefix(std::min(padded, rest.size()));
  return element;
}

/// An array's description and what follows it.
struct Array {
  std::uint8_t kind = 0;  ///< ArrayClass
  bool complex = false;
  std::vector<std::size_t> extents;  ///< rows, columns, ...
  std::string_view name;
  std::string_view contents;
};

/// The array that the data of a matrix element hold; none if it is damaged.
std::optional<Array> parse_array(std::string_view data) {
  const auto flags = take_element(data);
  const auto extents = take_element(data);
  const auto name = take_element(data);
  if (!flags || flags->type != kUint32 || flags->data.size() != 8 || !extents || extents->type != kInt32 ||
      extents->data.size() < 8 || extents->data.size() % 4 != 0 || !name) {
    return std::nullopt;
  }
  constexpr std::uint32_t kComplexFlag = 0x800;
  const auto word = value_at<std::uint32_t>(flags->data, 0);
  Array array{.kind = static_cast<std::uint8_t>(word & 0xFFU),
              .complex = (word & kComplexFlag) != 0,
              .extents = {},
              .name = name->data,
              .contents = data};
  for (std::size_t offset = 0; offset < extents->data.size(); offset += 4) {
    const auto extent = value_at<std::int32_t>(extents->data, offset);
    if (extent < 0) {
      return std::nullopt;
    }
    array.extents.push_back(static_cast<std::size_t>(extent));
  }
  return array;
}

template <typename T>
bool append_as(std::string_view data, std::size_t count, std::vector<double>& out) {
  if (data.size() / sizeof(T) != count || data.size() % sizeof(T) != 0) {
    return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(static_cast<double>(value_at<T>(data, i * sizeof(T))));
  }
  return true;
}

/// Appends the elements of a real numeric array in file order (columns first); false if it is none, or
/// damaged.
bool append_numbers(const Array& array, std::vector<double>& out) {
  if (array.kind < kFirstNumericClass || array.kind > kLastNumericClass || array.complex) {
    return false;
  }
  std::size_t count = 1;
  for (const std::size_t extent : array.extents) {
    if (extent != 0 && count > array.contents.size() / extent) {
      return false;
    }
    count *= extent;
  }
  if (count == 0) {
    return true;
  }
  std::string_view rest = array.contents;
  const auto numbers = take_element(rest);
  if (!numbers) {
    return false;
  }
  switch (numbers->type) {
    case kInt8:
      return append_as<std::int8_t>(numbers->data, count, out);
    case kUint8:
      return append_as<std::uint8_t>(numbers->data, count, out);
    case kInt16:
      return append_as<std::int16_t>(numbers->data, count, out);
    case kUint16:
      return append_as<std::uint16_t>(numbers->data, count, out);
    case kInt32:
      return append_as<std::int32_t>(numbers->data, count, out);
    case kUint32:
      return append_as<std::uint32_t>(numbers->data, count, out);
    case kSingle:
      return append_as<float>(numbers->data, count, out);
    case kDouble:
      return append_as<double>(numbers->data, count, out);
    case kInt64:
      return append_as<std::int64_t>(numbers->data, count, out);
    case kUint64:
      return append_as<std::uint64_t>(numbers->data, count, out);
    default:
      return false;
  }
}

/// zlib data unpacked; none if they do not unpack to their end with the right checksum, or to more than
/// `longest` bytes.
std::optional<std::string> unpack(std::string_view data, std::size_t longest) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) {
    return std::nullopt;
  }
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  std::array<Bytef, std::size_t{1} << 16U> chunk{};
  std::string unpacked;
  int status = Z_OK;
  while (status == Z_OK && unpacked.size() <= longest) {
    stream.next_out = chunk.data();
    stream.avail_out = static_cast<uInt>(chunk.size());
    status = inflate(&stream, Z_NO_FLUSH);
    unpacked.append(reinterpret_cast<const char*>(chunk.data()), chunk.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END && unpacked.size() <= longest ? std::optional(std::move(unpacked))
                                                              : std::nullopt;
}

/// A variable of a file, and the bytes that it points into.
struct Variable {
  std::unique_ptr<const std::string> bytes;  ///< a matrix element
  Array array;
};

[[noreturn]] void fail_sparse(const std::filesystem::path& path, const std::string& name,
                              const std::string& conversion) {
  fail(path,
       fmt::format("\"{0}\" is sparse, which is not supported; convert it in MATLAB or Octave: {0} = {1}; "
                   "save('-v7', 'full.mat', '{0}')",
                   name, conversion));
}

/// The matrix element of the variable `name`; empty if there is none. Every element must be sound.
std::string find_variable(const std::filesystem::path& path, std::string_view file, const std::string& name) {
  constexpr std::string_view kLittleEndianLevel5 = {"\x00\x01IM", 4};
  if (!file.starts_with("MATLAB")) {
    fail(path, "not a MATLAB file");
  }
  if (file.size() < kHeaderSize) {
    fail(path, "damaged: the file ends in its header");
  }
  if (file.substr(kHeaderSize - kLittleEndianLevel5.size(), kLittleEndianLevel5.size()) !=
      kLittleEndianLevel5) {
    fail(path, "not a little-endian MATLAB 5 file (save with -v7 or -v6)");
  }
  std::string found;
  for (std::size_t offset = kHeaderSize; offset < file.size();) {
    if (file.size() - offset < kTagSize ||
        file.size() - offset - kTagSize < value_at<std::uint32_t>(file, offset + 4)) {
      fail(path, fmt::format("damaged: the variable at byte {} ends beyond the file; \"{}\" was asked for",
                             offset, name));
    }
    const std::size_t size = value_at<std::uint32_t>(file, offset + 4);
    std::string element(file.substr(offset, kTagSize + size));
    if (value_at<std::uint32_t>(file, offset) == kCompressed) {
      auto unpacked = unpack(std::string_view(element).substr(kTagSize), kLongestUnpackedVariable);
      if (!unpacked) {
        fail(path,
             fmt::format(
                 "damaged: the variable at byte {} does not decompress, or not to 1 GiB at most; \"{}\" "
                 "was asked for",
                 offset, name));
      }
      element = *std::move(unpacked);
    }
    std::string_view rest = element;
    const auto matrix = take_element(rest);
    if (found.empty() && matrix && matrix->type == kMatrix) {
      const auto array = parse_array(matrix->data);
      if (array && array->name == name) {
        found = std::move(element);
      }
    }
    offset += kTagSize + size;
  }
  return found;
}

/// A variable of whatever axes that is not sparse.
Variable read_any_variable(const std::filesystem::path& path, std::string_view file,
                           const std::string& name) {
  Variable variable{std::make_unique<const std::string>(find_variable(path, file, name)), {}};
  std::string_view rest = *variable.bytes;
  const auto matrix = take_element(rest);
  auto array = matrix ? parse_array(matrix->data) : std::nullopt;
  if (!array) {
    fail(path, fmt::format("the variable \"{}\" is missing or damaged", name));
  }
  if (array->kind == kSparseClass) {
    fail_sparse(path, name, fmt::format("full({})", name));
  }
  variable.array = *std::move(array);
  return variable;
}

Variable read_variable(const std::filesystem::path& path, std::string_view file, const std::string& name) {
  Variable variable = read_any_variable(path, file, name);
  const std::vector<std::size_t>& extents = variable.array.extents;
  if (extents.size() != 2 || extents[0] == 0 || extents[1] == 0 || extents[0] > kLargestExtent ||
      extents[1] > kLargestExtent) {
    fail(path, fmt::format("\"{}\" is not a two-dimensional array of at most 65535 x 65535", name));
  }
  return variable;
}

}  // namespace

PhotonTimes read_photon_times_mat(const std::filesystem::path& path, const std::string& variable) {
  return parse_photon_times_mat(path, read_file(path), variable);
}

PhotonTimes parse_photon_times_mat(const std::filesystem::path& path, std::string_view file,
                                   const std::string& variable) {
  const Variable read = read_variable(path, file, variable);
  const Array& cells = read.array;
  if (cells.kind != kCellClass) {
    fail(path, fmt::format("\"{}\" is not a cell array", variable));
  }
  const std::size_t rows = cells.extents[0];
  const std::size_t columns = cells.extents[1];
  if (rows * columns > cells.contents.size() / kTagSize) {
    fail(path, fmt::format("damaged: \"{}\" has {} x {} cells in {} bytes", variable, rows, columns,
                           cells.contents.size()));
  }
  // The file has them column by column.
  std::vector<Element> elements(rows * columns);
  std::string_view rest = cells.contents;
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      const auto element = take_element(rest);
      if (!element || element->type != kMatrix) {
        fail(path, fmt::format("\"{}\": the cell of column {}, row {} is damaged", variable, column, row));
      }
      elements[row * columns + column] = *element;
    }
  }
  PhotonTimes photons{
      .columns = static_cast<int>(columns), .rows = static_cast<int>(rows), .ticks = {}, .begin = {0}};
  for (std::size_t pixel = 0; pixel < elements.size(); ++pixel) {
    // An element without data is an empty cell.
    if (!elements[pixel].data.empty()) {
      const auto numbers = parse_array(elements[pixel].data);
      if (numbers && numbers->kind == kSparseClass) {
        fail_sparse(path, variable, fmt::format("cellfun(@full, {}, 'UniformOutput', false)", variable));
      }
      if (!numbers || !append_numbers(*numbers, photons.ticks)) {
        fail(path, fmt::format("\"{}\": the cell of column {}, row {} is damaged or holds no real numbers",
                               variable, pixel % columns, pixel / columns));
      }
    }
    const auto first = photons.ticks.begin() + static_cast<std::ptrdiff_t>(photons.begin.back());
    if (!std::all_of(first, photons.ticks.end(), [](double tick) { return std::isfinite(tick); })) {
      fail(path, fmt::format("\"{}\": column {}, row {} holds a time that is not finite", variable,
                             pixel % columns, pixel / columns));
    }
    photons.begin.push_back(photons.ticks.size());
  }
  return photons;
}

NpyArray parse_mat_array(const std::filesystem::path& path, std::string_view file,
                         const std::string& variable) {
  const Variable read = read_any_variable(path, file, variable);
  NpyArray array{.shape = read.array.extents, .values = {}};
  std::vector<double> first_axis_fastest;
  if (!append_numbers(read.array, first_axis_fastest)) {
    fail(path, fmt::format("\"{}\" is not a real numeric array, or damaged", variable));
  }
  if (first_axis_fastest.empty()) {
    fail(path, fmt::format("\"{}\" is empty", variable));
  }
  array.values = c_order_of_reversed(first_axis_fastest, array.shape);
  return array;
}

MatMatrix read_mat_matrix(const std::filesystem::path& path, const std::string& variable) {
  const Variable read = read_variable(path, read_file(path), variable);
  std::vector<double> by_column;
  if (!append_numbers(read.array, by_column)) {
    fail(path, fmt::format("\"{}\" is not a real numeric matrix, or damaged", variable));
  }
  const std::size_t rows = read.array.extents[0];
  const std::size_t columns = read.array.extents[1];
  MatMatrix matrix{.columns = static_cast<int>(columns), .rows = static_cast<int>(rows), .values = {}};
  matrix.values.reserve(by_column.size());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      matrix.values.push_back(by_column[row + column * rows]);
    }
  }
  return matrix;
}

PhotonTimesStream::PhotonTimesStream(PhotonTimes photons, double tick_duration, const Resampling& resampling)
    : ResampledStream(photons.columns, photons.rows, resampling),
      photons_(std::move(photons)),
      tick_duration_(tick_duration) {
  if (!std::isfinite(tick_duration) || tick_duration <= 0.0) {
    throw InputError(fmt::format("photon times: tick duration is {}, must be a positive number of seconds",
                                 tick_duration));
  }
}

void PhotonTimesStream::draw_times(int column, int row, CounterRandom& random,
                                   std::vector<double>& times) const {
  const std::span<const double> ticks = photons_.pixel(column, row);
  std::size_t left = ticks.size();
  const double budget = resampling().photon_budget.value_or(static_cast<double>(left));
  const bool fixed = resampling().photon_number == PhotonNumber::kFixed;
  auto wanted = std::min<std::uint64_t>(left, static_cast<std::uint64_t>(std::llround(budget)));
  for (const double tick : ticks) {
    // Fixed: selection sampling (Knuth, TAOCP 3.4.2, algorithm S).
    const double probability = fixed ? static_cast<double>(wanted) / static_cast<double>(left)
                                     : budget / static_cast<double>(ticks.size());
    --left;
    if (random.uniform() < probability) {
      wanted -= wanted > 0 ? 1 : 0;
      times.push_back(tick * tick_duration_);
    }
  }
}

}  // namespace dtof
