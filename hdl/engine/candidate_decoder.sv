// SPDX-License-Identifier: Apache-2.0
// poolPointer: finds the candidate depths of a group of pixels in its coarse histogram and its neighbours'.
//
// Equations (docs/reference/poolpointer.md, Decode): pair sums o of the group, w = 3 o + those of both neighbours;
// K times the largest not taken, of w for the first three, of o for the others; its cell from its neighbours' tilt; a
// quarter of its excess over the background is taken from the pairs two away. B from the least of four octets.
//
// 1. The words of three groups, each captured a clock after the one before it, shift out bin by bin; a bin's sum over
//    the groups is added up on the way.
// 2. Sums of two adjacent bins enter a ring of 32: pair -1 first, which holds nothing and counts as taken.
// 3. The ring turns once a candidate. While it passes its head, the largest pair that is not taken is kept, with its two
//    neighbours.
// 4. In the next turn's first two clocks the candidate's tilt and then its cell are found; during that turn what it
//    takes away leaves the pairs on their way to the head.
//
// Schedule: the table of engine_sequencer, with this module's POOL_DECODER_*_CLOCKS (dtof_pkg).
// Cost with 8 candidates and counts of 8 bits: 704 flip-flops of ring, 192 of shift registers, per engine.
`include "engine_command.svh"

module candidate_decoder #(
    parameter int COUNT_WIDTH = 8,    // bits of a coarse bin
    parameter int LABELS = 8,         // candidates of a group
    parameter int BINS_PER_WORD = 8,  // coarse bins of a word
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int BACKGROUND_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH,
    localparam int LINE_WIDTH = BINS_PER_WORD * COUNT_WIDTH
) (
    input  logic                         clk_i,
    input  decode_command_t              command_i,
    input  logic [       LINE_WIDTH-1:0] line_i,       // with a capture: a word's bins, lowest first
    // the newest candidate is the last cell; both valid from a clock after command_i.candidate until the next one
    output logic [LABELS*CELL_WIDTH-1:0] cells_o,
    output logic [ BACKGROUND_WIDTH-1:0] background_o  // until the next group fills the ring
);

  localparam int OWN_WIDTH = COUNT_WIDTH + 1;
  localparam int BIN_SUM_WIDTH = COUNT_WIDTH + 3;
  localparam int POOLED_WIDTH = COUNT_WIDTH + 4;
  localparam int ENTRY_WIDTH = POOLED_WIDTH + OWN_WIDTH + 1;
  localparam int ENTRIES = dtof_pkg::POOL_COARSE_BINS;
  localparam int OCTET_WIDTH = COUNT_WIDTH + 3;
  localparam logic [5:0] NOWHERE = 6'd48;  // not even two away from a pair

  // Bins: above at one clock, own the next, below the next.

  logic [LINE_WIDTH-1:0] above_q, own_q, below_q;
  logic [COUNT_WIDTH-1:0] above_bin_q, own_bin_q, summed_bin_q, last_bin_q;
  logic [BIN_SUM_WIDTH-1:0] partial_q, bin_sum_q, last_sum_q;

  always_ff @(posedge clk_i) begin
    above_q <= command_i.capture_above ? line_i : above_q >> COUNT_WIDTH;
    own_q <= command_i.capture_own ? line_i : own_q >> COUNT_WIDTH;
    below_q <= command_i.capture_below ? line_i : below_q >> COUNT_WIDTH;
    above_bin_q <= above_q[COUNT_WIDTH-1:0];
    own_bin_q <= own_q[COUNT_WIDTH-1:0];
    partial_q <= BIN_SUM_WIDTH'(above_bin_q) + BIN_SUM_WIDTH'(own_q[COUNT_WIDTH-1:0])
        + (BIN_SUM_WIDTH'(own_q[COUNT_WIDTH-1:0]) << 1);
    bin_sum_q <= partial_q + BIN_SUM_WIDTH'(below_q[COUNT_WIDTH-1:0]);
    summed_bin_q <= own_bin_q;
    last_bin_q <= summed_bin_q;
    last_sum_q <= bin_sum_q;
  end

  // Background, and the least pair sum.

  logic [OCTET_WIDTH-1:0] octet_q, least_octet_q;
  logic octet_full_q, first_octet_q;
  logic [OWN_WIDTH-1:0] own_pair, least_pair_q;
  logic [POOLED_WIDTH-1:0] pooled_pair;
  logic [OCTET_WIDTH+2:0] five_octets;

  assign own_pair = OWN_WIDTH'(summed_bin_q) + OWN_WIDTH'(last_bin_q);
  assign pooled_pair = POOLED_WIDTH'(bin_sum_q) + POOLED_WIDTH'(last_sum_q);

  always_ff @(posedge clk_i) begin
    octet_full_q <= command_i.fill && (command_i.pair[2:0] == 3'd7);
    first_octet_q <= (command_i.pair[4:3] == 2'd0);
    if (octet_full_q && (first_octet_q || octet_q < least_octet_q)) begin
      least_octet_q <= octet_q;
    end
    octet_q <= command_i.fill ? (octet_full_q ? '0 : octet_q) + OCTET_WIDTH'(summed_bin_q) : '0;
    if (command_i.fill) begin
      if (command_i.pair == 5'd1 || (command_i.pair != 5'd0 && own_pair < least_pair_q)) begin
        least_pair_q <= own_pair;
      end
    end
  end

  assign five_octets = (OCTET_WIDTH + 3)'(least_octet_q) + ((OCTET_WIDTH + 3)'(least_octet_q) << 2);
  assign background_o = BACKGROUND_WIDTH'(five_octets >> COUNT_WIDTH);

  // The ring: {taken, own, pooled}. What the last candidate takes away leaves an entry on its way to the head.

  logic [ENTRIES*ENTRY_WIDTH-1:0] ring_q;
  logic [ENTRY_WIDTH-1:0] next_head, empty_pair, entry;
  logic head_taken, taken;
  logic [OWN_WIDTH-1:0] head_own, next_own, own, own_part, own_part_q, own_excess, own_excess_q;
  logic [POOLED_WIDTH-1:0] head_pooled, next_pooled, pooled, pooled_part, pooled_part_q;
  logic [POOLED_WIDTH-1:0] pooled_excess, pooled_excess_q;
  logic [5:0] peak_q, from_peak;
  logic new_peak_q, next_taken, beside, beside_q, two_away, two_away_q;
  logic [4:0] best_pair_q;

  assign head_pooled = ring_q[POOLED_WIDTH-1:0];
  assign head_own = ring_q[POOLED_WIDTH+:OWN_WIDTH];
  assign head_taken = ring_q[ENTRY_WIDTH-1];
  assign next_head = ring_q[2*ENTRY_WIDTH-1:ENTRY_WIDTH];
  assign next_taken = next_head[ENTRY_WIDTH-1];
  assign next_pooled = next_head[POOLED_WIDTH-1:0];
  assign next_own = next_head[POOLED_WIDTH+:OWN_WIDTH];

  // With pair 0 at the head the peak is new: what is registered is still of the one before. Its excess was
  // registered a clock after it was found, in time for pair 1, which only an early peak reaches.
  assign beside = new_peak_q ? !command_i.first_label && (best_pair_q == 5'd1 || best_pair_q == 5'd2) : beside_q;
  assign two_away = new_peak_q ? !command_i.first_label && (best_pair_q == 5'd3) : two_away_q;
  assign own_part = new_peak_q ? own_excess_q >> 2 : own_part_q;
  assign pooled_part = new_peak_q ? pooled_excess_q >> 2 : pooled_part_q;
  assign from_peak = {1'b0, command_i.pair} + 6'd2 - peak_q;

  always_comb begin
    taken = next_taken || beside;
    own = next_own;
    pooled = next_pooled;
    if (two_away) begin
      own = (next_own > own_part) ? next_own - own_part : '0;
      pooled = (next_pooled > pooled_part) ? next_pooled - pooled_part : '0;
    end
  end

  assign empty_pair = {1'b1, {(ENTRY_WIDTH - 1) {1'b0}}};
  assign entry = command_i.fill ? ((command_i.pair == 5'd0) ? empty_pair : {1'b0, own_pair, pooled_pair})
      : command_i.search ? {head_taken, head_own, head_pooled} : '0;

  always_ff @(posedge clk_i) begin
    ring_q <= {entry, ring_q[ENTRIES*ENTRY_WIDTH-1:2*ENTRY_WIDTH], taken, own, pooled};
    new_peak_q <= (command_i.pair == 5'd31);
    if (new_peak_q) begin  // for pair 2
      beside_q <= !command_i.first_label && (best_pair_q <= 5'd3);
      two_away_q <= !command_i.first_label && (best_pair_q == 5'd4);
    end else begin
      beside_q <= (from_peak == 6'd0) || (from_peak == 6'd1) || (from_peak == 6'd63);
      two_away_q <= (from_peak == 6'd2) || (from_peak == 6'd62);
    end
    own_excess_q <= own_excess;
    pooled_excess_q <= pooled_excess;
  end

  // The largest of a turn, the lowest on a tie, with its neighbours.

  logic found_q, next_pending_q, better;
  logic [OWN_WIDTH-1:0] best_own_q;
  logic [POOLED_WIDTH-1:0] value, best_pooled_q, best_q, before_q, after_q, last_value_q;

  assign value = command_i.pooled ? head_pooled : POOLED_WIDTH'(head_own);
  assign better = !head_taken && (!found_q || value > best_q);

  always_ff @(posedge clk_i) begin
    last_value_q <= value;
    if (command_i.pair == 5'd0) begin
      found_q <= 1'b0;
      next_pending_q <= 1'b0;
    end else begin
      next_pending_q <= better;
      if (better) begin
        found_q <= 1'b1;
        best_pair_q <= command_i.pair;
        best_q <= value;
        best_own_q <= head_own;
        best_pooled_q <= head_pooled;
        before_q <= last_value_q;
        after_q <= '0;  // beyond the last pair
      end else if (next_pending_q) begin
        after_q <= value;
      end
    end
  end

  // A turn later (pair = 0): what the candidate takes away, and its tilt; then (pair = 1) its cell.

  logic [POOLED_WIDTH-1:0] tilt_q, height, lower_q, five_least;
  logic tilted, upwards, upwards_q;
  logic [CELL_WIDTH-1:0] peak_cell;
  logic [LABELS*CELL_WIDTH-1:0] cells_q;

  assign upwards = (after_q > before_q);
  assign height = best_q - lower_q;
  assign tilted = (best_q > lower_q) && ({tilt_q, 1'b0} > {1'b0, height});
  assign peak_cell = {best_pair_q, 2'b00} + (tilted ? (upwards_q ? CELL_WIDTH'(1) : '1) : '0);
  assign own_excess = (best_own_q > least_pair_q) ? best_own_q - least_pair_q : '0;
  assign five_least = POOLED_WIDTH'(least_pair_q) + (POOLED_WIDTH'(least_pair_q) << 2);
  assign pooled_excess = (best_pooled_q > five_least) ? best_pooled_q - five_least : '0;

  always_ff @(posedge clk_i) begin
    upwards_q <= upwards;
    tilt_q <= upwards ? after_q - before_q : before_q - after_q;
    lower_q <= upwards ? before_q : after_q;
    if (command_i.search && new_peak_q) begin
      peak_q <= command_i.first_label ? NOWHERE : {1'b0, best_pair_q};
      own_part_q <= own_excess >> 2;
      pooled_part_q <= pooled_excess >> 2;
    end
    if (command_i.candidate) begin
      cells_q <= {peak_cell, cells_q[LABELS*CELL_WIDTH-1:CELL_WIDTH]};
    end
  end

  assign cells_o = cells_q;

endmodule
