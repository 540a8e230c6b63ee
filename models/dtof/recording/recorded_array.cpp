// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recorded_array.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <system_error>

#include "dtof/container/array_address.hpp"
#include "dtof/container/hdf5_reader.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/byte_source.hpp"
#include "dtof/io/npy_reader.hpp"
#include "dtof/recording/photon_times_mat.hpp"

namespace dtof {
namespace {

/// What an archive of `dtof convert` holds beside its bin width and the like; empty for another archive.
std::string own_array(const NpzArchive& archive) {
  for (const char* const name : {"histograms", "depth_m"}) {
    if (archive.has(name)) {
      return name;
    }
  }
  return "";
}

}  // namespace

std::string format_read_in_place(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return "";
  }
  std::array<char, 6> start{};
  const std::size_t count = FileBytes(path).read_at(0, start);
  const std::string_view begin(start.data(), count);
  return begin.starts_with("\x93NUMPY") ? "npy" : is_zip(begin) ? "npz" : "";
}

bool is_read_in_place(const RecordingFile& file) {
  return file.contents.empty() && (file.format == "npy" || file.format == "npz" || file.format == "hdf5");
}

NpzArchive open_archive(const RecordingOptions& options, const RecordingFile& file) {
  const std::filesystem::path path = parse_array_address(options.file).file;
  return file.contents.empty() ? NpzArchive(path) : NpzArchive(path, file.contents);
}

std::unique_ptr<ArrayReader> open_array_reader(const RecordingOptions& options, const RecordingFile& file) {
  const auto [path, array] = parse_array_address(options.file);
  if (file.format == "npy") {
    return file.contents.empty() ? open_npy(path)
                                 : std::make_unique<HeldArray>(parse_npy(path, file.contents));
  }
  if (file.format == "npz") {
    const NpzArchive archive = open_archive(options, file);
    return archive.open(array.empty() ? own_array(archive) : array);
  }
  if (file.format == "mat") {
    return std::make_unique<HeldArray>(parse_mat_array(path, file.contents, variable_of(options)));
  }
  return open_hdf5_array(path, array);
}

NpyArray open_array(const RecordingOptions& options, const RecordingFile& file) {
  return read_whole(options.file, *open_array_reader(options, file));
}

std::string array_label(const RecordingOptions& options, const RecordingFile& file) {
  const bool unnamed = file.format == "mat" && parse_array_address(options.file).array.empty();
  return unnamed ? fmt::format("{}:{}", options.file, options.variable) : options.file;
}

std::string variable_of(const RecordingOptions& options) {
  const std::string named = parse_array_address(options.file).array;
  return named.empty() ? options.variable : named.substr(named.starts_with('/') ? 1 : 0);
}

double bin_width_of(const RecordingOptions& options, const RecordingFile& file) {
  if (options.bin_width_s) {
    return *options.bin_width_s;
  }
  if (file.format == "npz") {
    if (const NpzArchive archive = open_archive(options, file); archive.has(kBinWidthName)) {
      return archive.read(std::string(kBinWidthName)).values.front() * 1e-12;
    }
  }
  throw InputError(fmt::format("{}: {} needs --bin-width", options.file,
                               file.format == "npy" ? "an NPY histogram" : "a histogram"));
}

}  // namespace dtof
