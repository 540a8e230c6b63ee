// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace dtof {

/// Filters the depth map of a frame in place with the driver's host filter (driver/dtof_filter.c,
/// docs/reference/accuracy.md), whose settings are the same for every read-out.
///
/// `metres` has the map row by row, `columns` pixels a row. NaN means that a pixel has no distance; the
/// filter may give it its neighbours' one. Negative distances count as 0, and results are multiples of 0.1
/// mm. `confidences` has a value for each pixel, or is empty: all pixels then have the same weight. `pulse_m`
/// is the full width at half maximum of the laser's pulse as a distance (half the way of light). Throws
/// InputError for a map that is empty or not rectangular, too many rows or columns for the driver, as many
/// confidences as do not fit, or a pulse that is not above 0.
void filter_depth(std::span<double> metres, std::span<const std::uint16_t> confidences, int columns,
                  double pulse_m);

/// Confidences as the filter takes them. Whole numbers from 0 to 65535 stay as they are. If there is another
/// number, all are scaled to a mean of 1024, and clipped to this range. The filter uses only the ratio of a
/// confidence to the mean.
std::vector<std::uint16_t> filter_confidences(std::span<const double> confidences);

/// Full width at half maximum of a pulse as a distance, m.
double pulse_distance_m(double fwhm_s);

}  // namespace dtof
