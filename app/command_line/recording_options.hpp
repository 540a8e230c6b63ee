// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "dtof/recording/recording.hpp"

namespace dtof {

/// Adds --format, --bin-width, --tick and --variable: how a recorded file is read.
void add_recording_options(CLI::App& command, RecordingOptions& recording,
                           std::optional<double>& bin_width_ps, double& tick_ps);

/// Throws InputError if one of these options was given and says nothing about a file of this format (one of
/// kRecordingFormats).
void refuse_recording_options(const CLI::App& command, const std::string& format);

}  // namespace dtof
