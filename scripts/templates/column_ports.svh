// SPDX-License-Identifier: Apache-2.0
// Ports of every column of dtof_array. scripts/generate.py copies the lines below into each column.
//
// A column has no state machine. The array's control gives all columns the same commands, each in the clock in which a timestamp, a scan
// or a clear reaches a stage. A column uses the commands that its read-out needs; the array ties the others to zero. A suffix names the
// stage of a timestamp (t0: its first clock in the column) or of a scan (s0: an address is read).
//
// Beside its histograms a column may have one word per pixel (a pointer, a coarse peak, the best peak so far); readouts.toml
// says when the word is read. Assertions check the rules between these ports: hdl/thesis/dtof_column_rules.sv.

    input  logic                    clk_i,
    input  logic                    rst_ni,                   // for assertions, the chains of events and the check of parity only
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // timestamp
    input  logic [          NP-1:0] timestamp_i,              // BROADCAST_STAGES clocks before T0; all ones: no detection
    input  logic [          NP-1:0] gate_begin_i,             // time gate, the same for a whole frame
    input  logic [          NP-1:0] gate_end_i,
    // pass over the stream, which changes only while no timestamp is in the pipeline
    input  logic [  PASS_WIDTH-1:0] pass_i,                   // number of the pass: 0, 1, ...
    input  logic                    first_pass_i,
    input  logic                    final_pass_i,             // the scan of this pass gives the result; low in M4 of a raw frame
                                                              // that shows the counts of an earlier pass
    // stages of the timestamps
    input  logic                    beat_t1_i,                // the timestamp at T1 belongs to an acquisition
    input  logic [             3:1] same_pixel_t3_i,          // [d]: the timestamp d clocks ahead is of the same pixel
    input  logic                    beat_t5_i,                // a timestamp is at T5
    // histogram: read at T2 or S0, written at T5 or cleared at S1
    input  logic                    scan_s0_i,                // read for a scan
    input  logic [   BIN_WIDTH-1:0] scan_bin_s0_i,
    input  logic [   ROW_WIDTH-1:0] histogram_read_pixel_i,   // pixel of T2, or of S0 with scan_s0_i
    input  logic                    clear_s1_i,               // clear the address that was read
    input  logic [   BIN_WIDTH-1:0] clear_bin_s1_i,
    input  logic [   ROW_WIDTH-1:0] histogram_write_pixel_i,  // pixel of T5, or of S1 with clear_s1_i
    input  logic                    clear_all_i,              // before a new histogram: clears all frozen flags and, with
                                                              // SIGNALLED_CLEAR = 1, all status bits
    input  logic                    scan_s2_i,                // the count of bin_s2_i is available
    input  logic                    first_s2_i,               // with scan_s2_i: first bin of its pixel
    input  logic [  SCAN_WIDTH-1:0] bin_s2_i,                 // beyond the last bin: a clock of the computation after the scan
    // word of a pixel: read, changed by timestamps, written; or set
    input  logic                    word_read_i,              // read before the pixel's timestamps, or for its scan
    input  logic [   ROW_WIDTH-1:0] word_read_pixel_i,
    input  logic                    word_read_done_i,         // word_read_i one clock later
    input  logic                    first_slot_t0_i,          // first slot of a pixel, also between acquisitions
    input  logic                    visit_t1_i,               // the timestamp at T1 is the first of its pixel's visit
    input  logic                    first_acq_t1_i,           // this visit is in the first acquisition of the pass
    input  logic                    word_write_i,             // write after the pixel's timestamps: last slot at T2
    input  logic [   ROW_WIDTH-1:0] word_write_pixel_i,
    input  logic [  STEP_WIDTH-1:0] step_t0_i,                // step of a pointer, in units of its lowest bit
    input  logic                    word_set_i,               // set before the timestamps: in RESET, or at S3 of M1
    input  logic [   ROW_WIDTH-1:0] word_set_pixel_i,
    // result chain
    input  logic                    result_load_i,            // S3 of M4: load the pixel's result
    input  logic                    result_shift_i,           // load the next column's result; never with result_load_i
    input  logic [RESULT_WIDTH-1:0] next_column_i,
    output logic [RESULT_WIDTH-1:0] result_o,                 // {code, fraction, confidence}
    // chain of full counters, in read-outs with a histogram
    input  logic                    next_counter_full_i,
    output logic                    counter_full_o,           // a counter of this column or of the chain before is full
    // chain of damaged words, with PARITY = 1
    input  logic                    next_parity_error_i,
    output logic                    parity_error_o            // a word that this column or the chain before has read is damaged
