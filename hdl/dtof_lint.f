// SPDX-License-Identifier: Apache-2.0
// Lint waivers for Verilator, in front of dtof.f: verilator --lint-only -Wall -f dtof_lint.f -f dtof.f
lint/verilator.vlt
