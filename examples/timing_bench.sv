// SPDX-License-Identifier: Apache-2.0
// What scripts/timing_diagrams.py draws and counts. With DIAGRAMS = 1 a frame of dtof_subsystem at whose ports the things
// happen that integration.md shows; `diagram` has the number of the one that a clock belongs to. With DIAGRAMS = 0 a frame
// whose source never pauses and whose sink never waits, of which FRAME_CYCLES is printed.
`include "dtof_macros.svh"
`timescale 1ns / 1ps

// verilator lint_off TIMESCALEMOD
`default_nettype none

module timing_bench #(
    parameter int READOUT = dtof_pkg::READOUT_EZPOINTER,
    parameter int DIAGRAMS = 1,
    parameter int ACQUISITIONS = 1,
    parameter int NP = 8,
    parameter int COLUMNS = 2,
    parameter int ROWS = 2
);

  localparam int SLOTS = 2;
  localparam int LINES = ROWS * SLOTS;  // of an acquisition
  localparam int WIDTH = COLUMNS * NP;
  localparam logic [31:0] START = 32'd1 << dtof_registers_pkg::CONTROL_START_LSB;

  logic clk = 1'b0;
  logic rst_n = 1'b0;
  always #1.5 clk = !clk;

  int diagram = 0;  // 1 registers, 2 lines, 3 results; 0: none
  logic psel = 1'b0, penable = 1'b0, pwrite = 1'b0;
  logic [11:0] paddr = '0;
  logic [31:0] pwdata = '0;
  logic pready, pslverr, irq;
  logic [31:0] prdata;
  logic line_valid = 1'b0, line_last = 1'b0, frame_last;
  logic line_ready;
  logic [WIDTH-1:0] line = '0;
  logic result_valid, result_first, result_last;
  logic result_ready = 1'b1;
  logic [63:0] result;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] unused_sram_cfg;
  logic unused_shot;

  dtof_subsystem #(
      .READOUT        (READOUT),
      .NP             (NP),
      .SRAM_NUM       (COLUMNS),
      .PIXELS_PER_SRAM(ROWS),
      .SLOTS          (SLOTS),
      .ENGINE_COLUMNS (2)
  ) u_subsystem (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .scan_mode_i    (1'b0),
      .sram_cfg_i     ('0),
      .sram_cfg_o     (unused_sram_cfg),
      .psel_i         (psel),
      .penable_i      (penable),
      .pwrite_i       (pwrite),
      .paddr_i        (paddr),
      .pwdata_i       (pwdata),
      .pstrb_i        (4'hF),
      .pready_o       (pready),
      .prdata_o       (prdata),
      .pslverr_o      (pslverr),
      .irq_o          (irq),
      .shot_o         (unused_shot),  // the source fires by itself
      .s_axis_tvalid_i(line_valid),
      .s_axis_tready_o(line_ready),
      .s_axis_tdata_i (line),
      .s_axis_tlast_i (line_last || frame_last),
      .m_axis_tvalid_o(result_valid),
      .m_axis_tready_i(result_ready),
      .m_axis_tdata_o (result),
      .m_axis_tuser_o (result_first),
      .m_axis_tlast_o (result_last)
  );

  task automatic clocks(input int number);
    repeat (number) @(posedge clk);
    #0.1;
  endtask

  logic [31:0] answer;  // of the last transfer

  task automatic transfer(input logic is_write, input logic [11:0] offset, input logic [31:0] data);
    psel = 1'b1;
    pwrite = is_write;
    paddr = offset;
    pwdata = data;
    clocks(1);
    penable = 1'b1;
    @(negedge clk);
    while (!pready) @(negedge clk);
    answer = prdata;
    clocks(1);
    psel = 1'b0;
    penable = 1'b0;
  endtask

  task automatic send(input int index);
    line_valid = 1'b1;
    line = {COLUMNS{NP'(8'hA0 + 8'(index))}};
    line_last = (index % LINES == LINES - 1);
    @(negedge clk);
    while (!line_ready) @(negedge clk);
    clocks(1);
    line_valid = 1'b0;
    line_last = 1'b0;
  endtask

  // Lines of `frame` one behind the other.
  int taken = 0;
  assign frame_last = (DIAGRAMS == 0) && (taken % LINES == LINES - 1);
  always @(posedge clk) begin
    if (line_valid && line_ready) taken <= taken + 1;
  end

  task automatic diagrams;
    transfer(1'b1, dtof_registers_pkg::ACQUISITIONS, 32'd1);
    transfer(1'b1, dtof_registers_pkg::IRQ_ENABLE, 32'd3);
    clocks(2);
    diagram = 1;
    clocks(1);
    transfer(1'b1, dtof_registers_pkg::CONTROL, START);
    clocks(1);
    transfer(1'b0, dtof_registers_pkg::STATUS, '0);
    transfer(1'b0, 12'h03C, '0);
    clocks(1);
    diagram = 0;
    clocks(20);

    diagram = 2;
    clocks(1);
    send(0);
    send(1);
    clocks(2);
    send(2);
    send(3);
    clocks(6);
    diagram = 0;

    @(negedge clk);
    while (!result_valid) @(negedge clk);
    diagram = 3;
    clocks(1);
    result_ready = 1'b0;
    clocks(3);
    result_ready = 1'b1;
    while (!(result_valid && result_last)) clocks(1);
    clocks(3);
    diagram = 0;
    clocks(5);

  endtask

  // Lines without a pause until the frame has ended; nothing is detected, which costs no clock less.
  task automatic frame;
    int index;
    transfer(1'b1, dtof_registers_pkg::ACQUISITIONS, ACQUISITIONS);
    if (READOUT == dtof_pkg::READOUT_POOLPOINTER) begin
      transfer(1'b1, dtof_registers_pkg::COARSE_END, ACQUISITIONS * u_subsystem.COARSE_SHARE / 64);
      transfer(1'b1, dtof_registers_pkg::TRACK_END, ACQUISITIONS * (u_subsystem.COARSE_SHARE + u_subsystem.TRACK_SHARE) / 64);
    end
    line_valid = 1'b1;
    line = {WIDTH{1'b1}};
    clocks(2 * LINES + 8);  // the buffer is full
    transfer(1'b1, dtof_registers_pkg::IRQ_ENABLE, 32'd1);
    transfer(1'b1, dtof_registers_pkg::CONTROL, START);
    while (!irq) clocks(1);
    transfer(1'b0, dtof_registers_pkg::FRAME_CYCLES, '0);
    $display("cycles %0d lines %0d", answer, ACQUISITIONS * LINES);
  endtask

  initial begin
    if (DIAGRAMS != 0) $dumpvars(0, timing_bench);
    clocks(3);
    rst_n = 1'b1;
    clocks(1);
    if (DIAGRAMS != 0) diagrams;
    else frame;
    $finish(0);
  end

  initial begin : watchdog
    #3e7;
    $display("FAIL: the frame does not end");
    $finish(0);
  end

endmodule

`default_nettype wire
