// SPDX-License-Identifier: Apache-2.0
#include "dtof/convert/converted_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "dtof/container/array_address.hpp"
#include "dtof/container/npz.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/byte_stream.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/result_csv.hpp"
#include "dtof/recording/recorded_array.hpp"

namespace dtof {
namespace {

/// The confidence of each result; 0 where the file has no line for the pixel.
std::vector<float> confidence_of_results(const std::filesystem::path& path, const DepthImage& depth) {
  std::vector<float> values(depth.metres.size(), 0.0F);
  for (const ResultRecord& record : read_result_csv(path)) {
    if (record.column >= depth.width || record.row >= depth.height) {
      fail_in_file(path, fmt::format("column {}, row {} is outside the map of {} x {} pixels", record.column,
                                     record.row, depth.width, depth.height));
    }
    values[static_cast<std::size_t>(record.row) * static_cast<std::size_t>(depth.width) +
           static_cast<std::size_t>(record.column)] = static_cast<float>(record.result.confidence);
  }
  return values;
}

std::vector<float> field_of_array(const std::filesystem::path& path, const NpyArray& array,
                                  const DepthImage& depth) {
  std::vector<std::size_t> shape = array.shape;
  std::erase(shape, std::size_t{1});
  std::vector<std::size_t> wanted = {static_cast<std::size_t>(depth.height),
                                     static_cast<std::size_t>(depth.width)};
  std::erase(wanted, std::size_t{1});
  if (shape != wanted) {
    fail_in_file(path, fmt::format("shape ({}) is not that of the map, ({}, {})",
                                   fmt::join(array.shape, ", "), depth.height, depth.width));
  }
  std::vector<float> values;
  values.reserve(array.values.size());
  for (const double value : array.values) {
    if (std::isfinite(value) && std::abs(value) > std::numeric_limits<float>::max()) {
      fail_in_file(path, fmt::format("{:g} is too large a number", value));
    }
    values.push_back(static_cast<float>(value));
  }
  return values;
}

std::vector<float> read_field(const std::string& name, const DepthImage& depth) {
  const std::filesystem::path path = parse_array_address(name).file;
  const std::string start = file_start(path, kResultCsvHeader.size());
  if (start == kResultCsvHeader) {
    return confidence_of_results(path, depth);
  }
  if (starts_as_image(start)) {
    ReflectivityImage image = read_reflectivity_image(path, 1.0);
    if (image.width != depth.width || image.height != depth.height) {
      fail_in_file(path, fmt::format("{} x {} pixels are not the map's, {} x {}", image.width, image.height,
                                     depth.width, depth.height));
    }
    return std::move(image.values);
  }
  const RecordingOptions options{.file = name};
  const RecordingFile file = read_recording(options);
  if (file.format != "npy" && file.format != "npz" && file.format != "mat" && file.format != "hdf5") {
    fail_in_file(path, "neither a map (PNG, PFM, NPY, NPZ, HDF5, MAT) nor results (CSV)");
  }
  return field_of_array(path, open_array(options, file), depth);
}

/// The archive's array that belongs to its map: "sifh_confidence" to "sifh_depth_m".
std::optional<std::vector<float>> companion(const ConversionOptions& options, const ConversionInput& input,
                                            const std::string& field, const DepthImage& depth) {
  if (input.file.format != "npz") {
    return std::nullopt;
  }
  constexpr std::string_view kDepth = "depth_m";
  const auto [path, named] = parse_array_address(options.recording.file);
  const std::string array = named.empty() ? std::string(kDepth) : named;
  if (!array.ends_with(kDepth)) {
    return std::nullopt;
  }
  const std::string wanted = array.substr(0, array.size() - kDepth.size()) + field;
  const NpzArchive archive = open_archive(options.recording, input.file);
  if (!archive.has(wanted)) {
    return std::nullopt;
  }
  return field_of_array(path, archive.read(wanted), depth);
}

}  // namespace

bool starts_as_image(std::string_view start) {
  return start.starts_with("\x89PNG") || start.starts_with("Pf") || start.starts_with("PF");
}

ConvertedMap read_converted_map(const ConversionOptions& options, const ConversionInput& input) {
  const std::filesystem::path path = parse_array_address(options.recording.file).file;
  ConvertedMap map;
  map.depth = input.kind == InputKind::kMap
                  ? read_depth_image(path, options.metres_per_unit)
                  : depth_image_of(array_label(options.recording, input.file),
                                   open_array(options.recording, input.file), options.metres_per_unit);
  for (const auto& [name, file] :
       {std::pair{std::string("confidence"), options.confidence}, {"amplitude", options.amplitude}}) {
    if (!file.empty()) {
      map.fields.push_back({name, read_field(file, map.depth)});
    } else if (auto own = companion(options, input, name, map.depth)) {
      map.fields.push_back({name, *std::move(own)});
    }
  }
  return map;
}

std::string write_converted_map(const std::string& out, const DepthImage& depth) {
  if (out.ends_with(".pfm")) {
    write_pfm(out, depth);
    return "";
  }
  if (const std::string obstacle = depth_png_obstacle(depth); !obstacle.empty()) {
    fail_in_file(out, obstacle);
  }
  constexpr double kLeast = 0.5e-3;  // rounds to 1 mm
  const auto known = std::ranges::count_if(depth.metres, is_known_distance);
  const auto lost = std::ranges::count_if(
      depth.metres, [](float metres) { return is_known_distance(metres) && double{metres} < kLeast; });
  if (lost == known && known > 0) {
    fail_in_file(out, fmt::format("each of the {} distances is below 0.5 mm, and a PNG has whole mm: choose "
                                  ".pfm or .npy, or another --depth-scale",
                                  known));
  }
  write_depth_png(out, depth);
  return lost == 0 ? "" : fmt::format("{} are below 0.5 mm and lost, because a PNG has whole mm", lost);
}

}  // namespace dtof
