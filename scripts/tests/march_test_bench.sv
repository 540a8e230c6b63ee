// SPDX-License-Identifier: Apache-2.0
// The memory self-test and the scan bypass of hdl/technology/mbist: the self-test on memories with one planted fault, both in a whole array.
// Each bench ends with its verdict.
//   +kind=<n>: the fault, see macro_faults; 0: none. +address, +bit: the faulty bit; +other_address, +other_bit: the bit that disturbs it;
//   +value, +other_value. +depth: only memories of so many words have the fault.
`timescale 1ns / 1ps

// verilator lint_off TIMESCALEMOD
`default_nettype none

// A memory with one fault:
//   1 the bit is stuck at `value`; 2 the bit cannot change to `value`; 3 a change of the other bit to `other_value` inverts the bit; 4 such a
//   change sets the bit to `value`; 5 while the other bit is `other_value`, the bit is `value`; 6 other_address selects `address`.
module macro_faults #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic                  re_i,
    input  logic [ADDR_WIDTH-1:0] raddr_i,
    output logic [     WIDTH-1:0] rdata_o,
    input  logic                  we_i,
    input  logic [ADDR_WIDTH-1:0] waddr_i,
    input  logic [     WIDTH-1:0] wdata_i
);
  int kind = 0, address = 0, bit_number = 0, other_address = 0, other_bit = 0, value = 0, other_value = 0, depth = 0, found;
  reg [WIDTH-1:0] memory[0:DEPTH-1];
  logic rises;
  logic [WIDTH-1:0] word;
  int place, i;

  initial begin
    for (i = 0; i < DEPTH; i = i + 1) memory[i] = $random;
    found = $value$plusargs("kind=%d", kind);
    found = $value$plusargs("address=%d", address);
    found = $value$plusargs("bit=%d", bit_number);
    found = $value$plusargs("other_address=%d", other_address);
    found = $value$plusargs("other_bit=%d", other_bit);
    found = $value$plusargs("value=%d", value);
    found = $value$plusargs("other_value=%d", other_value);
    found = $value$plusargs("depth=%d", depth);
    if (depth != 0 && depth != DEPTH) kind = 0;
  end

  function automatic int selected(input int wanted);
    selected = (kind == 6 && wanted == other_address) ? address : wanted;
  endfunction

  always @(posedge clk_i) begin
    if (re_i) begin
      word = memory[selected(raddr_i)];
      if (kind == 5 && selected(raddr_i) == address && memory[other_address][other_bit] == other_value[0]) word[bit_number] = value[0];
      if (kind == 1 && selected(raddr_i) == address) word[bit_number] = value[0];
      rdata_o <= word;
    end
    if (we_i) begin
      place = selected(waddr_i);
      word = wdata_i;
      if (kind == 2 && place == address && memory[place][bit_number] != value[0]) word[bit_number] = !value[0];
      rises = (place == other_address) && (memory[place][other_bit] == !other_value[0]) && (wdata_i[other_bit] == other_value[0]);
      memory[place] = word;
      if (kind == 3 && rises) memory[address][bit_number] = !memory[address][bit_number];
      if (kind == 4 && rises) memory[address][bit_number] = value[0];
    end
  end
endmodule

module dtof_macro_1rw #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    parameter int PARTS = 1,
    parameter int CFG_WIDTH = 2,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic [ CFG_WIDTH-1:0] cfg_i,
    output logic [ CFG_WIDTH-1:0] cfg_o,
    input  logic                  en_i,
    input  logic                  we_i,
    input  logic [ADDR_WIDTH-1:0] addr_i,
    input  logic [     PARTS-1:0] wparts_i,
    input  logic [     WIDTH-1:0] wdata_i,
    output logic [     WIDTH-1:0] rdata_o
);
  assign cfg_o = cfg_i;
  always @(posedge clk_i) if (cfg_i == 2'b10 && en_i !== 1'b0) $display("a macro is accessed during scan");
  macro_faults #(
      .DEPTH(DEPTH),
      .WIDTH(WIDTH)
  ) u_faults (
      .clk_i(clk_i),
      .re_i(en_i && !we_i),
      .raddr_i(addr_i),
      .rdata_o(rdata_o),
      .we_i(en_i && we_i && wparts_i == {PARTS{1'b1}}),
      .waddr_i(addr_i),
      .wdata_i(wdata_i)
  );
endmodule

module dtof_macro_1r1w #(
    parameter int DEPTH = 16,
    parameter int WIDTH = 8,
    parameter int CFG_WIDTH = 2,
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic [ CFG_WIDTH-1:0] cfg_i,
    output logic [ CFG_WIDTH-1:0] cfg_o,
    input  logic                  re_i,
    input  logic [ADDR_WIDTH-1:0] raddr_i,
    output logic [     WIDTH-1:0] rdata_o,
    input  logic                  we_i,
    input  logic [ADDR_WIDTH-1:0] waddr_i,
    input  logic [     WIDTH-1:0] wdata_i
);
  assign cfg_o = cfg_i;
  always @(posedge clk_i) if (cfg_i == 2'b10 && (re_i || we_i) !== 1'b0) $display("a macro is accessed during scan");
  macro_faults #(
      .DEPTH(DEPTH),
      .WIDTH(WIDTH)
  ) u_faults (
      .clk_i(clk_i),
      .re_i(re_i),
      .raddr_i(raddr_i),
      .rdata_o(rdata_o),
      .we_i(we_i),
      .waddr_i(waddr_i),
      .wdata_i(wdata_i)
  );
endmodule

// One memory: clocks of the test, and the verdict.
module march_test_bench;
  parameter int DEPTH = 12;
  parameter int WIDTH = 5;
  parameter int PORTS = 1;
  localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1;
  logic clk = 1'b0;
  always #1 clk = !clk;
  logic [1:0] cfg = 2'b00, cfg_back;
  logic [WIDTH-1:0] rdata;
  int clocks = 0;

  dtof_sram #(
      .PORTS(PORTS),
      .DEPTH(DEPTH),
      .WIDTH(WIDTH)
  ) u_sram (
      .clk_i(clk),
      .rst_ni(1'b1),
      .cfg_i(cfg),
      .cfg_o(cfg_back),
      .read_en_i(1'b0),
      .read_addr_i({ADDR_WIDTH{1'b0}}),
      .read_data_o(rdata),
      .write_en_i(1'b0),
      .write_addr_i({ADDR_WIDTH{1'b0}}),
      .write_parts_i(1'b0),
      .write_data_i({WIDTH{1'b0}})
  );

  initial begin
    repeat (2) @(posedge clk);
    #0.1 cfg = 2'b01;
    while (!cfg_back[0] && clocks < 5000) begin
      @(posedge clk);
      #0.1 clocks = clocks + 1;
    end
    $display("%0s after %0d clocks", cfg_back[1] ? "good" : "bad", clocks);
    cfg = 2'b00;
    @(posedge clk);
    #0.1 if (cfg_back !== 2'b10) $display("a test that does not run is over or bad");
    $finish(0);
  end
endmodule

// A whole array, whose memories are tested together.
module march_array_bench;
  parameter int READOUT = 0;
  logic clk = 1'b0, rst_n = 1'b0, start = 1'b0;
  always #1 clk = !clk;
  logic [1:0] cfg = 2'b00, cfg_back;
  int clocks = 0;

  dtof_array #(
      .READOUT(READOUT),
      .NP(6),
      .NB(3),
      .PIXELS_PER_SRAM(5),
      .SRAM_NUM(3)
  ) u_array (
      .clk_i(clk),
      .rst_ni(rst_n),
      .sram_cfg_i(cfg),
      .sram_cfg_o(cfg_back),
      .start_i(start),
      .acq_num_i(16'd1),
      .gate_begin_i('0),
      .gate_end_i('0),
      .raw_i(1'b0),
      .raw_first_row_i('0),
      .raw_last_row_i('0),
      .busy_o(),
      .done_o(),
      .state_o(),
      .error_o(),
      .parity_error_o(),
      .counter_full_o(),
      .tdc_valid_i(1'b0),
      .tdc_ready_o(),
      .tdc_timestamp_i('0),
      .result_tvalid_o(),
      .result_tready_i(1'b1),
      .result_tdata_o(),
      .result_tlast_o()
  );

  initial begin
    repeat (3) @(posedge clk);
    #0.1 rst_n = 1'b1;
    repeat (3) @(posedge clk);
    // Scan: a frame begins, which would clear the memories.
    #0.1 cfg = 2'b10;
    start = 1'b1;
    @(posedge clk);
    #0.1 start = 1'b0;
    repeat (60) @(posedge clk);
    #0.1 cfg = 2'b01;
    while (!cfg_back[0] && clocks < 5000) begin
      @(posedge clk);
      #0.1 clocks = clocks + 1;
    end
    $display("%0s after %0d clocks", cfg_back[1] ? "good" : "bad", clocks);
    $finish(0);
  end
endmodule

// One memory under scan: the read data are the folded inputs, each input changes one bit, and the macro keeps its words.
module scan_bypass_bench;
  parameter int DEPTH = 12;
  parameter int WIDTH = 5;
  parameter int PORTS = 1;
  localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1;
  localparam int PARTS = (PORTS == 1) ? 1 : 0;  // bits of the write mask
  localparam int INPUTS = 2 + PORTS * ADDR_WIDTH + PARTS + WIDTH;
  logic clk = 1'b0;
  always #1 clk = !clk;
  logic [1:0] cfg = 2'b00, cfg_back;
  logic [INPUTS-1:0] inputs = '0, driven;
  logic [WIDTH-1:0] rdata, expected, reference, kept[0:DEPTH-1];
  int i, j, wrong = 0;

  generate
    if (PORTS == 1) begin : g_one
      dtof_sram_1rw #(.DEPTH(DEPTH), .WIDTH(WIDTH)) u_sram (
          .clk_i(clk), .cfg_i(cfg), .cfg_o(cfg_back), .en_i(inputs[INPUTS-1]), .we_i(inputs[INPUTS-2]),
          .addr_i(inputs[WIDTH+PARTS+:ADDR_WIDTH]), .wparts_i(inputs[WIDTH]), .wdata_i(inputs[WIDTH-1:0]), .rdata_o(rdata));
    end else begin : g_two
      dtof_sram_1r1w #(.DEPTH(DEPTH), .WIDTH(WIDTH)) u_sram (
          .clk_i(clk), .cfg_i(cfg), .cfg_o(cfg_back), .re_i(inputs[INPUTS-1]), .we_i(inputs[INPUTS-2]),
          .raddr_i(inputs[WIDTH+ADDR_WIDTH+:ADDR_WIDTH]), .waddr_i(inputs[WIDTH+:ADDR_WIDTH]), .wdata_i(inputs[WIDTH-1:0]), .rdata_o(rdata));
    end
  endgenerate

  task clocked(input logic [INPUTS-1:0] value);
    inputs = value;
    @(posedge clk);
    #0.1;
  endtask

  // An access of the macro: a write of `data` to a word, or a read.
  function automatic logic [INPUTS-1:0] access(input logic write, input int place, input logic [WIDTH-1:0] data);
    access = '0;
    access[INPUTS-1] = (PORTS == 1) || !write;
    access[INPUTS-2] = write;
    access[WIDTH+PARTS+:ADDR_WIDTH] = place;
    if (PARTS == 1) access[WIDTH] = write;
    if (PORTS == 2) access[WIDTH+(PORTS-1)*ADDR_WIDTH+:ADDR_WIDTH] = place;
    access[WIDTH-1:0] = data;
  endfunction

  initial begin
    for (i = 0; i < DEPTH; i = i + 1) begin
      kept[i] = $random;
      clocked(access(1'b1, i, kept[i]));
    end
    cfg = 2'b10;
    for (i = 0; i < 200; i = i + 1) begin
      driven = {$random, $random};
      clocked(driven);
      expected = '0;
      for (j = 0; j < INPUTS; j = j + 1) expected[j%WIDTH] = expected[j%WIDTH] ^ driven[j];
      if (rdata !== expected) wrong = wrong + 1;
      reference = rdata;
      j = i % INPUTS;
      clocked(driven ^ (1 << j));
      if ((rdata ^ reference) !== (1 << (j % WIDTH))) wrong = wrong + 1;
    end
    cfg = 2'b00;
    for (i = 0; i < DEPTH; i = i + 1) begin
      clocked(access(1'b0, i, '0));
      if (rdata !== kept[i]) wrong = wrong + 1;
    end
    $display("%0s, %0d wrong", wrong == 0 ? "good" : "bad", wrong);
    $finish(0);
  end
endmodule

`default_nettype wire
