// SPDX-License-Identifier: Apache-2.0
#include "io/photon_times_mat.hpp"

#include <fmt/format.h>
#include <matio.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kLongestUnpackedMat = std::size_t{1} << 30U;
constexpr std::size_t kLargestExtent = std::numeric_limits<std::uint16_t>::max();

struct MatCloser {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct VariableDeleter {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, VariableDeleter>;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

std::uint32_t word_at(std::string_view file, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, &file[offset], sizeof word);
  return word;
}

/// Bytes that zlib data unpacks to; none if it does not decompress to its end with the right checksum, or to
/// more than `longest`.
std::optional<std::size_t> unpacked_size(std::string_view data, std::size_t longest) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) {
    return std::nullopt;
  }
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  std::array<Bytef, std::size_t{1} << 16U> discarded{};
  int status = Z_OK;
  while (status == Z_OK && stream.total_out <= longest) {
    stream.next_out = discarded.data();
    stream.avail_out = static_cast<uInt>(discarded.size());
    status = inflate(&stream, Z_NO_FLUSH);
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END && stream.total_out <= longest ? std::optional(stream.total_out)
                                                               : std::nullopt;
}

/// matio hands out what it could read of a truncated file and ignores zlib's checksum, so the container is
/// checked here: after the header of 128 bytes the elements (type, size, data) must fill the file exactly.
/// Returns the bytes of all elements, unpacked.
std::size_t check_mat_file(const std::filesystem::path& path) {
  constexpr std::size_t kHeaderSize = 128;
  constexpr std::size_t kTagSize = 8;
  constexpr std::uint32_t kCompressed = 15;
  constexpr std::string_view kLittleEndianLevel5 = {"\x00\x01IM", 4};
  const std::string contents = read_file(path);
  const std::string_view file = contents;
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
  std::size_t unpacked = 0;
  std::size_t offset = kHeaderSize;
  while (offset < file.size()) {
    if (file.size() - offset < kTagSize || file.size() - offset - kTagSize < word_at(file, offset + 4)) {
      fail(path, fmt::format("damaged: the variable at byte {} ends beyond the file", offset));
    }
    const std::size_t size = word_at(file, offset + 4);
    if (word_at(file, offset) == kCompressed) {
      const auto bytes = unpacked_size(file.substr(offset + kTagSize, size), kLongestUnpackedMat - unpacked);
      if (!bytes) {
        fail(path,
             fmt::format("damaged: the variable at byte {} does not decompress, or not to 1 GiB at most",
                         offset));
      }
      unpacked += *bytes;
    } else {
      unpacked += size;
    }
    offset += kTagSize + size;
  }
  return unpacked;
}

[[noreturn]] void fail_sparse(const std::filesystem::path& path, const std::string& name,
                              const std::string& conversion) {
  fail(path,
       fmt::format("\"{0}\" is sparse, which is not supported; convert it in MATLAB or Octave: {0} = {1}; "
                   "save('-v7', 'full.mat', '{0}')",
                   name, conversion));
}

Variable read_variable(const std::filesystem::path& path, const std::string& name) {
  const std::size_t unpacked_bytes = check_mat_file(path);
  const std::unique_ptr<mat_t, MatCloser> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  if (!file) {
    fail(path, "not a MATLAB file");
  }
  const Variable info(Mat_VarReadInfo(file.get(), name.c_str()));
  if (!info) {
    fail(path, fmt::format("the variable \"{}\" is missing or damaged", name));
  }
  if (info->class_type == MAT_C_SPARSE) {
    fail_sparse(path, name, fmt::format("full({})", name));
  }
  if (info->rank != 2 || info->dims[0] == 0 || info->dims[1] == 0 || info->dims[0] > kLargestExtent ||
      info->dims[1] > kLargestExtent) {
    fail(path, fmt::format("\"{}\" is not a two-dimensional array of at most 65535 x 65535", name));
  }
  // Every element takes at least a byte of the file: a header that asks for more is damaged.
  if (info->dims[0] * info->dims[1] > unpacked_bytes) {
    fail(path, fmt::format("damaged: \"{}\" has {} x {} elements, the whole file {} bytes", name,
                           info->dims[0], info->dims[1], unpacked_bytes));
  }
  Variable variable(Mat_VarRead(file.get(), name.c_str()));
  if (!variable) {
    fail(path, fmt::format("the variable \"{}\" is missing or damaged", name));
  }
  return variable;
}

template <typename T>
void append_as(const matvar_t& variable, std::size_t count, std::vector<double>& out) {
  const auto* const data = static_cast<const T*>(variable.data);
  std::transform(data, data + count, std::back_inserter(out),
                 [](T value) { return static_cast<double>(value); });
}

/// Appends the elements of a real numeric array in file order (columns first); false if it is none.
bool append_numbers(const matvar_t& variable, std::vector<double>& out) {
  std::size_t count = 1;
  for (int axis = 0; axis < variable.rank; ++axis) {
    count *= variable.dims[axis];
  }
  if (count == 0) {
    return true;
  }
  if (variable.data == nullptr || variable.isComplex != 0 || variable.data_size <= 0 ||
      variable.nbytes < count * static_cast<std::size_t>(variable.data_size)) {
    return false;
  }
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      append_as<double>(variable, count, out);
      return true;
    case MAT_C_SINGLE:
      append_as<float>(variable, count, out);
      return true;
    case MAT_C_INT32:
      append_as<std::int32_t>(variable, count, out);
      return true;
    case MAT_C_UINT32:
      append_as<std::uint32_t>(variable, count, out);
      return true;
    case MAT_C_INT16:
      append_as<std::int16_t>(variable, count, out);
      return true;
    case MAT_C_UINT16:
      append_as<std::uint16_t>(variable, count, out);
      return true;
    default:
      return false;
  }
}

}  // namespace

PhotonTimes read_photon_times_mat(const std::filesystem::path& path, const std::string& variable) {
  const Variable cells = read_variable(path, variable);
  if (cells->class_type != MAT_C_CELL || cells->data == nullptr) {
    fail(path, fmt::format("\"{}\" is not a cell array", variable));
  }
  PhotonTimes photons;
  photons.rows = static_cast<int>(cells->dims[0]);
  photons.columns = static_cast<int>(cells->dims[1]);
  photons.begin.push_back(0);
  for (int row = 0; row < photons.rows; ++row) {
    for (int column = 0; column < photons.columns; ++column) {
      const matvar_t* const cell = Mat_VarGetCell(cells.get(), row + column * photons.rows);
      const bool empty = cell == nullptr || cell->class_type == MAT_C_EMPTY;
      if (!empty && cell->class_type == MAT_C_SPARSE) {
        fail_sparse(path, variable, fmt::format("cellfun(@full, {}, 'UniformOutput', false)", variable));
      }
      if (!empty && !append_numbers(*cell, photons.ticks)) {
        fail(path, fmt::format("\"{}\": the cell of column {}, row {} is damaged or holds no real numbers",
                               variable, column, row));
      }
      const auto first = photons.ticks.begin() + static_cast<std::ptrdiff_t>(photons.begin.back());
      if (!std::all_of(first, photons.ticks.end(), [](double tick) { return std::isfinite(tick); })) {
        fail(path,
             fmt::format("\"{}\": column {}, row {} holds a time that is not finite", variable, column, row));
      }
      photons.begin.push_back(photons.ticks.size());
    }
  }
  return photons;
}

MatMatrix read_mat_matrix(const std::filesystem::path& path, const std::string& variable) {
  const Variable array = read_variable(path, variable);
  std::vector<double> by_column;
  if (!append_numbers(*array, by_column)) {
    fail(path, fmt::format("\"{}\" is not a real numeric matrix, or damaged", variable));
  }
  MatMatrix matrix{
      .columns = static_cast<int>(array->dims[1]), .rows = static_cast<int>(array->dims[0]), .values = {}};
  matrix.values.reserve(by_column.size());
  for (std::size_t row = 0; row < array->dims[0]; ++row) {
    for (std::size_t column = 0; column < array->dims[1]; ++column) {
      matrix.values.push_back(by_column[row + column * array->dims[0]]);
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
