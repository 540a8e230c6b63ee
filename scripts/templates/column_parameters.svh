// SPDX-License-Identifier: Apache-2.0
// Parameters of every column of dtof_array, with the names of the array's parameters. scripts/generate.py copies the lines below into
// each column. A column ignores parameters that its read-out does not use. Limits: hdl/lint/parameter_limits.csv.

    parameter int READOUT = dtof_pkg::READOUT_SIFH,  // read-out, of those that this column implements
    parameter int NP = 10,               // bits of a timestamp
    parameter int NB = 5,                // bits of the coarse index
    parameter int PIXELS_PER_SRAM = 160,  // pixels of the column
    parameter int SLOTS = 2,             // timestamps per pixel and acquisition
    parameter int COUNT_WIDTH = 10,      // bits of a histogram bin
    parameter int POINTER_STEP = 1,      // bins that a pointer moves
    parameter int FRACTION_BITS = 0,     // fractional bits of a pointer
    parameter int CONFIDENCE_WIDTH = 4,  // bits of a pointer's confidence, 0 for none
    parameter int GUARD = 46,            // hisPointer v2: window beyond half a coarse bin
    parameter int WINDOW_CENTRED = 0,    // SiFH: 1 centres the window on the coarse bin
    parameter int POINTER_PORTS = 2,     // ports of an SRAM whose words timestamps change
    parameter int SIGNALLED_CLEAR = 0,   // 1: a status bit per address replaces clearing
    parameter int PARITY = 0,            // 1: each word of the SRAMs has a parity bit
    parameter int TIME_GATE = 0,         // 1: timestamps outside [gate_begin_i, gate_end_i) are no detections
    parameter int RAW_HISTOGRAM = 0,     // 1: M4 may scan single bins, whose code and count are the result
    parameter int BROADCAST_STAGES = 2,  // clocks from the array's control to the column; timestamps are delayed as much
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int BIN_WIDTH = dtof_pkg::bin_width(READOUT, NP, NB),  // log2 of a pixel's bins
    localparam int SCAN_WIDTH = dtof_pkg::scan_address_width(READOUT, NP, NB, FRACTION_BITS),
    localparam int PASS_WIDTH = dtof_pkg::index_width(dtof_pkg::coarse_passes(READOUT, NP, NB) + 1),
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, dtof_pkg::fraction_width(READOUT, FRACTION_BITS)),
    localparam int KEPT_CONFIDENCE_WIDTH = dtof_pkg::kept_confidence_width(CONFIDENCE_WIDTH, COUNT_WIDTH, RAW_HISTOGRAM),
    localparam int RESULT_WIDTH = dtof_pkg::result_width(READOUT, NP, COUNT_WIDTH, FRACTION_BITS, KEPT_CONFIDENCE_WIDTH)
