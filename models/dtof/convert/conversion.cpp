// SPDX-License-Identifier: Apache-2.0
#include "dtof/convert/conversion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "dtof/container/array_address.hpp"
#include "dtof/container/hdf5_array.hpp"
#include "dtof/container/npz.hpp"
#include "dtof/container/photon_hdf5.hpp"
#include "dtof/convert/converted_map.hpp"
#include "dtof/convert/histograms.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/array_reader.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/byte_stream.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/photon_hdf5_cube.hpp"
#include "dtof/recording/picoquant.hpp"
#include "dtof/recording/recorded_array.hpp"
#include "dtof/recording/resampling.hpp"
#include "dtof/recording/stream_csv.hpp"

namespace dtof {
namespace {

struct OutputEnding {
  std::string_view ending;
  OutputKind kind;
};
constexpr std::array<OutputEnding, 7> kEndings = {{{".png", OutputKind::kMap},
                                                   {".pfm", OutputKind::kMap},
                                                   {".ply", OutputKind::kPoints},
                                                   {".pcd", OutputKind::kPoints},
                                                   {".npy", OutputKind::kNpy},
                                                   {".npz", OutputKind::kNpz},
                                                   {".csv", OutputKind::kCsv}}};

/// Whether a file of MATLAB's has photon times under the name that is asked for.
bool has_cells(const RecordingOptions& options, const RecordingFile& file) {
  if (file.format == "mat") {
    return !options.bin_width_s && parse_array_address(options.file).array.empty();
  }
  const auto [path, array] = parse_array_address(options.file);
  return file.format == "hdf5" && is_hdf5_cell_array(path, array.empty() ? options.variable : array);
}

std::string map_sentence(const ConvertedMap& map) {
  const auto known = std::count_if(map.depth.metres.begin(), map.depth.metres.end(), is_known_distance);
  std::string sentence =
      fmt::format("{} x {} pixels, {} with a distance", map.depth.width, map.depth.height, known);
  for (const PointField& field : map.fields) {
    sentence += ", " + field.name;
  }
  return sentence;
}

std::string write_points(const ConversionOptions& options, const ConvertedMap& map) {
  const bool ply = options.out.ends_with(".ply");
  const PointCloudFormat format = ply ? (options.text ? PointCloudFormat::kPlyText : PointCloudFormat::kPly)
                                      : (options.text ? PointCloudFormat::kPcdText : PointCloudFormat::kPcd);
  write_point_cloud(options.out, map.depth, map.fields, format, options.degrees_per_pixel);
  return map_sentence(map);
}

std::string write_map_archive(const ConversionOptions& options, const ConvertedMap& map) {
  const std::vector<std::size_t> shape = {static_cast<std::size_t>(map.depth.height),
                                          static_cast<std::size_t>(map.depth.width)};
  NpzWriter writer(options.out);
  writer.add("depth_m", shape, std::span(map.depth.metres));
  for (const PointField& field : map.fields) {
    writer.add(field.name, shape, std::span(field.values));
  }
  writer.commit();
  return map_sentence(map);
}

/// A map as a file of maps, points or arrays.
std::string convert_map(const ConversionOptions& options, const ConversionInput& input) {
  const ConvertedMap map = read_converted_map(options, input);
  switch (output_kind(options.out)) {
    case OutputKind::kPoints:
      return write_points(options, map);
    case OutputKind::kNpz:
      return write_map_archive(options, map);
    case OutputKind::kNpy:
      write_npy(options.out,
                std::vector<std::size_t>{static_cast<std::size_t>(map.depth.height),
                                         static_cast<std::size_t>(map.depth.width)},
                std::vector<double>(map.depth.metres.begin(), map.depth.metres.end()));
      return map_sentence(map);
    default: {
      const std::string lost = write_converted_map(options.out, map.depth);
      return map_sentence(map) + (lost.empty() ? "" : "; " + lost);
    }
  }
}

/// An array as it is, of whatever axes, piece by piece.
std::string convert_array(const ConversionOptions& options, const ConversionInput& input) {
  const std::unique_ptr<ArrayReader> array = open_array_reader(options.recording, input.file);
  if (output_kind(options.out) == OutputKind::kNpy) {
    write_npy(options.out, *array);
  } else {
    const std::string named = parse_array_address(options.recording.file).array;
    const std::string name = named.substr(named.find_last_of('/') + 1);
    NpzWriter writer(options.out);
    writer.add(name.empty() ? "array" : name, *array);
    if (options.recording.bin_width_s) {
      const double width = *options.recording.bin_width_s * 1e12;
      writer.add(std::string(kBinWidthName), std::vector<std::size_t>{}, std::span(&width, 1));
    }
    writer.commit();
  }
  return fmt::format("an array of shape ({})", fmt::join(array->shape(), ", "));
}

/// Histograms (rows, columns, bins).
std::string convert_to_histograms(const ConversionOptions& options, const ConversionInput& input) {
  RecordedData measurement = open_recorded_data(options.recording, input.file);
  const std::string description = measurement.description;
  const CountedHistograms counted = count_histograms(std::move(measurement), options.recording);
  const HistogramCube& cube = counted.cube;
  const std::vector<std::size_t> shape = {static_cast<std::size_t>(cube.rows),
                                          static_cast<std::size_t>(cube.columns),
                                          static_cast<std::size_t>(cube.bins)};
  const double width_ps = cube.bin_width * 1e12;
  if (output_kind(options.out) == OutputKind::kNpy) {
    write_npy(options.out, shape, cube.counts);
  } else {
    NpzWriter writer(options.out);
    writer.add("histograms", shape, std::span(cube.counts));
    writer.add(std::string(kBinWidthName), std::vector<std::size_t>{}, std::span(&width_ps, 1));
    if (!cube.true_distance.empty()) {
      writer.add("true_distance_m", std::span(shape).first(2), std::span(cube.true_distance));
    }
    writer.commit();
  }
  return fmt::format("{}: histograms of {} rows, {} columns and {} bins of {:g} ps{}", description, cube.rows,
                     cube.columns, cube.bins, width_ps,
                     counted.outside == 0 ? "" : fmt::format("; {} photons are outside", counted.outside));
}

/// A time in ps, of a unit: a whole number where the unit is one.
class Picoseconds {
 public:
  explicit Picoseconds(double unit_ps)
      : unit_ps_(unit_ps),
        whole_(static_cast<std::uint64_t>(unit_ps)),
        is_whole_(static_cast<double>(whole_) == unit_ps) {}

  void append(fmt::memory_buffer& line, std::uint64_t time) const {
    if (is_whole_) {
      fmt::format_to(std::back_inserter(line), "{}\n", time * whole_);
    } else {
      fmt::format_to(std::back_inserter(line), "{}\n", static_cast<double>(time) * unit_ps_);
    }
  }

 private:
  double unit_ps_;
  std::uint64_t whole_;
  bool is_whole_;
};

/// Time tags one by one, as they stand in the file.
std::string convert_picoquant_events(const ConversionOptions& options, const std::filesystem::path& path,
                                     const std::string& contents) {
  const auto tags = contents.empty() ? std::make_unique<PicoquantFile>(path)
                                     : std::make_unique<PicoquantFile>(path, contents);
  const PicoquantHeader& header = tags->header();
  AtomicFile out(options.out);
  const bool t3 = header.mode == 3;
  out.append(t3 ? "channel,sync,time_ps\n" : "channel,time_ps\n");
  const Picoseconds picoseconds(header.unit_ps);
  fmt::memory_buffer line;
  const PicoquantCount count = tags->read([&](const PicoquantEvent& event) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{},", event.channel);
    if (t3) {
      fmt::format_to(std::back_inserter(line), "{},", event.sync);
    }
    picoseconds.append(line, event.time);
    out.append({line.data(), line.size()});
  });
  out.commit();
  return picoquant_description(header, count);
}

std::string convert_photon_hdf5_events(const ConversionOptions& options, const std::filesystem::path& path) {
  const PhotonHdf5Header header = read_photon_hdf5_header(path);
  std::vector<Picoseconds> picoseconds;
  for (const PhotonHdf5Spot& spot : header.spots) {
    picoseconds.emplace_back(std::round(spot.tcspc_unit_s * 1e18) * 1e-6);
  }
  AtomicFile out(options.out);
  out.append("spot,detector,timestamp,time_ps\n");
  fmt::memory_buffer line;
  read_photon_hdf5(path, [&](const PhotonHdf5Event& photon) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{},{},{},", photon.spot, photon.detector, photon.timestamp);
    picoseconds.at(photon.spot).append(line, photon.nanotime);
    out.append({line.data(), line.size()});
  });
  out.commit();
  return photon_hdf5_description(header);
}

std::string convert_to_events(const ConversionOptions& options, const ConversionInput& input) {
  const std::filesystem::path path = parse_array_address(options.recording.file).file;
  return input.file.format == "picoquant" ? convert_picoquant_events(options, path, input.file.contents)
                                          : convert_photon_hdf5_events(options, path);
}

std::string convert_to_stream(const ConversionOptions& options, ConversionInput input) {
  const Recording recording = open_recording(options.recording, std::move(input.file));
  const StreamSource& source = *recording.source;
  std::string lost;
  if (const auto* const measured = dynamic_cast<const ResampledStream*>(&source)) {
    std::vector<int> columns(static_cast<std::size_t>(source.columns()));
    std::iota(columns.begin(), columns.end(), 0);
    lost = lost_photons_sentence(options.recording.file, measured->count_photons(columns, {0, source.rows()}),
                                 options.recording.resampling.integration_time);
  }
  write_stream_csv(options.out, source);
  return fmt::format("{}: a TDC stream of {} columns, {} rows and {} acquisitions{}{}", recording.description,
                     source.columns(), source.rows(), source.acquisitions(), lost.empty() ? "" : "; ", lost);
}

}  // namespace

OutputKind output_kind(const std::string& out) {
  const auto* const found =
      std::ranges::find_if(kEndings, [&](const OutputEnding& known) { return out.ends_with(known.ending); });
  if (found == kEndings.end()) {
    throw InputError(fmt::format(
        "{}: what to write follows from the name's ending: .png, .pfm, .ply, .pcd, .npy, .npz or .csv", out));
  }
  return found->kind;
}

ConversionInput open_conversion(const ConversionOptions& options) {
  constexpr std::size_t kMagic = 8;
  ConversionInput input;
  if (options.recording.format == "auto" &&
      starts_as_image(file_start(parse_array_address(options.recording.file).file, kMagic))) {
    input.kind = InputKind::kMap;
    return input;
  }
  input.file = read_recording(options.recording);
  const std::string& format = input.file.format;
  if (format == "picoquant" || format == "photon-hdf5") {
    input.kind = InputKind::kTimeTags;
  } else if (format == "npy" || format == "npz" ||
             ((format == "mat" || format == "hdf5") && !has_cells(options.recording, input.file))) {
    input.kind = InputKind::kArray;
  } else {
    input.kind = InputKind::kMeasurement;
  }
  return input;
}

std::string conversion_obstacle(InputKind input, OutputKind output) {
  const bool wants_distances = output == OutputKind::kMap || output == OutputKind::kPoints;
  if (wants_distances && (input == InputKind::kMeasurement || input == InputKind::kTimeTags)) {
    return "photons and histograms have no distances before they are read out: dtof replay does that";
  }
  if (output == OutputKind::kCsv && input == InputKind::kMap) {
    return "a map of distances is no TDC stream: dtof frame --depth makes photons of it";
  }
  return "";
}

std::string convert(const ConversionOptions& options, ConversionInput input) {
  const OutputKind output = output_kind(options.out);
  if (const std::string obstacle = conversion_obstacle(input.kind, output); !obstacle.empty()) {
    throw InputError(fmt::format("{}: {}", options.recording.file, obstacle));
  }
  if (output == OutputKind::kCsv) {
    return input.kind == InputKind::kTimeTags ? convert_to_events(options, input)
                                              : convert_to_stream(options, std::move(input));
  }
  const bool wants_map = output == OutputKind::kMap || output == OutputKind::kPoints ||
                         !options.confidence.empty() || !options.amplitude.empty() || options.metres_per_unit;
  if (input.kind == InputKind::kMap || (input.kind == InputKind::kArray && wants_map)) {
    return convert_map(options, input);
  }
  return input.kind == InputKind::kArray ? convert_array(options, input)
                                         : convert_to_histograms(options, input);
}

}  // namespace dtof
