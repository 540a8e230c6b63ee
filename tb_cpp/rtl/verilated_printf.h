// SPDX-License-Identifier: Apache-2.0
// Force-included into Verilator's runtime: what the RTL prints goes through rtl/verilated_hooks.cpp.
#pragma once

void dtof_verilated_printf(const char* format, ...) __attribute__((format(printf, 1, 2)));
