// SPDX-License-Identifier: Apache-2.0
// Runs example_bench with the concurrent assertions of hdl/assertions and writes how often each cover was met
// (scripts/tests/test_assertions.py has the command). Usage: example_bench COVERAGE_FILE
#include <verilated.h>
#include <verilated_cov.h>

#include <memory>

#include "Vexample_bench.h"

int main(int argc, char** argv) {
  VerilatedContext context;
  context.commandArgs(argc - 1, argv);  // the last one is not the simulation's
  const auto bench = std::make_unique<Vexample_bench>(&context);
  while (!context.gotFinish()) {
    bench->eval();
    if (!bench->eventsPending()) {
      break;
    }
    context.time(bench->nextTimeSlot());
  }
  bench->final();
  context.coveragep()->write(argv[argc - 1]);
  return 0;
}
