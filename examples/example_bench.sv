// SPDX-License-Identifier: Apache-2.0
// A first frame of dtof_subsystem in plain SystemVerilog: `make example`. It does what a chip around the subsystem does.
//
// 1. Registers: who is there, then the settings, then the start, by APB4 (task write, task read).
// 2. Lines: an invented scene of two walls, photons of both and of the background, with gaps (source).
// 3. Results: every word of the stream is unpacked, printed and compared with the wall that the pixel looks at (sink);
//    the sink waits now and then.
`include "dtof_macros.svh"
`timescale 1ns / 1ps

// verilator lint_off TIMESCALEMOD
`default_nettype none

module example_bench #(
    parameter int READOUT = dtof_pkg::READOUT_HISPOINTER,
    parameter int ACQUISITIONS = 600
);

  localparam int NP = 8;
  localparam int COLUMNS = 4;
  localparam int ROWS = 6;
  localparam int SLOTS = 2;
  localparam int NONE = (1 << NP) - 1;  // the code of no detection
  localparam int TOLERANCE = 4;         // codes

  // The scene: a wall on the left, another behind it on the right, both leaning.
  function automatic int wall(input int row, input int column);
    wall = ((column < COLUMNS / 2) ? 60 : 170) + row;
  endfunction

  logic clk = 1'b0;
  logic rst_n = 1'b0;
  always #1.5 clk = !clk;  // 333 MHz

  logic psel = 1'b0, penable = 1'b0, pwrite = 1'b0;
  logic [11:0] paddr = '0;
  logic [31:0] pwdata = '0;
  logic pready, pslverr, irq;
  logic [31:0] prdata;
  logic line_valid = 1'b0, line_last = 1'b0;
  logic line_ready;
  logic [COLUMNS*NP-1:0] line = '0;
  logic result_valid, result_first, result_last;
  logic result_ready = 1'b0;
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
      .s_axis_tlast_i (line_last),
      .m_axis_tvalid_o(result_valid),
      .m_axis_tready_i(result_ready),
      .m_axis_tdata_o (result),
      .m_axis_tuser_o (result_first),
      .m_axis_tlast_o (result_last)
  );

  int failures = 0;

  task automatic fail(input [8*80-1:0] what);
    failures = failures + 1;
    $display("error: %0s", what);
  endtask

  // Signals change behind the clock's edge, as those of flip-flops do.

  task automatic transfer(input logic is_write, input logic [11:0] offset, input logic [31:0] data);
    @(posedge clk);
    #0.1 psel = 1'b1;
    pwrite = is_write;
    paddr = offset;
    pwdata = data;
    @(posedge clk);
    #0.1 penable = 1'b1;
    @(negedge clk);
    while (!pready) @(negedge clk);
    if (pslverr) fail("a register refuses");
  endtask

  task automatic end_transfer;
    @(posedge clk);
    #0.1 psel = 1'b0;
    penable = 1'b0;
  endtask

  task automatic write(input logic [11:0] offset, input logic [31:0] data);
    transfer(1'b1, offset, data);
    end_transfer;
  endtask

  task automatic read(input logic [11:0] offset, output logic [31:0] data);
    transfer(1'b0, offset, '0);
    data = prdata;
    end_transfer;
  endtask

  // A pixel's timestamps of an acquisition: of the wall in two of three, of the background in one of two; the earlier
  // one is first.
  int seed = 1;
  int first_code, second_code;

  task automatic pixel_events(input int row, input int column);
    first_code = NONE;
    second_code = NONE;
    if ($dist_uniform(seed, 0, 2) != 0) first_code = wall(row, column) + $dist_uniform(seed, -2, 2);
    if ($dist_uniform(seed, 0, 1) != 0) second_code = $dist_uniform(seed, 0, NONE - 1);
    if (second_code < first_code) begin
      {first_code, second_code} = {second_code, first_code};
    end
  endtask

  // Lines of a pixel: slot by slot.
  logic [COLUMNS*NP-1:0] slot_lines[SLOTS];

  task automatic send_line(input logic [COLUMNS*NP-1:0] data, input logic last);
    line_valid = 1'b1;
    line = data;
    line_last = last;
    @(negedge clk);
    while (!line_ready) @(negedge clk);
    @(posedge clk);
    #0.1 line_valid = 1'b0;
  endtask

  initial begin : source
    int acquisition, row, column, slot;
    @(posedge rst_n);
    @(posedge clk);
    #0.1;
    for (acquisition = 0; acquisition < ACQUISITIONS; acquisition = acquisition + 1) begin
      for (row = 0; row < ROWS; row = row + 1) begin
        for (column = 0; column < COLUMNS; column = column + 1) begin
          pixel_events(row, column);
          slot_lines[0][column*NP+:NP] = first_code[NP-1:0];
          slot_lines[1][column*NP+:NP] = second_code[NP-1:0];
        end
        for (slot = 0; slot < SLOTS; slot = slot + 1) begin
          if ($dist_uniform(seed, 0, 9) == 0) begin
            repeat (3) @(posedge clk);  // a gap
            #0.1;
          end
          send_line(slot_lines[slot], row == ROWS - 1 && slot == SLOTS - 1);
        end
      end
    end
  end

  // Results.

  int words = 0;
  int fraction_bits = 0;
  logic received = 1'b0;  // the frame's last word

  task automatic take(input logic [63:0] word);
    int row, column, position, confidence, code, distance;
    row = int'(word[dtof_registers_pkg::RESULT_ROW_LSB+:dtof_registers_pkg::RESULT_ROW_WIDTH]);
    column = int'(word[dtof_registers_pkg::RESULT_COLUMN_LSB+:dtof_registers_pkg::RESULT_COLUMN_WIDTH]);
    position = int'(word[dtof_registers_pkg::RESULT_POSITION_LSB+:dtof_registers_pkg::RESULT_POSITION_WIDTH]);
    confidence = int'(word[dtof_registers_pkg::RESULT_CONFIDENCE_LSB+:dtof_registers_pkg::RESULT_CONFIDENCE_WIDTH]);
    code = position >> fraction_bits;
    distance = code - wall(row, column);
    $display("row %0d column %0d: code %0d, wall at %0d, confidence %0d%0s", row, column, code, wall(row, column),
             confidence, word[dtof_registers_pkg::RESULT_VALID_LSB] ? "" : ", not valid");
    if (distance < -TOLERANCE || distance > TOLERANCE) fail("this code is not the wall's");
    if (result_first != (words == 0)) fail("tuser is not on the first word");
    words = words + 1;
    received = result_last;
  endtask

  initial begin : sink
    @(posedge rst_n);
    forever begin
      @(posedge clk);
      #0.1 result_ready = ($dist_uniform(seed, 0, 3) != 0);
      @(negedge clk);
      if (result_valid && result_ready) take(result);
    end
  end

  // The software.

  initial begin : software
    logic [31:0] value, cycles;
    int coarse, track;
    repeat (3) @(posedge clk);
    #0.1 rst_n = 1'b1;

    read(dtof_registers_pkg::ID, value);
    if (value != dtof_registers_pkg::ID_VALUE) fail("this is not the subsystem");
    read(dtof_registers_pkg::WIDTHS, value);
    fraction_bits = int'(value[dtof_registers_pkg::WIDTHS_FRACTION_LSB+:dtof_registers_pkg::WIDTHS_FRACTION_WIDTH]);

    write(dtof_registers_pkg::ACQUISITIONS, ACQUISITIONS);
    // poolPointer's recommended schedule, in 64ths of the frame.
    if (READOUT == dtof_pkg::READOUT_POOLPOINTER) begin
      read(dtof_registers_pkg::SHARES, value);
      coarse = int'(value[dtof_registers_pkg::SHARES_COARSE_LSB+:dtof_registers_pkg::SHARES_COARSE_WIDTH]);
      track = int'(value[dtof_registers_pkg::SHARES_TRACK_LSB+:dtof_registers_pkg::SHARES_TRACK_WIDTH]);
      write(dtof_registers_pkg::COARSE_END, ACQUISITIONS * coarse / 64);
      write(dtof_registers_pkg::TRACK_END, ACQUISITIONS * (coarse + track) / 64);
    end
    write(dtof_registers_pkg::WEAK_BELOW, 2);
    write(dtof_registers_pkg::IRQ_ENABLE, 32'd1 << dtof_registers_pkg::IRQ_ENABLE_FRAME_LSB);
    write(dtof_registers_pkg::CONTROL, 32'd1 << dtof_registers_pkg::CONTROL_START_LSB);

    while (!irq) @(posedge clk);
    read(dtof_registers_pkg::FRAME_CYCLES, cycles);
    read(dtof_registers_pkg::ERROR, value);
    if (value != 0) fail("ERROR is not 0");
    if (words != ROWS * COLUMNS || !received) fail("the frame is not whole");
    $display("%0d acquisitions of %0d x %0d pixels in %0d clocks, %0d of them with a line", ACQUISITIONS, ROWS, COLUMNS,
             cycles, ACQUISITIONS * ROWS * SLOTS);
    if (failures != 0) $display("FAIL: %0d errors", failures);
    else $display("PASS");
    $finish(0);
  end

  initial begin : watchdog
    #(3.0 * ACQUISITIONS * ROWS * SLOTS * 4 + 3e4);
    $display("FAIL: the frame does not end");
    $finish(0);
  end

endmodule

`default_nettype wire
