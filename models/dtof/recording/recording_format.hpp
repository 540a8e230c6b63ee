// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dtof {

/// Bytes of a file that tell its format. Before its first histogram a log may have the lines of the sensor's
/// start.
inline constexpr std::size_t kStartOfRecording = std::size_t{1} << 16U;

/// Format of a recording by its first bytes: one of kRecordingFormats (recording.hpp), or empty if they tell
/// none. HDF5 is not recognised.
std::string format_of_contents(std::string_view contents);

/// As format_of_contents, else by the ending of the name; empty for an unknown kind of file.
std::string find_recording_format(const std::string& name, std::string_view contents);

/// First character of a text that is no blank; a blank if there is none.
char first_character(std::string_view contents);

}  // namespace dtof
