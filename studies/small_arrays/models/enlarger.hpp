// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "small_arrays/models/intensity_image.hpp"
#include "small_arrays/models/spot_grid.hpp"

namespace dtof {

/// Distances and confidences that a small array measured.
struct SmallMap {
  SpotGrid grid;
  std::vector<double> distance_m;  ///< [small row][small column]
  std::vector<double> confidence;  ///< [small row][small column], on the read-out's own scale

  [[nodiscard]] double distance(int column, int row) const {
    return distance_m[static_cast<std::size_t>(row) * grid.x.size() + static_cast<std::size_t>(column)];
  }
};

// Enlargers compute a distance in m for each pixel of the large array, [row][column]. All throw InputError
// for maps or images whose sizes do not match.

/// Takes the distance of the nearest spot; of two equally near spots the left or upper one.
std::vector<double> enlarge_nearest(const SmallMap& map);

/// Interpolates linearly between the neighbouring spots in both directions. Beyond the outermost spots the
/// border's distance continues.
std::vector<double> enlarge_bilinear(const SmallMap& map);

/// Widths of the joint bilateral filter.
struct JointBilateral {
  /// Sigma of the distance between pixel and spot, in units of the spots' mean spacing.
  double spatial = 0.5;
  double range = 0.1;  ///< sigma of the difference in brightness (intensity_image.hpp)
};

/// Joint bilateral upsampling (Kopf, Cohen, Lischinski and Uyttendaele, SIGGRAPH 2007). The result is the
/// mean of the 5 x 5 spots around the nearest one. Weights are a Gaussian of the distance to the spot times a
/// Gaussian of the difference in brightness between pixel and spot. If all weights of a pixel vanish, it
/// takes the nearest spot.
std::vector<double> enlarge_joint_bilateral(const SmallMap& map, const IntensityImage& image,
                                            const JointBilateral& widths);

/// Throws InputError unless the map's vectors have the size of its grid.
void check_small_map(const SmallMap& map);
/// Throws InputError unless the image has the size of the map's large array.
void check_image(const SmallMap& map, const IntensityImage& image);

}  // namespace dtof
