// SPDX-License-Identifier: Apache-2.0
// poolPointer: finds the candidate depths of a group of pixels in its coarse histogram and its four neighbours'.
//
// Equations (docs/reference/poolpointer.md, Decode): pair sums w = 3 own + those of the groups above, below, left and
// right, each bin less its template; LABELS times the largest not taken, which no
// pair with a hidden bin, or up to two beyond, is; its cell from its neighbours' tilt; an eighth of its excess over the least
// sum is taken from the pairs two away. B from the least of the own histogram's four octets.
//
// 1. The bins of five groups, each captured a clock after the one before it, shift out bin by bin; a bin's sum over the
//    groups is added up on the way. It begins at minus the bin's entry of TEMPLATE, and is 0 if it ends below.
// 2. Sums of two adjacent bins enter a ring of 32: pair -1 first, which holds nothing and counts as taken.
// 3. The ring turns once a candidate. While it passes its head, the largest pair that is not taken is kept, with its two
//    neighbours.
// 4. In the next turn's first two clocks the candidate's tilt and then its cell are found; during that turn what it
//    takes away leaves the pairs on their way to the head.
//
// Schedule: the table of dtof_pool_sequencer, with this module's POOL_DECODER_*_CLOCKS (dtof_pkg).
// 5. With SIGNIFICANCE_WIDTH each candidate's significance follows (dtof_candidate_significance), and whether the first octet
//    has more than one and a half times the least one's counts, and 16.
//
// With PRIOR a pair sum is larger by 28 where the last frame used a candidate (Prior from the last frame).
// Cost at the defaults: 384 flip-flops of ring, 280 of shift registers, per engine.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_candidate_decoder `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int COUNT_WIDTH = 7,    // bits of a coarse bin
    parameter int LABELS = 5,         // candidates of a group
    parameter int PRIOR = 0,          // 1: candidates begin from those that were used in the last frame
    parameter int SIGNIFICANCE_WIDTH = 3,  // bits of a candidate's significance, 0: none
    localparam int SIGNIFICANCES_WIDTH = dtof_pkg::max_of(LABELS * SIGNIFICANCE_WIDTH, 1),
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int BACKGROUND_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH,
    localparam int LINE_WIDTH = dtof_pkg::POOL_BINS_PER_LINE * COUNT_WIDTH
) (
    input  logic                         clk_i,
    input  logic                         active_i,     // in all of decode; otherwise nothing moves
    input  `DTOF_TYPE(dtof_pool_pkg, pool_decode_command_t) command_i,
    input  logic [       LINE_WIDTH-1:0] line_i,       // with a capture: an octet of bins, lowest first
    // with take_prior: the group's candidates of the last frame, and which of them were used
    input  logic [LABELS*CELL_WIDTH-1:0] last_cells_i,
    input  logic [           LABELS-1:0] last_used_i,
    // POOL_DECODER_TEMPLATE_CLOCKS after capture_above for bin 0, then bin by bin: what is taken from its sum
    input  logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_i,
    input  logic                         hidden_i,     // with template_i: the bin is hidden
    input  logic                         has_right_i,  // the group has a neighbour to its right
    input  logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] significance_offset_i,  // of long frames
    // the newest candidate is the last cell; both valid from candidate until the next one
    output logic [LABELS*CELL_WIDTH-1:0] cells_o,
    // the newest one is the last; valid POOL_DECODER_SIGNIFICANCE_CLOCKS after candidate, until the next one
    output logic [SIGNIFICANCES_WIDTH-1:0] significances_o,
    output logic                         tilted_o,     // with background_o: the background falls towards late bins
    output logic [ BACKGROUND_WIDTH-1:0] background_o  // until the next group's bins are counted
);

  localparam logic signed [2:0] OWN_WEIGHT = 3'sd3;
  localparam int LEAK_SHIFT = 3;
  localparam int LEAST_TILT = 32;
  localparam int PRIOR_WEIGHT = 28;
  localparam int BIN_SUM_WIDTH = COUNT_WIDTH + 3;  // 7 bins
  localparam int SUM_WIDTH = COUNT_WIDTH + 4;      // of a pair
  localparam int ENTRY_WIDTH = SUM_WIDTH + 1;
  localparam int ENTRIES = dtof_pkg::POOL_COARSE_BINS;
  localparam int OCTET_WIDTH = COUNT_WIDTH + 3;
  localparam int TEMPLATE_SHIFT = dtof_pkg::pool_template_shift(COUNT_WIDTH);
  localparam int HIDDEN_CLOCKS = 5;  // from a bin's template to its sum
  localparam int TAKEN_WIDTH = dtof_pkg::max_of(BIN_SUM_WIDTH, dtof_pkg::POOL_TEMPLATE_WIDTH + TEMPLATE_SHIFT);
  localparam logic [5:0] NOWHERE = 6'd48;  // not even two away from a pair

  // Bins, one group a clock after the other.

  logic [LINE_WIDTH-1:0] above_q, own_q, below_q, left_q, right_q;
  logic [COUNT_WIDTH-1:0] own_bin;
  logic signed [TAKEN_WIDTH:0] above_sum_q, own_sum_q, below_sum_q, left_sum_q, bin_sum;
  logic [BIN_SUM_WIDTH-1:0] bin_sum_q, last_sum_q;
  logic [HIDDEN_CLOCKS+2:0] hidden_q;  // the newest lowest
  logic pair_hidden;

  function automatic logic signed [TAKEN_WIDTH:0] as_sum(input logic [COUNT_WIDTH-1:0] count);
    as_sum = $signed((TAKEN_WIDTH + 1)'(count));
  endfunction

  assign bin_sum = left_sum_q + as_sum(right_q[COUNT_WIDTH-1:0]);
  assign pair_hidden = (hidden_q[HIDDEN_CLOCKS+2-:4] != '0);
  assign own_bin = own_q[COUNT_WIDTH-1:0];

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      above_q <= command_i.capture_above ? line_i : above_q >> COUNT_WIDTH;
      own_q <= command_i.capture_own ? line_i : own_q >> COUNT_WIDTH;
      below_q <= command_i.capture_below ? line_i : below_q >> COUNT_WIDTH;
      left_q <= command_i.capture_left ? line_i : left_q >> COUNT_WIDTH;
      right_q <= command_i.capture_right ? line_i : right_q >> COUNT_WIDTH;
      above_sum_q <= as_sum(above_q[COUNT_WIDTH-1:0]) - $signed((TAKEN_WIDTH + 1)'(template_i) << TEMPLATE_SHIFT);
      own_sum_q <= above_sum_q + OWN_WEIGHT * as_sum(own_bin);
      below_sum_q <= own_sum_q + as_sum(below_q[COUNT_WIDTH-1:0]);
      left_sum_q <= below_sum_q + as_sum(left_q[COUNT_WIDTH-1:0]);
      bin_sum_q <= bin_sum[TAKEN_WIDTH] ? '0 : bin_sum[BIN_SUM_WIDTH-1:0];
      last_sum_q <= bin_sum_q;
      hidden_q <= {hidden_q[HIDDEN_CLOCKS+1:0], hidden_i};
    end
  end

  // Background.

  logic [OCTET_WIDTH-1:0] octet, octet_q, least_octet_q, first_sum_q;
  logic octet_done_q, first_octet_q;
  logic [OCTET_WIDTH+2:0] five_octets;

  assign octet = ((command_i.own_bin[2:0] == 3'd0) ? '0 : octet_q) + OCTET_WIDTH'(own_bin);

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      octet_done_q <= command_i.count_own && command_i.own_bin[2:0] == 3'd7;
      first_octet_q <= (command_i.own_bin[4:3] == 2'd0);
      if (command_i.count_own) begin
        octet_q <= octet;
      end
      if (octet_done_q && (first_octet_q || octet_q < least_octet_q)) begin
        least_octet_q <= octet_q;
      end
      if (octet_done_q && first_octet_q) begin
        first_sum_q <= octet_q;
      end
    end
  end

  assign five_octets = (OCTET_WIDTH + 3)'(least_octet_q) + ((OCTET_WIDTH + 3)'(least_octet_q) << 2);
  assign background_o = BACKGROUND_WIDTH'(five_octets >> COUNT_WIDTH);

  assign tilted_o = (SIGNIFICANCE_WIDTH != 0)
      && ((OCTET_WIDTH + 3)'({first_sum_q, 1'b0}) > (OCTET_WIDTH + 3)'(least_octet_q) + (OCTET_WIDTH + 3)'({least_octet_q, 1'b0})
          + (OCTET_WIDTH + 3)'(LEAST_TILT));

  // What the last frame adds. A candidate's cell is at most 1 from the middle of its own pair i, 4 (i + 1), and all others
  // are further than PRIOR_REACH = 2 from it: a used candidate raises its own pair's sum, a clock before that is complete.

  logic [SUM_WIDTH-1:0] last_sum, raised;  // raised: of the pair at the head
  genvar k;
  generate
    if (PRIOR != 0) begin : g_prior
      logic [LABELS-1:0] used_q, here, at_head;
      logic [LABELS*5-1:0] pairs_q;
      logic [SUM_WIDTH-1:0] raised_sum_q;

      for (k = 0; k < LABELS; k = k + 1) begin : g_label
        assign here[k] = used_q[k] && (pairs_q[k*5+:5] == command_i.pair);
        assign at_head[k] = used_q[k] && (pairs_q[k*5+:5] == command_i.pair - 5'd1);
        always_ff @(posedge clk_i) begin
          if (command_i.take_prior) begin
            pairs_q[k*5+:5] <= 5'((last_cells_i[k*CELL_WIDTH+:CELL_WIDTH] - CELL_WIDTH'(3)) >> 2);
          end
        end
      end

      always_ff @(posedge clk_i) begin
        if (active_i) begin
          if (command_i.take_prior) begin
            used_q <= last_used_i;
          end
          raised_sum_q <= SUM_WIDTH'(bin_sum_q) + ((here != '0) ? SUM_WIDTH'(PRIOR_WEIGHT) : '0);
        end
      end
      assign last_sum = raised_sum_q;
      assign raised = (at_head != '0) ? SUM_WIDTH'(PRIOR_WEIGHT) : '0;
      logic unused_last_sum;
      assign unused_last_sum = ^last_sum_q;
    end else begin : g_no_prior
      assign last_sum = SUM_WIDTH'(last_sum_q);
      assign raised = '0;
      logic unused_prior;
      assign unused_prior = ^{last_cells_i, last_used_i, command_i.take_prior};
    end
  endgenerate

  // The least pair sum.

  logic [SUM_WIDTH-1:0] pair_sum, least_q;

  assign pair_sum = SUM_WIDTH'(bin_sum_q) + last_sum;

  always_ff @(posedge clk_i) begin
    if (command_i.fill) begin
      if (command_i.pair == 5'd0) begin
        least_q <= '1;  // more than any sum
      end else if (!pair_hidden && pair_sum < least_q) begin
        least_q <= pair_sum;
      end
    end
  end

  // The ring: {taken, sum}. What the last candidate takes away leaves an entry on its way to the head.

  logic [ENTRIES*ENTRY_WIDTH-1:0] ring_q;
  logic [ENTRY_WIDTH-1:0] next_head, entry;
  logic head_taken, next_taken, taken;
  logic [SUM_WIDTH-1:0] head, next, left_over, leak, leak_q, new_leak, new_leak_q;
  logic [5:0] peak_q, from_peak;
  logic new_peak_q, beside, beside_q, two_away, two_away_q;
  logic [4:0] best_pair_q;

  assign head = ring_q[SUM_WIDTH-1:0];
  assign head_taken = ring_q[ENTRY_WIDTH-1];
  assign next_head = ring_q[2*ENTRY_WIDTH-1:ENTRY_WIDTH];
  assign next = next_head[SUM_WIDTH-1:0];
  assign next_taken = next_head[ENTRY_WIDTH-1];

  // With pair 0 at the head the peak is new: what is registered is still of the one before. What it takes away was
  // registered a clock after it was found, in time for pair 1, which only an early peak reaches.
  assign beside = new_peak_q ? !command_i.first_label && (best_pair_q == 5'd1 || best_pair_q == 5'd2) : beside_q;
  assign two_away = new_peak_q ? !command_i.first_label && (best_pair_q == 5'd3) : two_away_q;
  assign leak = new_peak_q ? new_leak_q : leak_q;
  assign from_peak = {1'b0, command_i.pair} + 6'd2 - peak_q;
  assign taken = next_taken || beside;
  assign left_over = !two_away ? next : (next > leak) ? next - leak : '0;

  assign entry = command_i.fill ? ((command_i.pair == 5'd0) ? {1'b1, {SUM_WIDTH{1'b0}}} : {pair_hidden, pair_sum})
      : command_i.search ? {head_taken, head} : '0;

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      ring_q <= {entry, ring_q[ENTRIES*ENTRY_WIDTH-1:2*ENTRY_WIDTH], taken, left_over};
      new_peak_q <= (command_i.pair == 5'd31);
      if (new_peak_q) begin  // for pair 2
        beside_q <= !command_i.first_label && (best_pair_q <= 5'd3);
        two_away_q <= !command_i.first_label && (best_pair_q == 5'd4);
      end else begin
        beside_q <= (from_peak == 6'd0) || (from_peak == 6'd1) || (from_peak == 6'd63);
        // While the ring fills, the peak is still of another group.
        two_away_q <= command_i.search && ((from_peak == 6'd2) || (from_peak == 6'd62));
      end
      new_leak_q <= new_leak;
    end
  end

  // The largest of a turn, the lowest on a tie, with its neighbours.

  logic found_q, next_pending_q, better;
  logic [SUM_WIDTH-1:0] best_q, before_q, after_q, last_q;

  assign better = !head_taken && (!found_q || head > best_q);

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      last_q <= head;
      if (command_i.pair == 5'd0) begin
        found_q <= 1'b0;
        next_pending_q <= 1'b0;
      end else begin
        next_pending_q <= better;
        if (better) begin
          found_q <= 1'b1;
          best_pair_q <= command_i.pair;
          best_q <= head;
          before_q <= last_q;
          after_q <= '0;  // beyond the last pair
        end else if (next_pending_q) begin
          after_q <= head;
        end
      end
    end
  end

  // A turn later (pair = 0): what the candidate takes away, and its tilt; then (pair = 1) its cell.

  logic [SUM_WIDTH-1:0] tilt_q, height, lower_q, excess;
  logic tilted, upwards, upwards_q;
  logic [CELL_WIDTH-1:0] peak_cell;
  logic [LABELS*CELL_WIDTH-1:0] cells, cells_q;

  assign upwards = (after_q > before_q);
  assign height = best_q - lower_q;
  assign tilted = (best_q > lower_q) && ({tilt_q, 1'b0} > {1'b0, height});
  assign peak_cell = {best_pair_q, 2'b00} + (tilted ? (upwards_q ? CELL_WIDTH'(1) : '1) : '0);
  assign excess = (best_q > least_q) ? best_q - least_q : '0;
  assign new_leak = excess >> LEAK_SHIFT;
  assign cells = command_i.candidate ? {peak_cell, cells_q[LABELS*CELL_WIDTH-1:CELL_WIDTH]} : cells_q;

  always_ff @(posedge clk_i) begin
    if (active_i) begin
      upwards_q <= upwards;
      tilt_q <= upwards ? after_q - before_q : before_q - after_q;
      lower_q <= upwards ? before_q : after_q;
      if (command_i.search && new_peak_q) begin
        peak_q <= command_i.first_label ? NOWHERE : {1'b0, best_pair_q};
        leak_q <= new_leak;
      end
      if (command_i.candidate) begin
        cells_q <= cells;
      end
    end
  end

  assign cells_o = cells;

  // How far each candidate stands out. The ring's head is pair i, its place j pair i + j; the last places are those that have
  // just passed the head.

  generate
    if (SIGNIFICANCE_WIDTH != 0) begin : g_significance
      logic [SIGNIFICANCE_WIDTH-1:0] significance;
      logic [SIGNIFICANCES_WIDTH-1:0] significances_q;
      logic [SUM_WIDTH-1:0] best_raised_q;

      always_ff @(posedge clk_i) begin
        if (active_i && better && command_i.pair != 5'd0) begin
          best_raised_q <= raised;
        end
        if (command_i.search && !command_i.first_label && command_i.pair == 5'(dtof_pkg::POOL_DECODER_SIGNIFICANCE_CLOCKS)) begin
          significances_q <= {significance, significances_q[SIGNIFICANCES_WIDTH-1:SIGNIFICANCE_WIDTH]};
        end
      end

      dtof_candidate_significance #(
          .SUM_WIDTH (SUM_WIDTH),
          .KEPT_WIDTH(SIGNIFICANCE_WIDTH)
      ) u_significance (
          .clk_i         (clk_i),
          .active_i      (active_i),
          .ahead_i       ({ring_q[5*ENTRY_WIDTH+:SUM_WIDTH], ring_q[4*ENTRY_WIDTH+:SUM_WIDTH]}),
          .behind_i      ({ring_q[(ENTRIES-2)*ENTRY_WIDTH+:SUM_WIDTH], ring_q[(ENTRIES-3)*ENTRY_WIDTH+:SUM_WIDTH]}),
          .better_i      (better && command_i.pair != 5'd0),
          .new_peak_i    (command_i.pair == 5'd0),
          .pair_i        (best_pair_q),
          .peak_i        (best_q),
          .raised_i      (best_raised_q),
          .missing_i     ({1'b0, command_i.missing} + {2'b00, !has_right_i}),
          .offset_i      (significance_offset_i),
          .significance_o(significance)
      );
      assign significances_o = significances_q;
    end else begin : g_no_significance
      assign significances_o = '0;
      logic unused_significance;
      assign unused_significance = ^{raised, has_right_i, significance_offset_i, command_i.missing, first_sum_q};
    end
  endgenerate

endmodule

`default_nettype wire
