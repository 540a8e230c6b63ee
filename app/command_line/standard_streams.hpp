// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace dtof {

/// Opens substitutes for closed standard streams, so that no other file gets their numbers. Text for standard
/// error is then dropped; writing to standard output fails.
void open_closed_streams();

/// Flushes standard output. Returns why not all output was written; empty if it was.
std::string flush_standard_output();

/// Writes a line to standard error; ignores errors.
void print_error_line(const std::string& line) noexcept;

}  // namespace dtof
