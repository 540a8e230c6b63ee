// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/region.hpp"

namespace dtof::python {

/// The RTL of the read-outs for a region of `source`. Arrays are taken from the user's cache, after they are
/// built if necessary (on_demand/on_demand.hpp). The process has one such engine at a time: the call waits
/// until the engine of another thread is gone, and the engine must end in the thread that made it. Throws
/// InputError with one line if an array cannot be built, or if the module was built without Verilator
/// (no_rtl.cpp).
std::unique_ptr<FrameEngine> make_rtl_engine(const StreamSource& source,
                                             std::span<const ReadoutParameters> readouts,
                                             const Region& region, int threads, Progress::Observer observer);

}  // namespace dtof::python
