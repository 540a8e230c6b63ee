// SPDX-License-Identifier: Apache-2.0
// A frame of this sensor's photons through dtof_product, as a chip would have it: registers by APB4, lines with gaps, results
// that wait now and then. Every result word is compared with the model's (vectors/results.hex). Then, where the product has it, the built-in
// self-test, with the model's checksum and with a wrong one. Ends with PASS or FAIL.
`timescale 1ns / 1ps

// verilator lint_off TIMESCALEMOD
`default_nettype none

module product_bench;

  localparam int NP = @NP@;
  localparam int COLUMNS = @COLUMNS@;
  localparam int ROWS = @ROWS@;
  localparam int SLOTS = @SLOTS@;
  localparam int ACQUISITIONS = @ACQUISITIONS@;  // of the vectors
  localparam logic [255:0] TEMPLATE = 256'h@TEMPLATE@;  // 0: none
  localparam int COARSE_END = @COARSE_END@;  // 0: the read-out has no schedule
  localparam int TRACK_END = @TRACK_END@;
  localparam int TIME_GATE = @TIME_GATE@;
  localparam int GATE_BEGIN = @GATE_BEGIN@;
  localparam int GATE_END = @GATE_END@;
  localparam int FRACTION_BITS = @FRACTION_BITS@;  // of a result
  localparam int SELF_TEST = @SELF_TEST@;
  localparam int LINES = ACQUISITIONS * ROWS * SLOTS;

  logic clk = 1'b0;
  logic rst_n = 1'b0;
  always #1.5 clk = !clk;

  logic psel = 1'b0, penable = 1'b0, pwrite = 1'b0;
  logic [11:0] paddr = '0;
  logic [31:0] pwdata = '0;
  logic pready, pslverr, irq;
  logic [31:0] prdata;
  logic line_valid = 1'b0, line_last = 1'b0;
  logic line_ready;
  localparam int LINE_WIDTH = 8 * ((COLUMNS * NP + 7) / 8);
  logic [LINE_WIDTH-1:0] line = '0;
  logic result_valid, result_first, result_last;
  logic result_ready = 1'b0;
  logic [63:0] result;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] unused_sram_cfg;

  dtof_product u_product (
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
      .shot_o         (),
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

  // A line for each clock of the source; code, fraction and confidence, 16 bits each, for each pixel, row by row.
  logic [4*((COLUMNS*NP+3)/4)-1:0] stimulus[0:LINES-1];
  logic [47:0] expected[0:ROWS*COLUMNS-1];
  logic seen[0:ROWS*COLUMNS-1];

  int failures = 0;

  task automatic fail(input [8*80-1:0] what);
    failures = failures + 1;
    if (failures <= 10) $display("error: %0s", what);
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

  // The verdict must be `passes`.
  task automatic self_test(input logic [31:0] expected_crc, input logic passes);
    logic [31:0] value;
    write(dtof_registers_pkg::SELF_TEST_EXPECTED, expected_crc);
    write(dtof_registers_pkg::CONTROL, 32'd1 << dtof_registers_pkg::CONTROL_SELF_TEST_LSB);
    value = 32'd1 << dtof_registers_pkg::STATUS_SELF_TEST_LSB;
    while (value[dtof_registers_pkg::STATUS_SELF_TEST_LSB]) read(dtof_registers_pkg::STATUS, value);
    if (value[dtof_registers_pkg::STATUS_PASSED_LSB] != passes) fail("the self-test has another verdict");
    read(dtof_registers_pkg::ERROR, value);
    if (value[dtof_registers_pkg::ERROR_SELF_TEST_LSB] == passes) fail("ERROR.SELF_TEST is not the verdict");
  endtask

  int source_seed = 1;

  initial begin : source
    int i;
    $readmemh("vectors/timestamps.hex", stimulus);
    $readmemh("vectors/results.hex", expected);
    for (i = 0; i < ROWS * COLUMNS; i = i + 1) seen[i] = 1'b0;
    @(posedge rst_n);
    @(posedge clk);
    #0.1;
    for (i = 0; i < LINES; i = i + 1) begin
      if ($dist_uniform(source_seed, 0, 19) == 0) begin
        repeat (3) @(posedge clk);  // a gap
        #0.1;
      end
      line_valid = 1'b1;
      line = LINE_WIDTH'(stimulus[i]);
      line_last = ((i + 1) % (ROWS * SLOTS) == 0);
      @(negedge clk);
      while (!line_ready) @(negedge clk);
      @(posedge clk);
      #0.1 line_valid = 1'b0;
    end
  end

  int words = 0;
  int sink_seed = 2;
  logic received = 1'b0;  // the frame's last word

  task automatic take(input logic [63:0] word);
    int row, column, pixel, position, confidence, wanted;
    row = int'(word[dtof_registers_pkg::RESULT_ROW_LSB+:dtof_registers_pkg::RESULT_ROW_WIDTH]);
    column = int'(word[dtof_registers_pkg::RESULT_COLUMN_LSB+:dtof_registers_pkg::RESULT_COLUMN_WIDTH]);
    position = int'(word[dtof_registers_pkg::RESULT_POSITION_LSB+:dtof_registers_pkg::RESULT_POSITION_WIDTH]);
    confidence = int'(word[dtof_registers_pkg::RESULT_CONFIDENCE_LSB+:dtof_registers_pkg::RESULT_CONFIDENCE_WIDTH]);
    if (row >= ROWS || column >= COLUMNS) begin
      fail("a result is of no pixel");
    end else begin
      pixel = row * COLUMNS + column;
      wanted = (int'(expected[pixel][47:32]) << FRACTION_BITS) + int'(expected[pixel][31:16]);
      if (seen[pixel] === 1'b1) fail("a pixel has two results");
      seen[pixel] = 1'b1;
      if (position != wanted || confidence != int'(expected[pixel][15:0])) begin
        $display("row %0d column %0d: position %0d, not %0d; confidence %0d, not %0d", row, column, position, wanted,
                 confidence, expected[pixel][15:0]);
        fail("this result is not the model's");
      end
    end
    if (result_first != (words == 0)) fail("tuser is not on the first word");
    words = words + 1;
    received = result_last;
  endtask

  initial begin : sink
    @(posedge rst_n);
    forever begin
      @(posedge clk);
      #0.1 result_ready = ($dist_uniform(sink_seed, 0, 3) != 0);
      @(negedge clk);
      if (result_valid && result_ready) take(result);
    end
  end

  initial begin : software
    logic [31:0] value, cycles;
    repeat (3) @(posedge clk);
    #0.1 rst_n = 1'b1;
    read(dtof_registers_pkg::ID, value);
    if (value != dtof_registers_pkg::ID_VALUE) fail("this is not the subsystem");
    write(dtof_registers_pkg::ACQUISITIONS, ACQUISITIONS);
    if (TRACK_END != 0) begin
      write(dtof_registers_pkg::COARSE_END, COARSE_END);
      write(dtof_registers_pkg::TRACK_END, TRACK_END);
    end
    for (int i = 0; TEMPLATE != 0 && i < 8; ++i) begin
      write(dtof_registers_pkg::TEMPLATE + 12'(4 * i), TEMPLATE[32*i+:32]);
    end
    if (TIME_GATE != 0) write(dtof_registers_pkg::GATE, {GATE_END[15:0], GATE_BEGIN[15:0]});
    write(dtof_registers_pkg::IRQ_ENABLE, 32'd1 << dtof_registers_pkg::IRQ_ENABLE_FRAME_LSB);
    write(dtof_registers_pkg::CONTROL, 32'd1 << dtof_registers_pkg::CONTROL_START_LSB);
    while (!irq) @(posedge clk);
    read(dtof_registers_pkg::FRAME_CYCLES, cycles);
    read(dtof_registers_pkg::ERROR, value);
    if (value != 0) fail("ERROR is not 0");
    if (words != ROWS * COLUMNS || !received) fail("the frame is not whole");
    $display("%0d acquisitions of %0d x %0d pixels in %0d clocks, %0d results", ACQUISITIONS, COLUMNS, ROWS, cycles,
             words);
    if (SELF_TEST != 0) begin
      for (int i = 0; TEMPLATE != 0 && i < 8; ++i) write(dtof_registers_pkg::TEMPLATE + 12'(4 * i), '0);
      if (TIME_GATE != 0) write(dtof_registers_pkg::GATE, ((32'd1 << NP) - 1) << dtof_registers_pkg::GATE_END_LSB);
      write(dtof_registers_pkg::SELF_TEST_SEED, 32'h@SELF_TEST_SEED@);
      self_test(32'h@SELF_TEST_EXPECTED@, 1'b1);
      self_test(~32'h@SELF_TEST_EXPECTED@, 1'b0);
      if (words != ROWS * COLUMNS) fail("a word of a self-test has left");
      $display("self-test: passed, and failed with a wrong checksum");
    end
    if (failures != 0) $display("FAIL: %0d errors", failures);
    else $display("PASS");
    $finish(0);
  end

  initial begin : watchdog
    repeat (2 * @MOST_CLOCKS@) @(posedge clk);  // no delay: Verilator 5.006 keeps 32 bits of a delay in picoseconds
    $display("FAIL: the frame does not end");
    $finish(0);
  end

endmodule

`default_nettype wire
