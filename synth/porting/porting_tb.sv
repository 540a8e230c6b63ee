// SPDX-License-Identifier: Apache-2.0
// Two columns of ezPointer on a single-port SRAM read out a pseudo-random frame; the bench prints every result. The test
// compiles the bench once with the behavioural SRAM and once with the wrapper, and compares the lines.
module porting_tb;

  localparam int NP = 10;
  localparam int SRAM_NUM = 2;

  reg clk = 1'b0;
  reg rst_n = 1'b0;
  reg start = 1'b0;
  reg [31:0] random = 32'd1;
  wire busy, done, ready, valid, last;
  wire [2:0] state;
  wire [22:0] data;
  integer results = 0;

  always #1 clk = !clk;

  dtof_array #(
      .READOUT      (0),
      .NP           (NP),
      .SRAM_NUM     (SRAM_NUM),
      .POINTER_PORTS(1)
  ) u_array (
      .clk_i          (clk),
      .rst_ni         (rst_n),
      .sram_cfg_i     ('0),
      .start_i        (start),
      .acq_num_i      (16'd40),
      .gate_begin_i   ({NP{1'b0}}),
      .gate_end_i     ({NP{1'b0}}),
      .raw_i          (1'b0),
      .raw_first_row_i(8'd0),
      .raw_last_row_i (8'd0),
      .busy_o         (busy),
      .done_o         (done),
      .state_o        (state),
      .tdc_valid_i    (1'b1),
      .tdc_ready_o    (ready),
      .tdc_timestamp_i(random[SRAM_NUM*NP-1:0]),
      .result_tvalid_o(valid),
      .result_tready_i(1'b1),
      .result_tdata_o (data),
      .result_tlast_o (last)
  );

  // A new pseudo-random word (xorshift) for every accepted timestamp.
  function [31:0] next(input [31:0] value);
    reg [31:0] mixed;
    begin
      mixed = value ^ (value << 13);
      mixed = mixed ^ (mixed >> 17);
      next = mixed ^ (mixed << 5);
    end
  endfunction

  always @(posedge clk) begin
    if (ready) random <= next(random);
    if (valid) begin
      $display("result %h %b", data, last);
      results = results + 1;
    end
    if (done) begin
      $display("results %0d", results);
      $finish;
    end
  end

  initial begin
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
    @(negedge clk) start = 1'b1;
    @(negedge clk) start = 1'b0;
    repeat (100000) @(negedge clk);
    $display("timeout");
    $finish;
  end

endmodule
