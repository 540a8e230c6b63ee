// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dtof/io/array_reader.hpp"
#include "dtof/recording/histogram_stream.hpp"

namespace dtof {

/// Measured photon counts that stay in their file.
struct HistogramFile {
  HistogramCube cube = {};                        ///< without its counts
  std::shared_ptr<ArrayReader> counts = nullptr;  ///< can be read at any place
};

/// Makes it of an array as histogram_cube does. Throws InputError for a scalar, and for a histogram of more
/// than 2^27 bins.
HistogramFile histogram_file(std::shared_ptr<ArrayReader> counts, double bin_width, double offset,
                             const std::string& name);

/// Reads all counts into the cube. Throws InputError for more than 2^27, and as HistogramCube::validate does.
HistogramCube held_cube(HistogramFile file);

/// As HistogramStream, yet of counts that are read where they lie, pixel by pixel.
class HistogramFileStream final : public HistogramStream {
 public:
  /// Reads the whole file once and refuses what HistogramStream refuses, and a damaged file.
  HistogramFileStream(HistogramFile file, const Resampling& resampling);

 private:
  [[nodiscard]] std::span<const double> counts(int column, int row, std::vector<double>& room) const override;

  std::shared_ptr<const ArrayReader> counts_;
};

}  // namespace dtof
