// SPDX-License-Identifier: Apache-2.0
#include "rtl/write_coverage.hpp"

#if VM_COVERAGE
#include <fmt/format.h>
#include <unistd.h>
#include <verilated.h>
#include <verilated_cov.h>

#include <atomic>
#include <cstdlib>
#endif

namespace dtof {

void write_coverage([[maybe_unused]] VerilatedContext& context) {
#if VM_COVERAGE
  static std::atomic<int> files = 0;
  if (const char* folder = std::getenv("DTOF_RTL_COVERAGE"); folder != nullptr) {
    context.coveragep()->write(fmt::format("{}/{}_{}.dat", folder, getpid(), files++).c_str());
  }
#endif
}

}  // namespace dtof
