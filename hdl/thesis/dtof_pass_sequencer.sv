// SPDX-License-Identifier: Apache-2.0
// Decides which acquisitions belong to the current pass: the split of a frame into measurements, once per array.
//
// Equation (docs/reference/readouts.md): pass r of P = COARSE_PASSES + 1 ends before acquisition floor(A * (r + 1) / P), A = acq_num_i.
// Acquisition a belongs to pass r while left = A * (r + 1) - P * (a + 1) >= 0. One signed accumulator decides this: an acquisition
// subtracts P, a new pass adds A.
// Three steps split floor(A / 2) into P = 3 passes in the same way. The remaining acquisitions belong to the final pass, which
// ends when a second counter, A - (a + 1), falls below zero.
// Gears (fractional pointers): with l acquisitions left of the L of the final pass, the gear is the largest g with
// l <= L >> g. So the step is halved each time half of the remaining acquisitions are done.
//
// Latency: more_o and gear_o are valid in the clock after load_i, next_pass_i or acq_done_i.
// Cost: one accumulator of about ACQ_WIDTH + 2 bits per array; for GEARS > 0 a threshold of ACQ_WIDTH bits more.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pass_sequencer #(
    parameter int COARSE_PASSES = 1,
    parameter int THREE_STEPS = 0,  // 1: the split of three steps
    parameter int GEARS = 0,        // highest gear, FRACTION_BITS of a pointer read-out
    parameter int ACQ_WIDTH = 16,
    localparam int GEAR_WIDTH = dtof_pkg::index_width(GEARS + 1)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  load_i,       // a frame starts with acq_num_i
    input  logic [ACQ_WIDTH-1:0]  acq_num_i,    // stable from load_i to the end of the frame
    input  logic                  next_pass_i,  // the next pass starts
    input  logic                  final_i,      // with next_pass_i: that pass is the final one
    input  logic                  acq_done_i,   // an acquisition of this pass is complete
    output logic                  more_o,       // another acquisition belongs to this pass
    output logic [GEAR_WIDTH-1:0] gear_o        // gear of the present acquisition
);

  localparam int PARTS = (THREE_STEPS != 0) ? 3 : COARSE_PASSES + 1;
  localparam int LEFT_WIDTH = dtof_pkg::max_of(ACQ_WIDTH, $clog2(PARTS + 1)) + 2;

  logic signed [LEFT_WIDTH-1:0] left_d, left_q, base;
  logic final_pass_q;  // used by read-outs whose final pass differs: three steps, gears

  assign base = (THREE_STEPS != 0) ? LEFT_WIDTH'(acq_num_i) >> 1 : LEFT_WIDTH'(acq_num_i);

  always_comb begin
    left_d = left_q;
    if (load_i) begin
      left_d = base - LEFT_WIDTH'(PARTS);
    end else if (next_pass_i) begin
      left_d = left_q + base;
    end else if (acq_done_i) begin
      left_d = left_q - LEFT_WIDTH'(PARTS);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q <= '1;
      final_pass_q <= 1'b0;
    end else begin
      left_q <= left_d;
      if (load_i) begin
        final_pass_q <= (COARSE_PASSES == 0);
      end else if (next_pass_i) begin
        final_pass_q <= final_i;
      end
    end
  end

  generate
    if (THREE_STEPS != 0) begin : g_three_steps
      logic signed [ACQ_WIDTH:0] left_in_frame_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          left_in_frame_q <= '1;
        end else if (load_i) begin
          left_in_frame_q <= $signed({1'b0, acq_num_i} - 1'b1);
        end else if (acq_done_i) begin
          left_in_frame_q <= left_in_frame_q - (ACQ_WIDTH + 1)'(1);
        end
      end
      assign more_o = final_pass_q ? !left_in_frame_q[ACQ_WIDTH] : !left_q[LEFT_WIDTH-1];
    end else begin : g_equal_passes
      assign more_o = !left_q[LEFT_WIDTH-1];
    end
  endgenerate

  generate
    if (GEARS > 0) begin : g_gear
      // In the final pass left_q is PARTS * (l - 1); PARTS is 1 or 2 in pointer read-outs.
      localparam int PARTS_SHIFT = $clog2(PARTS);
      logic [GEAR_WIDTH-1:0] gear_q;
      logic [ACQ_WIDTH-1:0] threshold_q;
      logic [ACQ_WIDTH-1:0] final_length;
      logic signed [LEFT_WIDTH-1:0] left_after;

      assign final_length = (COARSE_PASSES == 0) ? acq_num_i : acq_num_i - (acq_num_i >> 1);
      assign left_after = left_q >>> PARTS_SHIFT;

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          gear_q <= '0;
          threshold_q <= '0;
        end else if (load_i) begin
          gear_q <= '0;
          threshold_q <= final_length >> 1;
        end else if (final_pass_q && acq_done_i && gear_q != GEAR_WIDTH'(GEARS)
                     && left_after <= $signed(LEFT_WIDTH'(threshold_q))) begin
          gear_q <= gear_q + 1'b1;
          threshold_q <= threshold_q >> 1;
        end
      end
      assign gear_o = gear_q;
    end else begin : g_no_gear
      assign gear_o = '0;
    end
  endgenerate

endmodule

`default_nettype wire
