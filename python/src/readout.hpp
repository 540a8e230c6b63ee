// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof::python {

/// A Readout, or a name, whose parameters then follow from the sensor. Throws InputError for an unknown name.
ReadoutParameters to_readout(const pybind11::handle& readout, const SensorModel& sensor);

}  // namespace dtof::python
