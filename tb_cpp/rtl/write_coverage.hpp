// SPDX-License-Identifier: Apache-2.0
#pragma once

class VerilatedContext;

namespace dtof {

/// Built for coverage (DTOF_COVERAGE of CMake): writes how often each line of the RTL ran and each bit
/// toggled in this context as a file of its own in the folder DTOF_RTL_COVERAGE. Otherwise nothing.
void write_coverage(VerilatedContext& context);

}  // namespace dtof
