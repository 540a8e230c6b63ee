// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "dtof/io/point_cloud.hpp"
#include "dtof/recording/recording.hpp"

namespace dtof {

/// What a file holds, as far as a conversion goes.
enum class InputKind {
  kMap,          ///< PNG, PFM: distances
  kArray,        ///< NPY, NPZ, HDF5, numbers of MAT: a map or histograms, which their shape does not tell
  kMeasurement,  ///< TDC stream, photon times, histograms of a sensor
  kTimeTags      ///< PTU, HT3
};

/// What a file becomes, by its name's ending.
enum class OutputKind {
  kMap,     ///< .png, .pfm
  kPoints,  ///< .ply, .pcd
  kNpy,     ///< .npy
  kNpz,     ///< .npz
  kCsv      ///< .csv: a TDC stream, of time tags their events
};

struct ConversionOptions {
  std::string out = {};
  RecordingOptions recording = {};                       ///< `file` is the input
  std::optional<double> metres_per_unit = std::nullopt;  ///< of a map; none: as read_depth_image has it
  std::string confidence =
      {};  ///< a file with the confidence of each pixel; empty: none, or the archive's own
  std::string amplitude = {};              ///< likewise
  double degrees_per_pixel = kPixelAngle;  ///< of a point cloud
  bool text = false;                       ///< a point cloud as text
};

/// A file that has been looked at.
struct ConversionInput {
  InputKind kind = InputKind::kArray;
  RecordingFile file = {};  ///< of a map: nothing, it is read when it is converted
};

/// Throws InputError for a name that ends with none of the endings.
OutputKind output_kind(const std::string& out);

/// Reads the input (pieces of what is read in pieces) and finds out what it is. Throws InputError.
ConversionInput open_conversion(const ConversionOptions& options);

/// Why such an input cannot become such an output; empty if it can.
std::string conversion_obstacle(InputKind input, OutputKind output);

/// Writes `options.out`, which appears whole or not at all. Returns a sentence on what is in the file. Throws
/// InputError "<file>: <reason>".
std::string convert(const ConversionOptions& options, ConversionInput input);

}  // namespace dtof
