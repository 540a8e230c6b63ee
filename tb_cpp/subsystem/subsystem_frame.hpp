// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "rtl/run_frame.hpp"

namespace dtof {

/// Reads out a frame with the Verilated subsystems that suit (find_subsystems), as run_frame_rtl does with an
/// array: the C driver (driver/dtof.h) sets it up through APB, starts it and unpacks its result stream;
/// source and sink never pause. Throws InputError as run_frame_rtl does, RtlError for an error that the
/// subsystem tells.
RtlSourceFrame run_frame_subsystem(const StreamSource& source, const ReadoutParameters& parameters,
                                   int threads = 0, std::span<const int> columns = {},
                                   Progress* progress = nullptr);

}  // namespace dtof
