// SPDX-License-Identifier: Apache-2.0
#pragma once

class VerilatedContext;

namespace dtof {

/// In builds for coverage (CMake option DTOF_COVERAGE): writes the number of runs of each RTL line and the
/// toggles of each bit to a new file in the folder DTOF_RTL_COVERAGE. Otherwise does nothing.
void write_coverage(VerilatedContext& context);

}  // namespace dtof
