// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "small_arrays/models/intensity_image.hpp"
#include "small_arrays/models/spot_grid.hpp"

namespace dtof {

/// What a small array measured.
struct SmallMap {
  SpotGrid grid;
  std::vector<double> distance_m;  ///< [small row][small column]
  std::vector<double> confidence;  ///< on the read-out's own scale; the same size

  [[nodiscard]] double distance(int column, int row) const {
    return distance_m[static_cast<std::size_t>(row) * grid.x.size() + static_cast<std::size_t>(column)];
  }
};

// Enlargers: distances of the large array's pixels, [row][column]. All throw InputError for maps or images
// whose sizes do not fit together.

/// That of the nearest spot, the left or upper one of two.
std::vector<double> enlarge_nearest(const SmallMap& map);

/// Linear between the spots to the left and right and those above and below; beyond the outermost spots, that
/// of the border.
std::vector<double> enlarge_bilinear(const SmallMap& map);

/// Widths of the joint bilateral filter.
struct JointBilateral {
  double spatial = 0.5;  ///< sigma of the distance between pixel and spot, in the spots' mean spacing
  double range = 0.1;    ///< sigma of the difference of brightness (intensity_image.hpp)
};

/// Joint bilateral upsampling (Kopf, Cohen, Lischinski and Uyttendaele, SIGGRAPH 2007): the mean of the 5 x 5
/// spots around the nearest one, weighted by a Gaussian of the distance to the spot and one of the difference
/// of brightness between the pixel and the spot. A pixel whose weights all vanish takes the nearest spot.
std::vector<double> enlarge_joint_bilateral(const SmallMap& map, const IntensityImage& image,
                                            const JointBilateral& widths);

/// Throws InputError unless the map's vectors have the grid's size.
void check_small_map(const SmallMap& map);
/// Throws InputError unless the image has the size of the map's large array.
void check_image(const SmallMap& map, const IntensityImage& image);

}  // namespace dtof
