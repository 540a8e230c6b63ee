// SPDX-License-Identifier: Apache-2.0
// Runs Verilator's model of a bench up to its $finish. Replaces --main of Verilator 5.006, which would be
// compiled into every hierarchy block, too.
#include "Vfull_bench.h"
#include "verilated.h"

int main(int argc, char** argv) {
  VerilatedContext context;
  context.commandArgs(argc, argv);
  Vfull_bench bench(&context);
  while (!context.gotFinish()) {
    bench.eval();
    if (!bench.eventsPending()) {
      break;
    }
    context.time(bench.nextTimeSlot());
  }
  bench.final();
  return 0;
}
