// SPDX-License-Identifier: Apache-2.0
// In the place of rtl_engine.cpp where the module was built without Verilator.
#include "dtof/core/error.hpp"
#include "src/rtl_engine.hpp"

namespace dtof::python {

std::unique_ptr<FrameEngine> make_rtl_engine(const StreamSource& /*source*/,
                                             std::span<const ReadoutParameters> /*readouts*/,
                                             const Region& /*region*/, int /*threads*/,
                                             Progress::Observer /*observer*/) {
  throw InputError(
      "engine: this module was built without RTL, because verilator was not installed (Debian package "
      "verilator); install it, and then the module again");
}

}  // namespace dtof::python
