// SPDX-License-Identifier: Apache-2.0
// Frames of dtof_subsystem whose array is off between them, by the sequence of docs/user/power_intent.md. power_tasks.svh has the tasks that
// clamp, corrupt, save and restore: scripts/tests/test_power_simulation.py writes them from the power intent.
//
// +off=1: the array is off after the first frame. +prior=1: OUTPUT.PRIOR. +fault=1: no clamps; 2: the memories of the prior lose their words;
// 3: no ABORT; 4: the prior's flip-flop is not restored; 5: START before ABORT. Prints every word and PASS.

module bench;
  parameter int READOUT = 0;
  parameter int PRIOR = 0;
  localparam int COLUMNS = 2;
  localparam int ROWS = 4;
  localparam int NP = 10;
  localparam int SLOTS = 2;
  localparam int ACQUISITIONS = 16;
  localparam int FRAMES = 2;

  logic clk = 1'b0, rst_n = 1'b0;
  always #5 clk = !clk;

  logic psel = 1'b0, penable = 1'b0, pwrite = 1'b0;
  logic [11:0] paddr = '0;
  logic [31:0] pwdata = '0;
  logic pready, pslverr, irq, shot, sram_cfg, line_ready, result_valid, result_first, result_last;
  logic line_valid = 1'b0, line_last = 1'b0;
  logic [31:0] prdata;
  logic [8*((COLUMNS*NP+7)/8)-1:0] line = '0;
  logic [63:0] result;

  dtof_subsystem #(
      .READOUT        (READOUT),
      .PRIOR          (PRIOR),
      .NP             (NP),
      .SRAM_NUM       (COLUMNS),
      .PIXELS_PER_SRAM(ROWS),
      .SLOTS          (SLOTS),
      .ENGINE_COLUMNS (2)
  ) u_dut (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .scan_mode_i    (1'b0),
      .sram_cfg_i     (1'b1),
      .sram_cfg_o     (sram_cfg),
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
      .shot_o         (shot),
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

  `include "power_tasks.svh"

  task fail(input [8*80-1:0] what);
    $display("FAIL: %0s", what);
    $finish(0);
  endtask

  int words = 0, off_clocks = 0;
  logic is_off = 1'b0;

  always @(negedge clk) begin
    if (rst_n && (^{pready, pslverr, irq, shot, sram_cfg, line_ready, result_valid}) === 1'bx) fail("an output is unknown");
    if (rst_n && penable && pready && !pwrite && (^prdata) === 1'bx) fail("a register is unknown");
    if (is_off && (result_valid || shot)) fail("a result or a shot while the array is off");
    if (is_off) off_clocks = off_clocks + 1;
    if (rst_n && result_valid) begin
      if ((^{result, result_first, result_last}) === 1'bx) fail("a result is unknown");
      $display("WORD %h %b %b", result, result_first, result_last);
      words = words + 1;
    end
  end

  task write(input logic [11:0] offset, input logic [31:0] data);
    @(posedge clk);
    #1 {psel, pwrite, paddr, pwdata} = {1'b1, 1'b1, offset, data};
    @(posedge clk);
    #1 penable = 1'b1;
    @(negedge clk);
    while (!pready) @(negedge clk);
    @(posedge clk);
    #1 {psel, penable} = 2'b00;
  endtask

  task read(input logic [11:0] offset, output logic [31:0] data);
    @(posedge clk);
    #1 {psel, pwrite, paddr} = {1'b1, 1'b0, offset};
    @(posedge clk);
    #1 penable = 1'b1;
    @(negedge clk);
    while (!pready) @(negedge clk);
    data = prdata;
    @(posedge clk);
    #1 {psel, penable} = 2'b00;
  endtask

  int seed = 5, row, column, slot, acquisition, first, second;

  // The wall is at two distances; its light is weak.
  task send_acquisition;
    logic [SLOTS*COLUMNS*NP-1:0] both;
    for (row = 0; row < ROWS; row = row + 1) begin
      for (column = 0; column < COLUMNS; column = column + 1) begin
        first = $dist_uniform(seed, 0, 2) == 0 ? ((row < ROWS / 2) ? 300 : 640) + $dist_uniform(seed, -6, 6) : $dist_uniform(seed, 0, 1022);
        second = $dist_uniform(seed, 0, 3) == 0 ? 1023 : $dist_uniform(seed, 0, 1022);
        both[column*NP+:NP] = NP'((first < second) ? first : second);
        both[(COLUMNS+column)*NP+:NP] = NP'((first < second) ? second : first);
      end
      for (slot = 0; slot < SLOTS; slot = slot + 1) begin
        line[COLUMNS*NP-1:0] = both[slot*COLUMNS*NP+:COLUMNS*NP];
        line_last = (row == ROWS - 1) && (slot == SLOTS - 1);
        line_valid = 1'b1;
        @(negedge clk);
        while (!line_ready) @(negedge clk);
        @(posedge clk);
        #1 line_valid = 1'b0;
      end
    end
  endtask

  logic [31:0] value, count;
  int frame, off, prior, fault;

  localparam logic [31:0] START = 32'd1 << dtof_registers_pkg::CONTROL_START_LSB;
  localparam logic [31:0] ABORT = 32'd1 << dtof_registers_pkg::CONTROL_ABORT_LSB;

  // The steps of docs/user/power_intent.md.
  task power_cycle;
    value = 32'd1;
    while (value[dtof_registers_pkg::STATUS_BUSY_LSB]) read(dtof_registers_pkg::STATUS, value);
    if (fault != 1) clamp;
    if (prior != 0) save;
    #1 corrupt;
    if (prior == 0 || fault == 2) corrupt_memories;
    is_off = 1'b1;
    repeat (50) @(posedge clk);
    read(dtof_registers_pkg::STATUS, value);
    if (value[dtof_registers_pkg::STATUS_BUSY_LSB]) fail("busy while the array is off");
    read(dtof_registers_pkg::FRAME_COUNT, count);
    read(dtof_registers_pkg::ACQUISITIONS, value);
    if (count != 1 || value != ACQUISITIONS) fail("a register is lost");
    is_off = 1'b0;
    if (fault == 5) write(dtof_registers_pkg::CONTROL, START);
    if (fault != 3) write(dtof_registers_pkg::CONTROL, ABORT);
    value = 32'd1;
    while (value[dtof_registers_pkg::STATUS_BUSY_LSB]) read(dtof_registers_pkg::STATUS, value);
    if (prior != 0 && fault != 4) restore;
    unclamp;
  endtask

  initial begin
    if ($value$plusargs("off=%d", off) == 0) off = 0;
    if ($value$plusargs("prior=%d", prior) == 0) prior = 0;
    if ($value$plusargs("fault=%d", fault) == 0) fault = 0;
    repeat (12) @(posedge clk);
    #1 rst_n = 1'b1;
    repeat (12) @(posedge clk);
    write(dtof_registers_pkg::ACQUISITIONS, ACQUISITIONS);
    if (READOUT == dtof_pkg::READOUT_POOLPOINTER) begin
      write(dtof_registers_pkg::COARSE_END, 6);
      write(dtof_registers_pkg::TRACK_END, 10);
    end
    write(dtof_registers_pkg::IRQ_ENABLE, 32'd1 << dtof_registers_pkg::IRQ_ENABLE_FRAME_LSB);
    if (prior != 0) write(dtof_registers_pkg::OUTPUT, (32'd1 << dtof_registers_pkg::OUTPUT_PRIOR_LSB) | (32'd1 << dtof_registers_pkg::OUTPUT_SMOOTH_LSB));
    for (frame = 0; frame < FRAMES; frame = frame + 1) begin
      write(dtof_registers_pkg::CONTROL, START);
      // Every pass of the read-outs that the bench is used for takes the same acquisitions.
      for (acquisition = 0; acquisition < ACQUISITIONS; acquisition = acquisition + 1) send_acquisition;
      while (!irq) @(posedge clk);
      write(dtof_registers_pkg::IRQ_STATUS, 32'd1 << dtof_registers_pkg::IRQ_STATUS_FRAME_LSB);
      if (frame == 0 && off != 0) power_cycle;
    end
    read(dtof_registers_pkg::ERROR, value);
    if (value != 0) fail("ERROR is not 0");
    if (words != FRAMES * ROWS * COLUMNS) fail("words are missing");
    if (off != 0 && off_clocks < 50) fail("the array was not off");
    $display("PASS");
    $finish(0);
  end

  initial begin
    #(10 * 200000) fail("a frame does not end");
  end

endmodule
