// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace dtof {

/// Numbers beyond which the program and the Python module refuse a frame.

/// Largest number of laser pulses in a frame, because a column's detections are held in memory.
inline constexpr double kMostAcquisitions = 1048575;
inline constexpr double kMostKlux = 200.0;
/// Largest reflectivity for which the photon models are checked.
inline constexpr double kMostReflectivity = 4.0;

/// Ends of the sentence "<number> is not within <lowest> to ...": the largest number, and why.
std::string acquisitions_reason();
std::string klux_reason();
std::string reflectivity_reason();
/// "<value> is not within <lowest> to <reason>".
std::string not_within(std::string_view value, double lowest, std::string_view reason);

}  // namespace dtof
