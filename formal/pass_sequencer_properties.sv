// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pass_sequencer: the acquisitions of each pass, and the gear of each acquisition, follow the divisions of the
// specification, for every number of acquisitions that ACQ_WIDTH allows.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pass_sequencer_properties #(
    parameter int COARSE_PASSES = 1,
    parameter int THREE_STEPS = 0,
    parameter int GEARS = 0,
    parameter int ACQ_WIDTH = 6,
    localparam int GEAR_WIDTH = dtof_pkg::index_width(GEARS + 1)
) (
    input logic                 clk_i,
    input logic                 load_i,
    input logic [ACQ_WIDTH-1:0] acq_num_i,
    input logic                 next_pass_i,
    input logic                 acq_done_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  localparam int PASS_WIDTH = $clog2(COARSE_PASSES + 2);
  logic loaded_q, load_q, more;
  logic [PASS_WIDTH-1:0] pass_q;
  logic [ACQ_WIDTH-1:0] done_q, acq_num_q;
  logic [GEAR_WIDTH-1:0] gear;

  dtof_pass_sequencer #(
      .COARSE_PASSES(COARSE_PASSES),
      .THREE_STEPS  (THREE_STEPS),
      .GEARS        (GEARS),
      .ACQ_WIDTH    (ACQ_WIDTH)
  ) u_dut (
      .clk_i      (clk_i),
      .rst_ni     (checking),
      .load_i     (load_i),
      .acq_num_i  (acq_num_i),
      .next_pass_i(next_pass_i),
      .final_i    (32'(pass_q) + 1 == COARSE_PASSES),
      .acq_done_i (acq_done_i),
      .more_o     (more),
      .gear_o     (gear)
  );

  always_ff @(posedge clk_i) begin
    acq_num_q <= acq_num_i;
    if (!checking) begin
      loaded_q <= 1'b0;
      load_q <= 1'b0;
    end else begin
      load_q <= load_i;
      if (load_i) begin
        loaded_q <= 1'b1;
        pass_q <= '0;
        done_q <= '0;
      end else begin
        if (next_pass_i) pass_q <= pass_q + 1'b1;
        if (acq_done_i) done_q <= done_q + 1'b1;
      end
    end
  end

  // Acquisition a belongs to the pass if a < pass_end.
  logic [ACQ_WIDTH+PASS_WIDTH:0] all, first_half, product, pass_end, final_begin, final_length, in_final, after_gear;
  logic [GEAR_WIDTH-1:0] expected_gear;
  logic final_pass;
  integer g;
  always_comb begin
    all = (ACQ_WIDTH + PASS_WIDTH + 1)'(acq_num_i);
    first_half = all >> 1;
    final_pass = (32'(pass_q) == COARSE_PASSES);
    if (THREE_STEPS != 0) begin
      product = first_half * (ACQ_WIDTH + PASS_WIDTH + 1)'(pass_q + (PASS_WIDTH + 1)'(1));
      pass_end = final_pass ? all : product / (ACQ_WIDTH + PASS_WIDTH + 1)'(3);
    end else begin
      product = all * (ACQ_WIDTH + PASS_WIDTH + 1)'(pass_q + (PASS_WIDTH + 1)'(1));
      pass_end = product / (ACQ_WIDTH + PASS_WIDTH + 1)'(COARSE_PASSES + 1);
    end
    // The gear is the largest g with a >= L - (L >> g); a is counted within the final pass of L acquisitions.
    final_begin = (COARSE_PASSES == 0) ? '0 : first_half;
    final_length = all - final_begin;
    in_final = (ACQ_WIDTH + PASS_WIDTH + 1)'(done_q) - final_begin;
    expected_gear = '0;
    after_gear = '0;
    for (g = 1; g <= GEARS; g = g + 1) begin
      after_gear = final_length - (final_length >> g);
      if (in_final >= after_gear) expected_gear = GEAR_WIDTH'(g);
    end
  end

  logic steady;
  assign steady = loaded_q && !load_i;

  `ASSUME(m_number_is_held, !(load_q || (loaded_q && !load_i)) || acq_num_i == acq_num_q || (load_i && !load_q))
  `ASSUME(m_load_first, loaded_q || load_i || (!acq_done_i && !next_pass_i))
  `ASSUME(m_done_of_this_pass, !acq_done_i || (steady && more && !next_pass_i))
  `ASSUME(m_next_after_the_last, !next_pass_i || (steady && !more && 32'(pass_q) < COARSE_PASSES))
  `PROVE(a_more, !steady || more == ((ACQ_WIDTH + PASS_WIDTH + 1)'(done_q) < pass_end))
  `PROVE(a_gear, GEARS == 0 || !(steady && final_pass && more) || gear == expected_gear)
  `GOAL(steady && final_pass && !more && (&acq_num_i))

endmodule

`default_nettype wire
