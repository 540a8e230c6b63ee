// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "rtl/run_frame.hpp"

namespace dtof {

/// Reads out a frame with the Verilated subsystems of find_subsystems, as run_frame_rtl does with arrays. The
/// C driver (driver/dtof.h) configures a subsystem through its register bus, starts it and unpacks its result
/// stream. Source and sink never pause. Throws InputError as run_frame_rtl does, RtlError if the subsystem
/// reports an error.
RtlSourceFrame run_frame_subsystem(const StreamSource& source, const ReadoutParameters& parameters,
                                   int threads = 0, std::span<const int> columns = {},
                                   Progress* progress = nullptr);

}  // namespace dtof
