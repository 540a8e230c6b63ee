// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace dtof::python {

// Each adds the classes and functions of its topic to the module. A class must be added before a function
// whose signature names it.
void bind_sensors(pybind11::module_& module);
void bind_scenes(pybind11::module_& module);
void bind_photons(pybind11::module_& module);
void bind_readouts(pybind11::module_& module);
void bind_engine(pybind11::module_& module);
void bind_frames(pybind11::module_& module);
void bind_rivals(pybind11::module_& module);
void bind_metrics(pybind11::module_& module);
void bind_recordings(pybind11::module_& module);

}  // namespace dtof::python
