// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_settle: of the acquisitions that leave the line buffer after a frame's start, exactly the first settle_i are dropped, each
// from its first line to its last. After an abort no acquisition is dropped, after a timeout only an acquisition that has begun to leave.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module settle_properties #(
    parameter int WIDTH = 3
) (
    input logic             clk_i,
    input logic             reset_i,
    input logic [WIDTH-1:0] settle_i,
    input logic             begin_i,
    input logic             abort_i,
    input logic             give_up_i,
    input logic             first_i,
    input logic             last_i
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  logic drops, takes;

  dtof_settle #(
      .WIDTH(WIDTH)
  ) u_dut (
      .clk_i    (clk_i),
      .rst_ni   (rst_n),
      .settle_i (settle_i),
      .begin_i  (begin_i),
      .abort_i  (abort_i),
      .give_up_i(give_up_i),
      .first_i  (first_i),
      .last_i   (last_i),
      .drops_o  (drops),
      .takes_o  (takes)
  );

  // The reference counts upwards: acquisitions that have left since the frame began, and acquisitions to drop.
  localparam logic [WIDTH:0] MOST = {1'b1, {WIDTH{1'b0}}};
  logic [WIDTH:0] left_q;      // at most MOST, which is more than any frame drops
  logic [WIDTH:0] dropping_q;  // acquisitions that the frame drops
  logic leaving_q;             // between the first and the last line of an acquisition

  `ASSUME(m_first, !first_i || !leaving_q)
  `ASSUME(m_last, !last_i || leaving_q || first_i)
  `ASSUME(m_begin, !begin_i || (!leaving_q && !first_i && !abort_i && !give_up_i))
  `ASSUME(m_give_up, !give_up_i || (!first_i && !last_i && !abort_i))

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      left_q <= '0;
      dropping_q <= '0;
      leaving_q <= 1'b0;
    end else begin
      leaving_q <= (first_i || leaving_q) && !last_i && !abort_i;
      if (begin_i) begin
        left_q <= '0;
        dropping_q <= {1'b0, settle_i};
      end else begin
        if (last_i && left_q != MOST) begin
          left_q <= left_q + 1'b1;
        end
        if (abort_i) begin
          dropping_q <= '0;
        end else if (give_up_i && left_q < dropping_q) begin
          dropping_q <= left_q + (WIDTH + 1)'(leaving_q);
        end
      end
    end
  end

  `PROVE(a_drops, !rst_n || drops == (left_q < dropping_q))
  `PROVE(a_takes, !rst_n || takes == (leaving_q && left_q < dropping_q))
  `GOAL(rst_n && dropping_q == (WIDTH + 1)'(2) && left_q == (WIDTH + 1)'(3))

endmodule

`default_nettype wire
