// SPDX-License-Identifier: Apache-2.0
// An AXI4-Stream as concurrent assertions and covers, for simulators that have them. Synthesis does not read this folder.
//
// Assertions: after tvalid without tready, tvalid stays high and the data are stable until tready; tvalid and tready are not X or Z.
// Source: AMBA AXI4-Stream Protocol Specification, section 2.2.1.
// Covers: a transfer at once, a transfer that was held up, two transfers in a row, a pause, the last word of a packet.
// WHOSE names the side that breaks a rule in the message.
// Latency: none. Cost: none in silicon.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_stream_protocol #(
    parameter int WIDTH = 8,
    parameter     WHOSE = "the source"
) (
    input logic             clk_i,
    input logic             rst_ni,
    input logic             tvalid_i,
    input logic             tready_i,
    input logic [WIDTH-1:0] tdata_i,
    input logic             tlast_i
);

  a_valid_stays :
  assert property (@(posedge clk_i) disable iff (!rst_ni) tvalid_i && !tready_i |=> tvalid_i)
  else $error("%m: %s took tvalid away before tready", WHOSE);

  a_data_stay :
  assert property (@(posedge clk_i) disable iff (!rst_ni) tvalid_i && !tready_i |=> $stable(tdata_i) && $stable(tlast_i))
  else $error("%m: %s changed tdata or tlast before tready", WHOSE);

  a_known :
  assert property (@(posedge clk_i) disable iff (!rst_ni) !$isunknown(tvalid_i) && !$isunknown(tready_i))
  else $error("%m: tvalid or tready is unknown");

  c_at_once : cover property (@(posedge clk_i) disable iff (!rst_ni) tvalid_i && tready_i);
  c_held_up : cover property (@(posedge clk_i) disable iff (!rst_ni) tvalid_i && $past(tvalid_i && !tready_i));
  c_in_a_row : cover property (@(posedge clk_i) disable iff (!rst_ni) tvalid_i && tready_i && $past(tvalid_i && tready_i));
  c_pause : cover property (@(posedge clk_i) disable iff (!rst_ni) !tvalid_i && $past(tvalid_i && tready_i && !tlast_i));
  c_last : cover property (@(posedge clk_i) disable iff (!rst_ni) tvalid_i && tready_i && tlast_i);

endmodule

`default_nettype wire
