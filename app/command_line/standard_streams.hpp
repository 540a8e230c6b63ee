// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace dtof {

/// Takes the place of standard streams that are closed, so that no file gets their numbers: what is written
/// to standard error is dropped, and writing to standard output fails.
void open_closed_streams();

/// Writes what waits for standard output; returns why not all of the output was written, or nothing.
std::string flush_standard_output();

/// Writes a line to standard error, if somebody reads there.
void print_error_line(const std::string& line) noexcept;

}  // namespace dtof
