// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include <exception>

#include "dtof/core/error.hpp"
#include "src/bindings.hpp"

namespace {

/// Bad input is a ValueError with the library's sentence.
// NOLINTNEXTLINE(performance-unnecessary-value-param): the type that pybind11 calls
void translate(std::exception_ptr error) {
  try {
    if (error) {
      std::rethrow_exception(error);
    }
  } catch (const dtof::InputError& refusal) {
    PyErr_SetString(PyExc_ValueError, refusal.what());
  } catch (const dtof::Interrupted& interruption) {
    PyErr_SetString(PyExc_KeyboardInterrupt, interruption.what());
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The C++ library's bindings; import dtof instead.";
  module.attr("__version__") = DTOF_VERSION;
  pybind11::register_exception_translator(&translate);
  dtof::python::bind_sensors(module);
  dtof::python::bind_scenes(module);
  dtof::python::bind_photons(module);
  dtof::python::bind_readouts(module);
  dtof::python::bind_engine(module);
  dtof::python::bind_frames(module);
  dtof::python::bind_rivals(module);
  dtof::python::bind_metrics(module);
  dtof::python::bind_recordings(module);
}
