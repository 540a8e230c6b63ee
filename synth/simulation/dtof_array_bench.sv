// SPDX-License-Identifier: Apache-2.0
// Connects dtof_array to stream_bench: the RTL alone; with the macro NETLIST the RTL and its netlist side by side; with NETLIST and
// NETLIST_ALONE the netlist alone.
module dtof_array_bench #(
    parameter int READOUT = 0,
    parameter int NP = 10,
    parameter int NB = 5,
    parameter int PIXELS_PER_SRAM = 3,
    parameter int SRAM_NUM = 2,
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 10,
    parameter int POINTER_STEP = 1,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 4,
    parameter int GUARD = 46,
    parameter int WINDOW_CENTRED = 0,
    parameter int POINTER_PORTS = 2,
    parameter int SIGNALLED_CLEAR = 0,
    parameter int PARITY = 0,
    parameter int TIME_GATE = 0,
    parameter int RAW_HISTOGRAM = 0,  // the vectors have results only; 1 widens the confidence
    parameter int ACQ_WIDTH = 16,
    parameter int BROADCAST_STAGES = 2,
    parameter int FRAMES = 1,
    parameter int BEATS = 1,
    parameter int SEED = 1
);

  localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM);
  localparam int KEPT_CONFIDENCE_WIDTH = dtof_pkg::kept_confidence_width(CONFIDENCE_WIDTH, COUNT_WIDTH, RAW_HISTOGRAM);
  localparam int TDATA_WIDTH = dtof_pkg::index_width(SRAM_NUM) + dtof_pkg::index_width(PIXELS_PER_SRAM)
      + dtof_pkg::result_width(READOUT, NP, COUNT_WIDTH, FRACTION_BITS, KEPT_CONFIDENCE_WIDTH);

`ifdef NETLIST
  localparam int COMPARE = 1;
`else
  localparam int COMPARE = 0;
`endif

  logic clk, rst_n, start, tdc_valid, result_tready;
  logic [ACQ_WIDTH-1:0] acq_num, gate_begin, gate_end;
  logic [SRAM_NUM*NP-1:0] tdc_timestamp;
  logic [TDATA_WIDTH+13:0] rtl, netlist;  // in the order of stream_bench

`ifndef NETLIST_ALONE
  dtof_array #(
      .READOUT         (READOUT),
      .NP              (NP),
      .NB              (NB),
      .PIXELS_PER_SRAM (PIXELS_PER_SRAM),
      .SRAM_NUM        (SRAM_NUM),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .POINTER_STEP    (POINTER_STEP),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .GUARD           (GUARD),
      .WINDOW_CENTRED  (WINDOW_CENTRED),
      .POINTER_PORTS   (POINTER_PORTS),
      .SIGNALLED_CLEAR (SIGNALLED_CLEAR),
      .PARITY          (PARITY),
      .TIME_GATE       (TIME_GATE),
      .RAW_HISTOGRAM   (RAW_HISTOGRAM),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .BROADCAST_STAGES(BROADCAST_STAGES)
  ) u_rtl (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .sram_cfg_i     (start),
      .start_i        (start),
      .acq_num_i      (acq_num),
      .gate_begin_i   (NP'(gate_begin)),
      .gate_end_i     (NP'(gate_end)),
      .raw_i          (1'b0),
      .raw_first_row_i({ROW_WIDTH{1'b1}}),  // illegal, but raw_i is low
      .raw_last_row_i ({ROW_WIDTH{1'b0}}),
      .busy_o         (rtl[TDATA_WIDTH+7]),
      .done_o         (rtl[TDATA_WIDTH+6]),
      .state_o        (rtl[TDATA_WIDTH+3+:3]),
      .error_o        (rtl[TDATA_WIDTH+9+:3]),
      .parity_error_o (rtl[TDATA_WIDTH+13]),
      .counter_full_o (rtl[TDATA_WIDTH+12]),
      .sram_cfg_o     (rtl[TDATA_WIDTH+8+:1]),
      .tdc_valid_i    (tdc_valid),
      .tdc_ready_o    (rtl[TDATA_WIDTH+2]),
      .tdc_timestamp_i(tdc_timestamp),
      .result_tvalid_o(rtl[TDATA_WIDTH+1]),
      .result_tready_i(result_tready),
      .result_tdata_o (rtl[TDATA_WIDTH-1:0]),
      .result_tlast_o (rtl[TDATA_WIDTH])
  );
`endif

`ifdef NETLIST
  dtof_array_netlist u_netlist (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .sram_cfg_i     (start),
      .start_i        (start),
      .acq_num_i      (acq_num),
      .gate_begin_i   (NP'(gate_begin)),
      .gate_end_i     (NP'(gate_end)),
      .raw_i          (1'b0),
      .raw_first_row_i({ROW_WIDTH{1'b1}}),  // illegal, but raw_i is low
      .raw_last_row_i ({ROW_WIDTH{1'b0}}),
      .busy_o         (netlist[TDATA_WIDTH+7]),
      .done_o         (netlist[TDATA_WIDTH+6]),
      .state_o        (netlist[TDATA_WIDTH+3+:3]),
      .error_o        (netlist[TDATA_WIDTH+9+:3]),
      .parity_error_o (netlist[TDATA_WIDTH+13]),
      .counter_full_o (netlist[TDATA_WIDTH+12]),
      .sram_cfg_o     (netlist[TDATA_WIDTH+8+:1]),
      .tdc_valid_i    (tdc_valid),
      .tdc_ready_o    (netlist[TDATA_WIDTH+2]),
      .tdc_timestamp_i(tdc_timestamp),
      .result_tvalid_o(netlist[TDATA_WIDTH+1]),
      .result_tready_i(result_tready),
      .result_tdata_o (netlist[TDATA_WIDTH-1:0]),
      .result_tlast_o (netlist[TDATA_WIDTH])
  );
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
      .FRACTION_BITS   (dtof_pkg::fraction_width(READOUT, FRACTION_BITS)),
      .CONFIDENCE_WIDTH(dtof_pkg::confidence_width(READOUT, COUNT_WIDTH, KEPT_CONFIDENCE_WIDTH)),
      .TURNS           (1),
      .COMPARE         (COMPARE),
      .FRAMES          (FRAMES),
      .BEATS           (BEATS),
      .SEED            (SEED)
  ) u_bench (
      .clk_o          (clk),
      .rst_no         (rst_n),
      .start_o        (start),
      .acq_num_o      (acq_num),
      .setting_0_o    (gate_begin),
      .setting_1_o    (gate_end),
      .setting_2_o    (),
      .tdc_valid_o    (tdc_valid),
      .tdc_timestamp_o(tdc_timestamp),
      .result_tready_o(result_tready),
      .rtl_i          (rtl),
      .netlist_i      (netlist)
  );

endmodule
