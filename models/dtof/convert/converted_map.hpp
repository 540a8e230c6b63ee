// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/convert/conversion.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/npy.hpp"

namespace dtof {

/// Distances with what else is known of each pixel.
struct ConvertedMap {
  DepthImage depth;
  std::vector<PointField> fields;  ///< confidence, amplitude
};

/// Whether a file begins as a PNG or PFM does.
bool starts_as_image(std::string_view start);

/// The map of the input with the fields that the options name. An archive's map named depth_m or x_depth_m
/// brings the archive's confidence or x_confidence along, likewise amplitude. Throws InputError for a field
/// of another size than the map.
ConvertedMap read_converted_map(const ConversionOptions& options, const ConversionInput& input);

/// Writes a PNG or PFM of the distances.
void write_converted_map(const std::string& out, const DepthImage& depth);

}  // namespace dtof
