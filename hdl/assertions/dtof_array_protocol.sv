// SPDX-License-Identifier: Apache-2.0
// The ports of an array (dtof_array, dtof_pool_pointer_array) as concurrent assertions and covers, for simulators that have them.
// Synthesis does not read this folder.
//
// Assertions: a start in an idle array makes it busy in the next clock; it stays busy until done; done is high for one clock within busy;
// an acquisition that has begun has a line in each of its LINES clocks; the array is ready during all of them; the memories' side band does
// not change during a frame.
// Source: docs/user/integration.md, ports of an array.
// Covers: a frame, two frames in a row, a start while busy, acquisitions in a row, a pause between acquisitions.
// Latency: none. Cost: none in silicon.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_array_protocol #(
    parameter int LINES = 4,     // lines of an acquisition
    parameter int CFG_WIDTH = 1  // bits of the memories' side band
) (
    input logic clk_i,
    input logic rst_ni,
    input logic [CFG_WIDTH-1:0] sram_cfg_i,
    input logic start_i,
    input logic busy_i,
    input logic done_i,
    input logic tdc_valid_i,
    input logic tdc_ready_i
);

  localparam int WIDTH = $clog2(LINES + 1);

  logic [WIDTH-1:0] line_q;  // lines received of the present acquisition

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      line_q <= '0;
    end else if (line_q != 0 || (tdc_valid_i && tdc_ready_i)) begin
      line_q <= (line_q == WIDTH'(LINES - 1)) ? '0 : line_q + 1'b1;
    end
  end

  a_start :
  assert property (@(posedge clk_i) disable iff (!rst_ni) start_i && !busy_i |=> busy_i)
  else $error("%m: the array did not begin");

  a_busy_stays :
  assert property (@(posedge clk_i) disable iff (!rst_ni) busy_i && !done_i |=> busy_i)
  else $error("%m: busy fell before done");

  a_done :
  assert property (@(posedge clk_i) disable iff (!rst_ni) done_i |-> busy_i)
  else $error("%m: done outside of busy");

  a_done_is_one_clock :
  assert property (@(posedge clk_i) disable iff (!rst_ni) done_i |=> !done_i && !busy_i)
  else $error("%m: busy or done in the clock behind done");

  a_whole_acquisition :
  assert property (@(posedge clk_i) disable iff (!rst_ni) line_q != 0 |-> tdc_valid_i)
  else $error("%m: the source left a gap inside an acquisition");

  a_ready_stays :
  assert property (@(posedge clk_i) disable iff (!rst_ni) line_q != 0 |-> tdc_ready_i)
  else $error("%m: the array was not ready inside an acquisition");

  a_side_band_stays :
  assert property (@(posedge clk_i) disable iff (!rst_ni) busy_i |-> $stable(sram_cfg_i))
  else $error("%m: sram_cfg_i changed during a frame");

  c_frame : cover property (@(posedge clk_i) disable iff (!rst_ni) done_i);
  c_start_while_busy : cover property (@(posedge clk_i) disable iff (!rst_ni) start_i && busy_i);
  c_acquisition : cover property (@(posedge clk_i) disable iff (!rst_ni) line_q == WIDTH'(LINES - 1));
  c_in_a_row :
  cover property (@(posedge clk_i) disable iff (!rst_ni) line_q == 0 && tdc_valid_i && tdc_ready_i && $past(line_q == WIDTH'(LINES - 1)));
  c_pause : cover property (@(posedge clk_i) disable iff (!rst_ni) busy_i && line_q == 0 && !tdc_valid_i && $past(line_q == WIDTH'(LINES - 1)));

endmodule

`default_nettype wire
