// SPDX-License-Identifier: Apache-2.0
// The ports of every column of dtof_array. scripts/generate.py copies the lines below into each column.
//
// A column has no state machine. The array's control gives all columns the same commands: in which clock a timestamp, a scan
// or a clear reaches which stage. A column uses the commands that its read-out needs; the array ties the others to zero. Clocks are named by the
// stage of a timestamp (T0: it is at the port) or of a scan (S0: an address is read).
//
// Beside its histograms a column may keep one word a pixel (a pointer, a coarse peak, the best peak so far); readouts.toml
// says when it is read. The rules between these ports are assertions: hdl/thesis/dtof_column_rules.sv.

    input  logic                    clk_i,
    input  logic                    rst_ni,                   // of assertions and the chain of full counters alone
    // side band of the SRAM macros, which the technology folder gives a meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // timestamp
    input  logic [          NP-1:0] timestamp_i,              // BROADCAST_STAGES before T0; all ones: no detection
    input  logic [          NP-1:0] gate_begin_i,             // time gate, the same for a whole frame
    input  logic [          NP-1:0] gate_end_i,
    // pass over the stream; it changes only while no timestamp is in the pipeline
    input  logic [  PASS_WIDTH-1:0] pass_i,                   // 0, 1, ...
    input  logic                    first_pass_i,
    input  logic                    final_pass_i,             // its scan gives the result; low in M4 of a raw frame of counts
                                                              // that are older than this pass
    // where the timestamps are
    input  logic                    beat_t1_i,                // the timestamp of T0 belongs to an acquisition
    input  logic [             3:1] same_pixel_t3_i,          // [d]: the timestamp d clocks ahead is of the same pixel
    input  logic                    beat_t5_i,                // a timestamp is at T5
    // histogram: read at T2 or S0, written at T5 or cleared at S1
    input  logic                    scan_s0_i,                // read for the scan
    input  logic [   BIN_WIDTH-1:0] scan_bin_s0_i,
    input  logic [   ROW_WIDTH-1:0] histogram_read_pixel_i,   // pixel of T2, or of S0 with scan_s0_i
    input  logic                    clear_s1_i,               // clear what was read
    input  logic [   BIN_WIDTH-1:0] clear_bin_s1_i,
    input  logic [   ROW_WIDTH-1:0] histogram_write_pixel_i,  // pixel of T5, or of S1 with clear_s1_i
    input  logic                    clear_all_i,              // before a histogram is built anew: nothing is frozen; signalled
                                                              // clear of the whole memory
    input  logic                    scan_s2_i,                // the count of bin_s2_i is known
    input  logic                    first_s2_i,               // ... and is the first of its pixel
    input  logic [  SCAN_WIDTH-1:0] bin_s2_i,                 // past the last bin: a clock of what follows the scan
    // word of a pixel: read, changed by timestamps, written; or set
    input  logic                    word_read_i,              // ahead of the pixel's timestamps, or for its scan
    input  logic [   ROW_WIDTH-1:0] word_read_pixel_i,
    input  logic                    word_read_done_i,         // word_read_i one clock later
    input  logic                    first_slot_t0_i,          // first slot of a pixel, also between acquisitions
    input  logic                    visit_t1_i,               // the timestamp at T1 is the first of its pixel's visit
    input  logic                    first_acq_t1_i,           // ... and in the first acquisition of the pass
    input  logic                    word_write_i,             // the word behind them: last slot of a pixel at T2
    input  logic [   ROW_WIDTH-1:0] word_write_pixel_i,
    input  logic [  STEP_WIDTH-1:0] step_t0_i,                // step of a pointer in units of its last fractional bit
    input  logic                    word_set_i,               // the word before the timestamps: in RESET, or S3 of M1
    input  logic [   ROW_WIDTH-1:0] word_set_pixel_i,
    // result chain
    input  logic                    result_load_i,            // S3 of M4: the result of the pixel is known
    input  logic                    result_shift_i,           // take the next column's, never while loading
    input  logic [RESULT_WIDTH-1:0] next_column_i,
    output logic [RESULT_WIDTH-1:0] result_o,                 // {code, fraction, confidence}
    // chain of full counters, of read-outs with a histogram
    input  logic                    next_counter_full_i,
    output logic                    counter_full_o            // a counter of this column, or of one behind it, got full
