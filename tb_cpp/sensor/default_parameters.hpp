// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parameters.hpp"
#include "photon/sensor_model.hpp"

namespace dtof {

/// ReadoutParameters::defaults with the sensor's NP and SLOTS, and hisPointer's GUARD for its pulse:
/// ceil(FWHM / T_res).
ReadoutParameters default_parameters(Readout readout, const SensorModel& sensor);

}  // namespace dtof
