// SPDX-License-Identifier: Apache-2.0
// The array of a read-out behind its clock gate (dtof_clock_gate of the technology folder).
//
// The array's clock is stopped between frames and, while waits_i is high, inside an acquisition. In a reset the clock runs, so that the pipelines
// hold no data from before. While the gate suppresses a clock edge, the array's outputs have no effect: they are still there in the next clock. If
// the gate does not work, the array's assertion a_contiguous_acquisition fails.
//
// READOUT selects the read-out: dtof_pkg::READOUT_*. READOUT_POOLPOINTER is dtof_pool_pointer_array, all others are dtof_array. The time gate is
// in dtof_line_filter.
// Latency: that of the array.
// Cost: the array, a clock gate.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_gated_array #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,
    // parameters of the arrays: written by scripts/generate.py from readouts.toml
    // verilator lint_off UNUSEDPARAM
    parameter int NP = 10,                        // bits of a TDC timestamp
    // bits of the coarse histogram index
    parameter int NB = (READOUT == dtof_pkg::READOUT_SIFH) ? (NP / 2) + 1
        : (READOUT == dtof_pkg::READOUT_PIFH) ? dtof_pkg::min_of(NP, 6)
        : (READOUT == dtof_pkg::READOUT_HISTOGRAM) ? NP
        : (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(NP, 5)
        : NP / 2,
    parameter int PIXELS_PER_SRAM = 160,          // pixels a column serves
    parameter int SRAM_NUM = 200,                 // columns working in parallel
    parameter int SLOTS = 2,                      // timestamps per pixel and acquisition
    // bits of a histogram bin's counter, which never wraps
    parameter int COUNT_WIDTH = (READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 7
        : 10,
    parameter int POINTER_STEP = 1,               // bins a pointer moves per timestamp
    // fractional bits of the pointer
    parameter int FRACTION_BITS = (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(2, (16 - NP))
        : 0,
    parameter int CONFIDENCE_WIDTH = 4,           // bits of a pointer's confidence, 0 for none
    parameter int GUARD = ((2 << NP) + 44) / 45,  // hisPointer: codes by which the window is wider than half a coarse bin on either side; default: a FWHM of 2 ns in a range of 45 ns
    parameter int WINDOW_CENTRED = 0,             // SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5
    parameter int POINTER_PORTS = 2,              // ports of the pointer SRAM; with 1 its cells have half the area
    parameter int SIGNALLED_CLEAR = 0,            // 1: one status bit for each address instead of clearing the SRAM
    parameter int PARITY = 0,                     // 1: each word of the SRAMs has a parity bit, which is checked at each read
    parameter int RAW_HISTOGRAM = 0,              // 1: a frame may send histograms instead of results (`raw_i`)
    parameter int ACQ_WIDTH = 16,                 // bits of the run-time number of acquisitions
    parameter int BROADCAST_STAGES = 2,           // registers between the control and the columns; they add delay and change no result
    parameter int GROUP_SIZE = 4,                 // rows of a group, which shares a coarse histogram
    parameter int LABELS = 5,                     // candidates of a group
    parameter int SCORE_BITS = 4,                 // bits of a candidate's score
    parameter int OFFSET_BITS = 6,                // bits of a leader's offset in the track phase, 0 for none
    parameter int ADVANTAGE_WIDTH = 7,            // bits of the leader's advantage
    parameter int POINTER_SHIFT = 1,              // a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins
    parameter int RIVAL_MOVES = 1,                // 1: the rival has a pointer of its own
    parameter int CELL_SHIFT = 9,                 // windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25
    parameter int SECOND_TARGET = 0,              // 1: a result has the position of the label that lost, too
    parameter int AMPLITUDE = 0,                  // 1: a result has amplitude and ambient, too
    parameter int PRIOR = 0,                      // 1: candidates may begin from those that were used in the last frame (`prior_i`)
    parameter int ENGINE_COLUMNS = 34,            // columns that share an engine
    // verilator lint_on UNUSEDPARAM
    // end of parameters of the arrays
    parameter int CLOCK_WAITS = 0,  // by default what every technology can do: Yosys elaborates defaults, too
    parameter int RESULT_WIDTH = 32
) (
    input  logic                       clk_i,
    input  logic                       rst_ni,
    input  logic                       scan_mode_i,      // 1: the clock is never gated
    input  logic                       array_rst_ni,
    input  logic                       in_reset_i,       // the clock runs
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // frame, and its settings
    input  logic                       begin_i,
    input  logic [      ACQ_WIDTH-1:0] acquisitions_i,
    input  logic [      ACQ_WIDTH-1:0] coarse_end_i,     // from here to template_i: of poolPointer
    input  logic [      ACQ_WIDTH-1:0] track_end_i,
    input  logic                       smooth_i,
    input  logic                       prior_i,
    input  logic [              255:0] template_i,
    input  logic                       raw_i,            // raw_i, raw_first_i and raw_last_i: with RAW_HISTOGRAM
    input  logic [               11:0] raw_first_i,
    input  logic [               11:0] raw_last_i,
    output logic                       done_o,           // last clock of the frame
    output logic [                2:0] state_o,
    output logic                       counter_full_o,
    output logic                       parity_error_o,
    // lines
    input  logic                       waits_i,          // a line is late inside an acquisition
    input  logic                       line_valid_i,
    output logic                       line_ready_o,
    input  logic [    SRAM_NUM*NP-1:0] line_i,
    // results
    output logic                       result_tvalid_o,
    input  logic                       result_tready_i,
    output logic [   RESULT_WIDTH-1:0] result_tdata_o,
    output logic                       result_tlast_o
);

  localparam int POOL = (READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 1 : 0;
  localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM);

  logic array_clk, array_busy, array_done, array_counter_full, array_damaged, array_tvalid;
  logic [dtof_pkg::ERROR_WIDTH-1:0] array_error;

  dtof_clock_gate #(
      .NEEDED(CLOCK_WAITS)
  ) u_array_clock (
      .clk_i      (clk_i),
      .enable_i   (((begin_i || array_busy) && !waits_i) || in_reset_i),
      .scan_mode_i(scan_mode_i),
      .clk_o      (array_clk)
  );

  assign done_o = array_done && !waits_i;
  assign counter_full_o = array_counter_full && !waits_i;
  assign parity_error_o = array_damaged && !waits_i;
  assign result_tvalid_o = array_tvalid && !waits_i;

  generate
    if (POOL != 0) begin : g_pool
      logic unused_settings;
      assign unused_settings = ^{raw_i, raw_first_i, raw_last_i};
      assign array_counter_full = 1'b0;  // no event: sweeps make room in its coarse bins
      dtof_pool_pointer_array #(
          // parameters of dtof_pool_pointer_array: written by scripts/generate.py from readouts.toml
          .NP(NP),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM(SRAM_NUM),
          .SLOTS(SLOTS),
          .COUNT_WIDTH(COUNT_WIDTH),
          .GROUP_SIZE(GROUP_SIZE),
          .LABELS(LABELS),
          .SCORE_BITS(SCORE_BITS),
          .OFFSET_BITS(OFFSET_BITS),
          .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
          .POINTER_SHIFT(POINTER_SHIFT),
          .RIVAL_MOVES(RIVAL_MOVES),
          .CELL_SHIFT(CELL_SHIFT),
          .PARITY(PARITY),
          .SECOND_TARGET(SECOND_TARGET),
          .AMPLITUDE(AMPLITUDE),
          .PRIOR(PRIOR),
          .ENGINE_COLUMNS(ENGINE_COLUMNS),
          .ACQ_WIDTH(ACQ_WIDTH),
          .BROADCAST_STAGES(BROADCAST_STAGES)
          // end of parameters of dtof_pool_pointer_array
      ) u_array (
          .clk_i          (array_clk),
          .rst_ni         (array_rst_ni),
          .sram_cfg_i     (sram_cfg_i),
          .sram_cfg_o     (sram_cfg_o),
          .start_i        (begin_i),
          .acq_num_i      (acquisitions_i),
          .gate_begin_i   ({NP{1'b0}}),
          .gate_end_i     ({NP{1'b0}}),
          .coarse_end_i   (coarse_end_i),
          .track_end_i    (track_end_i),
          .smooth_i       (smooth_i),
          .prior_i        (prior_i),
          .template_i     (template_i),
          .busy_o         (array_busy),
          .done_o         (array_done),
          .state_o        (state_o),
          .error_o        (array_error),
          .parity_error_o (array_damaged),
          .tdc_valid_i    (line_valid_i),
          .tdc_ready_o    (line_ready_o),
          .tdc_timestamp_i(line_i),
          .result_tvalid_o(array_tvalid),
          .result_tready_i(result_tready_i),
          .result_tdata_o (result_tdata_o),
          .result_tlast_o (result_tlast_o)
      );
    end else begin : g_array
      logic unused_settings;
      assign unused_settings = ^{coarse_end_i, track_end_i, smooth_i, prior_i, template_i, raw_first_i, raw_last_i};
      dtof_array #(
          .READOUT(READOUT),
          // parameters of dtof_array: written by scripts/generate.py from readouts.toml
          .NP(NP),
          .NB(NB),
          .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
          .SRAM_NUM(SRAM_NUM),
          .SLOTS(SLOTS),
          .COUNT_WIDTH(COUNT_WIDTH),
          .POINTER_STEP(POINTER_STEP),
          .FRACTION_BITS(FRACTION_BITS),
          .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
          .GUARD(GUARD),
          .WINDOW_CENTRED(WINDOW_CENTRED),
          .POINTER_PORTS(POINTER_PORTS),
          .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
          .PARITY(PARITY),
          .RAW_HISTOGRAM(RAW_HISTOGRAM),
          .ACQ_WIDTH(ACQ_WIDTH),
          .BROADCAST_STAGES(BROADCAST_STAGES)
          // end of parameters of dtof_array
      ) u_array (
          .clk_i          (array_clk),
          .rst_ni         (array_rst_ni),
          .sram_cfg_i     (sram_cfg_i),
          .sram_cfg_o     (sram_cfg_o),
          .start_i        (begin_i),
          .acq_num_i      (acquisitions_i),
          .gate_begin_i   ({NP{1'b0}}),
          .gate_end_i     ({NP{1'b0}}),
          .raw_i          (raw_i),
          .raw_first_row_i(ROW_WIDTH'(raw_first_i)),
          .raw_last_row_i (ROW_WIDTH'(raw_last_i)),
          .busy_o         (array_busy),
          .done_o         (array_done),
          .state_o        (state_o),
          .error_o        (array_error),
          .counter_full_o (array_counter_full),
          .parity_error_o (array_damaged),
          .tdc_valid_i    (line_valid_i),
          .tdc_ready_o    (line_ready_o),
          .tdc_timestamp_i(line_i),
          .result_tvalid_o(array_tvalid),
          .result_tready_i(result_tready_i),
          .result_tdata_o (result_tdata_o),
          .result_tlast_o (result_tlast_o)
      );
    end
  endgenerate

  // The array cannot report an error: line buffer and frame control detect errors before and report them in the registers.
  `DTOF_ASSERT(a_no_array_error, array_error == '0 || waits_i, "the array met a master's error that should have been kept from it")

  `DTOF_ASSERT(a_begin_when_idle, !(begin_i && array_busy), "a frame begins while another is under way")

endmodule

`default_nettype wire
