// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/convert/conversion.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/npy.hpp"

namespace dtof {

/// Distances and the other known values of each pixel.
struct ConvertedMap {
  DepthImage depth;
  std::vector<PointField> fields;  ///< confidence and amplitude, where known
};

/// True if `start` begins as a PNG or PFM file does.
bool starts_as_image(std::string_view start);

/// Reads the input's map and the fields that `options` name. An archive's map depth_m or x_depth_m brings
/// confidence or x_confidence from the same archive, likewise amplitude. Throws InputError if a field and the
/// map differ in size.
ConvertedMap read_converted_map(const ConversionOptions& options, const ConversionInput& input);

/// Writes the distances as PNG or PFM, by the ending of `out`. Returns what is lost; empty if nothing is.
/// Throws InputError if everything is.
std::string write_converted_map(const std::string& out, const DepthImage& depth);

}  // namespace dtof
