// SPDX-License-Identifier: Apache-2.0
// Connects dtof_pool_pointer_array to stream_bench: the RTL alone; with the macro NETLIST the RTL and its netlist side by side; with
// NETLIST and NETLIST_ALONE the netlist alone.
module dtof_pool_pointer_array_bench #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 12,
    parameter int SRAM_NUM = 4,
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 7,
    parameter int GROUP_SIZE = 4,
    parameter int LABELS = 5,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 6,
    parameter int ADVANTAGE_WIDTH = 7,
    parameter int POINTER_SHIFT = 1,
    parameter int RIVAL_MOVES = 1,
    parameter int CELL_SHIFT = 9,
    parameter int PARITY = 0,
    parameter int TIME_GATE = 0,
    parameter int SECOND_TARGET = 0,
    parameter int AMPLITUDE = 0,
    parameter int PRIOR = 0,
    parameter int ENGINE_COLUMNS = 2,
    parameter int ACQ_WIDTH = 16,
    parameter int BROADCAST_STAGES = 2,
    parameter int FRAMES = 1,
    parameter int BEATS = 1,
    parameter int SEED = 1
);

  localparam int CONFIDENCE_WIDTH = dtof_pkg::pool_confidence_width(ADVANTAGE_WIDTH);
  // Second target, amplitude and ambient, which no vector has.
  localparam int RESULT_WIDTH = dtof_pkg::pool_result_width(ADVANTAGE_WIDTH, SECOND_TARGET)
      + dtof_pkg::pool_light_width(ADVANTAGE_WIDTH, AMPLITUDE);
  localparam int UNCHECKED_WIDTH = RESULT_WIDTH - 16 - CONFIDENCE_WIDTH;
  localparam int TDATA_WIDTH = dtof_pkg::index_width(SRAM_NUM) + dtof_pkg::index_width(PIXELS_PER_SRAM) + RESULT_WIDTH;

  // With TIME_GATE = 1: without the first and the last eighth of the range, as in dtof-vectors.
  localparam logic [NP-1:0] GATE_BEGIN = NP'(1 << (NP - 3));
  localparam logic [NP-1:0] GATE_END = NP'((1 << NP) - (1 << (NP - 3)));

`ifdef NETLIST
  localparam int COMPARE = 1;
`else
  localparam int COMPARE = 0;
`endif

  logic clk, rst_n, start, tdc_valid, result_tready;
  logic [ACQ_WIDTH-1:0] acq_num, coarse_end, track_end, settings;
  logic [SRAM_NUM*NP-1:0] tdc_timestamp;
  logic [TDATA_WIDTH+13:0] rtl, netlist;  // in the order of stream_bench

  // TEMPLATE is stable while an array is busy. In frames with a template entry i is 255 >> (i / 2).
  logic with_template_q;
  logic [dtof_pkg::POOL_COARSE_BINS*dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] coarse_template;

  always_ff @(posedge clk) begin
    if (start && !rtl[TDATA_WIDTH+7]) begin
      with_template_q <= settings[2];
    end
  end

  genvar i;
  generate
    for (i = 0; i < dtof_pkg::POOL_COARSE_BINS; i = i + 1) begin : g_template
      assign coarse_template[i*dtof_pkg::POOL_TEMPLATE_WIDTH+:dtof_pkg::POOL_TEMPLATE_WIDTH] =
          with_template_q ? dtof_pkg::POOL_TEMPLATE_WIDTH'(255 >> (i / 2)) : '0;
    end
  endgenerate

`ifndef NETLIST_ALONE
  dtof_pool_pointer_array #(
      .NP               (NP),
      .PIXELS_PER_SRAM  (PIXELS_PER_SRAM),
      .SRAM_NUM         (SRAM_NUM),
      .SLOTS            (SLOTS),
      .COUNT_WIDTH      (COUNT_WIDTH),
      .GROUP_SIZE       (GROUP_SIZE),
      .LABELS           (LABELS),
      .SCORE_BITS       (SCORE_BITS),
      .OFFSET_BITS      (OFFSET_BITS),
      .ADVANTAGE_WIDTH  (ADVANTAGE_WIDTH),
      .POINTER_SHIFT    (POINTER_SHIFT),
      .RIVAL_MOVES      (RIVAL_MOVES),
      .CELL_SHIFT       (CELL_SHIFT),
      .PARITY           (PARITY),
      .TIME_GATE        (TIME_GATE),
      .SECOND_TARGET    (SECOND_TARGET),
      .AMPLITUDE        (AMPLITUDE),
      .PRIOR            (PRIOR),
      .ENGINE_COLUMNS   (ENGINE_COLUMNS),
      .ACQ_WIDTH        (ACQ_WIDTH),
      .BROADCAST_STAGES(BROADCAST_STAGES)
  ) u_rtl (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .sram_cfg_i     (start),
      .start_i        (start),
      .acq_num_i      (acq_num),
      .gate_begin_i   (GATE_BEGIN),
      .gate_end_i     (GATE_END),
      .coarse_end_i   (coarse_end),
      .track_end_i    (track_end),
      .smooth_i       (settings[0]),
      .prior_i        (settings[1]),
      .template_i     (coarse_template),
      .busy_o         (rtl[TDATA_WIDTH+7]),
      .done_o         (rtl[TDATA_WIDTH+6]),
      .state_o        (rtl[TDATA_WIDTH+3+:3]),
      .error_o        (rtl[TDATA_WIDTH+9+:3]),
      .parity_error_o (rtl[TDATA_WIDTH+13]),
      .sram_cfg_o     (rtl[TDATA_WIDTH+8+:1]),
      .tdc_valid_i    (tdc_valid),
      .tdc_ready_o    (rtl[TDATA_WIDTH+2]),
      .tdc_timestamp_i(tdc_timestamp),
      .result_tvalid_o(rtl[TDATA_WIDTH+1]),
      .result_tready_i(result_tready),
      .result_tdata_o (rtl[TDATA_WIDTH-1:0]),
      .result_tlast_o (rtl[TDATA_WIDTH])
  );
  assign rtl[TDATA_WIDTH+12] = 1'b0;  // only dtof_array has counter_full_o
`endif

`ifdef NETLIST
  dtof_pool_pointer_array_netlist u_netlist (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .sram_cfg_i     (start),
      .start_i        (start),
      .acq_num_i      (acq_num),
      .gate_begin_i   (GATE_BEGIN),
      .gate_end_i     (GATE_END),
      .coarse_end_i   (coarse_end),
      .track_end_i    (track_end),
      .smooth_i       (settings[0]),
      .prior_i        (settings[1]),
      .template_i     (coarse_template),
      .busy_o         (netlist[TDATA_WIDTH+7]),
      .done_o         (netlist[TDATA_WIDTH+6]),
      .state_o        (netlist[TDATA_WIDTH+3+:3]),
      .error_o        (netlist[TDATA_WIDTH+9+:3]),
      .parity_error_o (netlist[TDATA_WIDTH+13]),
      .sram_cfg_o     (netlist[TDATA_WIDTH+8+:1]),
      .tdc_valid_i    (tdc_valid),
      .tdc_ready_o    (netlist[TDATA_WIDTH+2]),
      .tdc_timestamp_i(tdc_timestamp),
      .result_tvalid_o(netlist[TDATA_WIDTH+1]),
      .result_tready_i(result_tready),
      .result_tdata_o (netlist[TDATA_WIDTH-1:0]),
      .result_tlast_o (netlist[TDATA_WIDTH])
  );
  assign netlist[TDATA_WIDTH+12] = 1'b0;
`ifdef NETLIST_ALONE
  assign rtl = netlist;
`endif
`else
  assign netlist = rtl;
`endif

  stream_bench #(
      .NP              (NP),
      .PIXELS_PER_SRAM (PIXELS_PER_SRAM),
      .SRAM_NUM        (SRAM_NUM),
      .SLOTS           (SLOTS),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .FRACTION_BITS   (16 - NP),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .UNCHECKED_WIDTH (UNCHECKED_WIDTH),
      .TURNS           ((SRAM_NUM < ENGINE_COLUMNS) ? SRAM_NUM : ENGINE_COLUMNS),
      .COMPARE         (COMPARE),
      .FRAMES          (FRAMES),
      .BEATS           (BEATS),
      .SEED            (SEED)
  ) u_bench (
      .clk_o          (clk),
      .rst_no         (rst_n),
      .start_o        (start),
      .acq_num_o      (acq_num),
      .setting_0_o    (coarse_end),
      .setting_1_o    (track_end),
      .setting_2_o    (settings),
      .tdc_valid_o    (tdc_valid),
      .tdc_timestamp_o(tdc_timestamp),
      .result_tready_o(result_tready),
      .rtl_i          (rtl),
      .netlist_i      (netlist)
  );

endmodule
