// SPDX-License-Identifier: Apache-2.0
// In front of the C++ that Verilator wrote for the clocks of a model (cmake/unity.cmake): an assertion that
// holds costs a comparison. Verilator 5.006 writes a printing, a division for the time and a stop behind
// each, and expects it to fail; with the asserted columns inlined, that is half of a model's code.
#pragma once

#include <verilated.h>

/// What a failed assertion calls: throws RtlError with the text of the assertion (rtl/verilated_hooks.cpp).
/// `format` is Verilator's, for the time and `name`, that of the model, which stands in it twice.
[[noreturn, gnu::cold]] void dtof_assertion_failed(const char* format, const char* name);

// What VL_WRITEF is there. Nothing else is printed, and DTOF_ASSERT (hdl/package/dtof_macros.svh) has just
// these arguments.
#define DTOF_PRINT_FAILED_ASSERTION(format, time_bits, time, time_unit, name, same_name) \
  dtof_assertion_failed(format, name)

// Written in front of failed assertions alone.
#undef VL_LIKELY
#define VL_LIKELY(condition) __builtin_expect(!!(condition), 0)
