// SPDX-License-Identifier: Apache-2.0
// APB4 as concurrent assertions and covers, for simulators that have them. Synthesis does not read this folder.
//
// Assertions: each access follows its setup in the next clock, and each access has a setup; address, direction, data and strobes are stable
// until pready; pslverr is high only with pready. penable without psel is an access to another slave.
// Source: AMBA APB Protocol Specification (IHI 0024), sections 3 and 4.
// Covers: a write, a read, an access with wait states, a refused access, two transfers in a row.
// Latency: none. Cost: none in silicon.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_apb_protocol #(
    parameter int ADDR_WIDTH = 12
) (
    input logic                  clk_i,
    input logic                  rst_ni,
    input logic                  psel_i,
    input logic                  penable_i,
    input logic                  pwrite_i,
    input logic [ADDR_WIDTH-1:0] paddr_i,
    input logic [          31:0] pwdata_i,
    input logic [           3:0] pstrb_i,
    input logic                  pready_i,
    input logic                  pslverr_i
);

  a_access_follows_setup :
  assert property (@(posedge clk_i) disable iff (!rst_ni) psel_i && !penable_i |=> psel_i && penable_i)
  else $error("%m: the master's setup has no access behind it");

  a_access_has_a_setup :
  assert property (@(posedge clk_i) disable iff (!rst_ni) psel_i && penable_i |-> $past(psel_i && !(penable_i && pready_i)))
  else $error("%m: the master's access has no setup in front of it");

  a_access_stays :
  assert property (@(posedge clk_i) disable iff (!rst_ni) psel_i && penable_i && !pready_i |=> psel_i && penable_i)
  else $error("%m: the master ended an access before pready");

  a_address_stays :
  assert property (@(posedge clk_i) disable iff (!rst_ni)
                   psel_i && !(penable_i && pready_i) |=> $stable(paddr_i) && $stable(pwrite_i) && $stable(pstrb_i))
  else $error("%m: the master changed the address, the direction or the strobes within a transfer");

  a_data_stay :
  assert property (@(posedge clk_i) disable iff (!rst_ni) psel_i && pwrite_i && !(penable_i && pready_i) |=> $stable(pwdata_i))
  else $error("%m: the master changed the data of a write");

  a_error_with_ready :
  assert property (@(posedge clk_i) disable iff (!rst_ni) psel_i && penable_i && pslverr_i |-> pready_i)
  else $error("%m: the registers' pslverr is high without pready");

  c_write : cover property (@(posedge clk_i) disable iff (!rst_ni) psel_i && penable_i && pready_i && pwrite_i && !pslverr_i);
  c_read : cover property (@(posedge clk_i) disable iff (!rst_ni) psel_i && penable_i && pready_i && !pwrite_i && !pslverr_i);
  c_wait : cover property (@(posedge clk_i) disable iff (!rst_ni) psel_i && penable_i && !pready_i);
  c_refused : cover property (@(posedge clk_i) disable iff (!rst_ni) psel_i && penable_i && pready_i && pslverr_i);
  c_in_a_row : cover property (@(posedge clk_i) disable iff (!rst_ni) psel_i && !penable_i && $past(psel_i && penable_i && pready_i));

endmodule

`default_nettype wire
