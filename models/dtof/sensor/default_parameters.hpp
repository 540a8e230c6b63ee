// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// CELL_SHIFT of the pool read-outs for a pulse of this FWHM: 8 below 0.75 coarse bins, 10 from 2.25, else 9.
int pool_cell_shift(double fwhm_coarse_bins);

/// ReadoutParameters::defaults, adapted to the sensor: NP and SLOTS, hisPointer's GUARD = ceil(FWHM / T_res),
/// and the pool read-outs' CELL_SHIFT.
ReadoutParameters default_parameters(Readout readout, const SensorModel& sensor);
/// From what default_parameters takes a parameter, for help texts, e.g. "the sensor's".
std::string_view default_source(std::string_view parameter);

}  // namespace dtof
