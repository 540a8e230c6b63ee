// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "dtof/io/point_cloud.hpp"
#include "dtof/recording/recording.hpp"

namespace dtof {

/// Kind of an input file, as far as conversion is concerned.
enum class InputKind {
  kMap,          ///< PNG, PFM: distances
  kArray,        ///< NPY, NPZ, HDF5, numeric MAT: a map or histograms; the shape alone does not decide
  kMeasurement,  ///< TDC stream, photon times, histograms of a sensor
  kTimeTags      ///< PTU, HT3
};

/// Kind of the output file, by the ending of its name.
enum class OutputKind {
  kMap,     ///< .png, .pfm
  kPoints,  ///< .ply, .pcd
  kNpy,     ///< .npy
  kNpz,     ///< .npz
  kCsv      ///< .csv: a TDC stream; for time tags, their events
};

struct ConversionOptions {
  std::string out = {};
  RecordingOptions recording = {};  ///< `file` is the input
  /// Scale of a map; none: the default of read_depth_image.
  std::optional<double> metres_per_unit = std::nullopt;
  std::string confidence =
      {};  ///< a file with the confidence of each pixel; empty: none, or the archive's own
  std::string amplitude = {};  ///< file with each pixel's amplitude; empty: none, or the archive's own
  double degrees_per_pixel = kPixelAngle;  ///< for a point cloud
  bool text = false;                       ///< write a point cloud as text
};

/// An input file whose kind is known.
struct ConversionInput {
  InputKind kind = InputKind::kArray;
  RecordingFile file = {};  ///< contents; empty for a map, which is read during conversion
};

/// Kind by the ending of `out`. Throws InputError for an unknown ending.
OutputKind output_kind(const std::string& out);

/// Finds the kind of the input and reads it, except formats that are read in pieces. Throws InputError.
ConversionInput open_conversion(const ConversionOptions& options);

/// Why the input cannot be converted to this output; empty if it can.
std::string conversion_obstacle(InputKind input, OutputKind output);

/// Converts the input and writes `options.out`, which appears whole or not at all. Returns a sentence that
/// describes the file. Throws InputError "<file>: <reason>".
std::string convert(const ConversionOptions& options, ConversionInput input);

}  // namespace dtof
