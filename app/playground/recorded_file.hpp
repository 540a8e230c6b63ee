// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "dtof/core/detection.hpp"
#include "dtof/recording/resampling.hpp"
#include "playground/session.hpp"

namespace dtof {

/// What the page must know of a recording before it runs: "<format>\t<drawn>\t<width>". Format: one of
/// kRecordingFormats. Drawn: 1 if photons are drawn from the file, 0 for a TDC stream. Width of the bins:
/// "no", the file has it; "may", the file may lack it; "must", the file lacks it. Empty for a file that is no
/// recording. Throws InputError for HDF5, which a page cannot read.
std::string playground_recording_line(const PlaygroundFiles& files);

/// The recording as `dtof replay` reads it, from contents that are unpacked. Throws InputError, also if
/// photons were measured, but none of them within T_int.
std::unique_ptr<StreamSource> open_recorded_file(const PlaygroundFiles& files, const Resampling& resampling);

}  // namespace dtof
