// SPDX-License-Identifier: Apache-2.0
// Reference of poolPointer's pointer phase (docs/reference/poolpointer.md, "Timestamps", "Thinning", "Point"), with the thesis's cells: a
// pixel's word after an acquisition in which the pixel has one or two timestamps. In signed integers of W bits.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_point_reference #(
    parameter int W = 18
) (
    input  logic signed [W-1:0] preferred_i,
    input  logic signed [W-1:0] other_i,
    input  logic               two_i,
    input  logic [W-1:0]        acquisition_i,
    input  logic signed [W-1:0] pointer_i,      // pa
    input  logic signed [W-1:0] rival_i,        // pb
    input  logic [W-1:0]        advantage_i,    // n
    output logic signed [W-1:0] pointer_o,
    output logic signed [W-1:0] rival_o,
    output logic [W-1:0]        advantage_o
);

  function automatic logic is_inside(input logic signed [W-1:0] x, input logic signed [W-1:0] pointer);
    logic signed [W-1:0] away;
    away = (x >>> 9) - (pointer >>> 9);
    is_inside = away >= -8 && away <= 7;
  endfunction

  function automatic logic [W-1:0] weight(input logic signed [W-1:0] e);
    logic [W-1:0] d;
    d = (e < 0) ? -1 - e : e;
    weight = (d == 32'd0 || d == 32'd7) ? 32'd1 : (d == 32'd1 || d == 32'd5) ? 32'd3 : (d == 32'd6) ? 32'd2 : (d < 32'd6) ? 32'd4 : 32'd0;
  endfunction

  // Logarithm to base 2 of gear(n).
  function automatic logic [3:0] gear(input logic [W-1:0] n);
    gear = (n < 32'd8) ? 4'd8 : (n < 32'd16) ? 4'd7 : (n < 32'd32) ? 4'd6 : (n < 32'd64) ? 4'd5 : (n < 32'd80) ? 4'd4
        : (n < 32'd100) ? 4'd3 : (n < 32'd116) ? 4'd2 : (n < 32'd124) ? 4'd1 : 4'd0;
  endfunction

  logic signed [W-1:0] x, e, f, move;
  logic [W-1:0] level, every;
  logic hit, near_rival, counted;

  always_comb begin
    x = (two_i && !is_inside(preferred_i, pointer_i) && is_inside(other_i, pointer_i)) ? other_i : preferred_i;
    e = (x - pointer_i) >>> 9;
    hit = e >= -5 && e <= 4;
    f = (x >>> 9) - rival_i;
    near_rival = !hit && f >= -6 && f < 6;
    level = (((acquisition_i >> 4) & 32'd3) != 32'd0) ? 32'd7
        : {29'd0, acquisition_i[6], acquisition_i[7], acquisition_i[8]};
    every = (advantage_i < 32'd64) ? 32'd0 : (advantage_i < 32'd96) ? 32'd3 : 32'd15;
    counted = !(level < 32'd7 - (x >> 13)) && (acquisition_i & every) == 32'd0;
    move = (((weight(e) << gear(advantage_i)) + ((acquisition_i & 32'd3) << 1) + ((acquisition_i >> 2) & 32'd1)) >> 2) & ~32'd1;
    pointer_o = pointer_i;
    rival_o = rival_i;
    advantage_o = advantage_i;
    if (e >= -8 && e <= 7) begin
      pointer_o = (e >= 0) ? pointer_i + move : pointer_i - move;
      if (pointer_o < 0) pointer_o = 0;
      if (pointer_o > 65534) pointer_o = 65534;
    end
    if (near_rival && f != 0) rival_o = (f > 0) ? rival_i + 1 : rival_i - 1;
    if (hit && counted && advantage_i < 32'd127) advantage_o = advantage_i + 32'd1;
    if (near_rival && advantage_i != 32'd0 && counted) advantage_o = advantage_i - 32'd1;
    if (near_rival && advantage_i == 32'd0) begin
      pointer_o = (rival_i <<< 9) + 256;
      rival_o = pointer_i >>> 9;
      advantage_o = 32'd1;
    end
  end

endmodule

`default_nettype wire
