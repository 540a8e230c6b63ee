// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace dtof {

/// Filters the depth map of a frame in place with the driver's host filter (driver/dtof_filter.c,
/// docs/reference/accuracy.md), whose settings are the same for every read-out.
///
/// `metres` has the map row by row, `columns` pixels a row. NaN means that a pixel has no distance; the
/// filter may give it its neighbours' one. Negative distances count as 0, and results are multiples of 0.1
/// mm. `pulse_m` is the full width at half maximum of the laser's pulse as a distance (half the way of
/// light). Throws InputError for a map that is empty or not rectangular, too many rows or columns for the
/// driver, or a pulse that is not above 0.
void filter_depth(std::span<double> metres, int columns, double pulse_m);

/// Full width at half maximum of a pulse as a distance, m.
double pulse_distance_m(double fwhm_s);

}  // namespace dtof
