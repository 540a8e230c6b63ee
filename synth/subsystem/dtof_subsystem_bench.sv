// SPDX-License-Identifier: Apache-2.0
// A frame of dtof-vectors through the netlist of dtof_subsystem, with the RTL of the array inside. Software writes the registers and starts the
// frame. The source has a line in every clock, the sink takes every word. Results are compared with the model's. The simulation ends after
// MOST_RESULTS results, or, with QUIET_CLOCKS, so many clocks after LEAST_LINES lines or more: thousands of clocks before the first result.
// Its last words are "DTOF_PASS lines N results N clocks N", at the first failure "DTOF_FAIL".
`timescale 1ns / 1ps

module dtof_subsystem_bench #(
    parameter int NP = 10,
    parameter int SRAM_NUM = 200,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int FRACTION_BITS = 0,
    parameter int HAS_SCHEDULE = 0,
    parameter int BEATS = 1,
    parameter int MOST_RESULTS = 1,
    parameter int QUIET_CLOCKS = 0,  // 0: wait for results
    parameter int LEAST_LINES = 1,   // that come before
    parameter int MOST_CLOCKS = 1
);

  localparam int LINE_WIDTH = 8 * ((SRAM_NUM * NP + 7) / 8);

  logic clk = 1'b0;
  logic rst_n = 1'bx;
  logic psel = 1'b0, penable = 1'b0, pwrite = 1'b0;
  logic [11:0] paddr = '0;
  logic [31:0] pwdata = '0;
  logic pready, pslverr;
  logic line_valid = 1'b0, line_last = 1'b0;
  logic line_ready;
  logic [LINE_WIDTH-1:0] line = '0;
  logic result_valid, result_first, result_last;
  logic [63:0] result;

  dtof_subsystem_netlist u_netlist (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .scan_mode_i    (1'b0),
      .sram_cfg_i     ('0),
      .sram_cfg_o     (),
      .psel_i         (psel),
      .penable_i      (penable),
      .pwrite_i       (pwrite),
      .paddr_i        (paddr),
      .pwdata_i       (pwdata),
      .pstrb_i        (4'hF),
      .pready_o       (pready),
      .prdata_o       (),
      .pslverr_o      (pslverr),
      .irq_o          (),
      .shot_o         (),
      .s_axis_tvalid_i(line_valid),
      .s_axis_tready_o(line_ready),
      .s_axis_tdata_i (line),
      .s_axis_tlast_i (line_last),
      .m_axis_tvalid_o(result_valid),
      .m_axis_tready_i(1'b1),
      .m_axis_tdata_o (result),
      .m_axis_tuser_o (result_first),
      .m_axis_tlast_o (result_last)
  );

  logic [4*((SRAM_NUM*NP+3)/4)-1:0] stimulus[0:BEATS-1];
  logic [47:0] expected[0:PIXELS_PER_SRAM*SRAM_NUM-1];
  integer clocks = 0;
  integer words = 0;
  integer lines = 0;
  integer quiet = 0;
  integer acquisitions, setting_0, setting_1, setting_2, pause, stall, again, file, found;

  task finish_with_failure(input [8*60-1:0] what);
    $display("DTOF_FAIL %0s, clock %0d, word %0d", what, clocks, words);
    $finish(0);
  endtask

  task finish;
    $display("DTOF_PASS lines %0d results %0d clocks %0d", lines, words, clocks);
    $finish(0);
  endtask

  // Signals change behind the clock's edge, as those of flip-flops do.
  initial forever begin
    #1.5 clk = 1'b1;
    #1.5 clk = 1'b0;
    clocks = clocks + 1;
    if (clocks == MOST_CLOCKS && QUIET_CLOCKS == 0) finish_with_failure("the results do not come");
    if (clocks == MOST_CLOCKS) finish_with_failure("the lines are not taken");
  end

  task write(input logic [11:0] offset, input logic [31:0] data);
    @(posedge clk);
    #0.1 psel = 1'b1;
    pwrite = 1'b1;
    paddr = offset;
    pwdata = data;
    @(posedge clk);
    #0.1 penable = 1'b1;
    @(negedge clk);
    while (pready === 1'b0) @(negedge clk);
    if (pready !== 1'b1 || pslverr !== 1'b0) finish_with_failure("a register refuses");
    @(posedge clk);
    #0.1 psel = 1'b0;
    penable = 1'b0;
  endtask

  initial begin : software
    $readmemh("timestamps.hex", stimulus);
    $readmemh("results.hex", expected);
    file = $fopen("frames.txt", "r");
    found = $fscanf(file, "%d %d %d %d %d %d %d", acquisitions, setting_0, setting_1, setting_2, pause, stall, again);
    if (found != 7) finish_with_failure("frames.txt cannot be read");
    #1 rst_n = 1'b0;  // an edge: registers behind closed clock gates see no other event in the reset
    repeat (4) @(posedge clk);
    #0.1 rst_n = 1'b1;
    repeat (4) @(posedge clk);
    write(dtof_registers_pkg::ACQUISITIONS, acquisitions);
    if (HAS_SCHEDULE != 0) begin  // without a pause between the acquisitions, if no result is awaited
      write(dtof_registers_pkg::COARSE_END, QUIET_CLOCKS != 0 ? acquisitions : setting_0);
      write(dtof_registers_pkg::TRACK_END, QUIET_CLOCKS != 0 ? acquisitions : setting_1);
    end
    write(dtof_registers_pkg::CONTROL, 32'd1 << dtof_registers_pkg::CONTROL_START_LSB);
  end

  integer beat;

  initial begin : source
    wait (rst_n === 1'b1);
    #0.1;
    for (beat = 0; beat < BEATS; beat = beat + 1) begin
      line_valid = 1'b1;
      line = LINE_WIDTH'(stimulus[beat]);
      line_last = ((beat + 1) % (PIXELS_PER_SRAM * SLOTS) == 0);
      @(negedge clk);
      while (line_ready !== 1'b1) @(negedge clk);
      @(posedge clk);
      #0.1;
    end
    line_valid = 1'b0;
  end

  integer row, column, wanted;

  always @(negedge clk) begin : sink
    if (rst_n === 1'b1 && (^{result_valid, line_ready, pready} === 1'bx)) finish_with_failure("a handshake is X");
    if (result_valid === 1'b1) begin
      row = result[dtof_registers_pkg::RESULT_ROW_LSB+:dtof_registers_pkg::RESULT_ROW_WIDTH];
      column = result[dtof_registers_pkg::RESULT_COLUMN_LSB+:dtof_registers_pkg::RESULT_COLUMN_WIDTH];
      wanted = (expected[row*SRAM_NUM+column][47:32] << FRACTION_BITS) + expected[row*SRAM_NUM+column][31:16];
      if (result[dtof_registers_pkg::RESULT_POSITION_LSB+:dtof_registers_pkg::RESULT_POSITION_WIDTH] !== wanted
          || result[dtof_registers_pkg::RESULT_CONFIDENCE_LSB+:dtof_registers_pkg::RESULT_CONFIDENCE_WIDTH]
          !== expected[row*SRAM_NUM+column][15:0]) begin
        $display("row %0d column %0d: %h, not %h", row, column, result, expected[row*SRAM_NUM+column]);
        finish_with_failure("a result is not the model's");
      end
      if (result_first !== (words == 0) || result_last !== 1'b0) finish_with_failure("a mark of the frame is wrong");
      words = words + 1;
      if (QUIET_CLOCKS == 0 && words == MOST_RESULTS) finish;
    end
    if (line_valid && line_ready === 1'b1) begin
      lines = lines + 1;
      quiet = 0;
    end else if (lines >= LEAST_LINES) quiet = quiet + 1;
    if (QUIET_CLOCKS != 0 && quiet == QUIET_CLOCKS) finish;
  end

endmodule
