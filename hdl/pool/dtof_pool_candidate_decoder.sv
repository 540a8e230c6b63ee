// SPDX-License-Identifier: Apache-2.0
// poolPointer, decode: finds the candidate depths of a group of pixels in the coarse histograms of the group and its four neighbours.
//
// Equations (docs/reference/poolpointer.md, Decode): a bin's sum is 3 own + above + below + left + right, minus the bin's template
// entry, at least 0; a pair sum w adds two adjacent bins. LABELS times, the largest pair sum that is not taken becomes a candidate;
// it takes its own pair and the pairs next to it. Pairs with a hidden bin, and up to two pairs beyond, are taken from the start. The
// candidate's cell follows from the tilt between the two neighbouring pairs. An eighth of the candidate's excess over the least pair
// sum is subtracted from the pairs two away. The background B follows from the least of the four octets of the group's own histogram.
//
// 1. The bins of the five groups are captured in five successive clocks and shift out bin by bin. A bin's sum passes five
//    adders, one per clock, that start with minus the bin's template entry.
// 2. Sums of two adjacent bins enter a ring of 32 entries. The first entry, pair -1, is empty and counts as taken.
// 3. The ring turns once per candidate. While the entries pass the head, registers keep the largest pair sum that is not taken, and
//    the sums of its two neighbours.
// 4. The first two clocks of the next turn compute the candidate's tilt, then its cell. During that turn the candidate's leak is
//    subtracted from entries on their way to the head, and its pairs become taken.
// 5. With SIGNIFICANCE_WIDTH > 0 each candidate's significance follows (dtof_candidate_significance), and tilted_o says whether
//    the first octet has more than 1.5 times the counts of the least octet plus 16.
// With PRIOR = 1 a pair sum is larger by 28 if the last frame used its candidate (Prior from the last frame).
//
// Schedule: the table of dtof_pool_sequencer. Latency: POOL_DECODER_*_CLOCKS (dtof_pkg).
// Cost at the defaults: 384 flip-flops of ring, 280 of shift registers, per engine.

`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_candidate_decoder `DTOF_TYPES_OF(dtof_pool_pkg) #(
    parameter int COUNT_WIDTH = 7,    // bits of a coarse bin
    parameter int LABELS = 5,         // candidates of a group
    parameter int PRIOR = 0,          // 1: candidates of the last frame that were used raise their pair sums
    parameter int SIGNIFICANCE_WIDTH = 3,  // bits of a candidate's significance; 0: no significance
    localparam int SIGNIFICANCES_WIDTH = dtof_pkg::max_of(LABELS * SIGNIFICANCE_WIDTH, 1),
    localparam int CELL_WIDTH = dtof_pkg::POOL_CELL_WIDTH,
    localparam int BACKGROUND_WIDTH = dtof_pkg::POOL_BACKGROUND_WIDTH,
    localparam int LINE_WIDTH = dtof_pkg::POOL_BINS_PER_LINE * COUNT_WIDTH
) (
    input  logic                         clk_i,
    input  logic                         active_i,     // high during all of decode; while low, registers hold
    input  `DTOF_TYPE(dtof_pool_pkg, pool_decode_command_t) command_i,
    input  logic [       LINE_WIDTH-1:0] line_i,       // with a capture command: eight bins, lowest first
    // with take_prior: the group's candidates of the last frame, and which of them were used
    input  logic [LABELS*CELL_WIDTH-1:0] last_cells_i,
    input  logic [           LABELS-1:0] last_used_i,
    // subtracted from a bin's sum: for bin 0 POOL_DECODER_TEMPLATE_CLOCKS after capture_above, then bin by bin
    input  logic [dtof_pkg::POOL_TEMPLATE_WIDTH-1:0] template_i,
    input  logic                         hidden_i,     // with template_i: the bin is hidden
    input  logic                         has_right_i,  // a group to the right exists
    input  logic [dtof_pkg::POOL_SIGNIFICANCE_OFFSET_WIDTH-1:0] significance_offset_i,  // correction for long frames
    // candidates, the newest in the highest bits; cells_o and background_o are valid from candidate until the next candidate
    output logic [LABELS*CELL_WIDTH-1:0] cells_o,
    // the newest in the highest bits; valid POOL_DECODER_SIGNIFICANCE_CLOCKS after candidate, until the next candidate's
    output logic [SIGNIFICANCES_WIDTH-1:0] significances_o,
    output logic                         tilted_o,     // valid with background_o: the background is lower in late bins
    output logic [ BACKGROUND_WIDTH-1:0] background_o  // valid until the bins of the next group are counted
);

  localparam logic signed [2:0] OWN_WEIGHT = 3'sd3;
  localparam int LEAK_SHIFT = 3;
  localparam int LEAST_TILT = 32;
  localparam int PRIOR_WEIGHT = 28;
  localparam int BIN_SUM_WIDTH = COUNT_WIDTH + 3;  // sum of 7 bins
  localparam int SUM_WIDTH = COUNT_WIDTH + 4;      // pair sum
  localparam int ENTRY_WIDTH = SUM_WIDTH + 1;
  localparam int ENTRIES = dtof_pkg::POOL_COARSE_BINS;
  localparam int OCTET_WIDTH = COUNT_WIDTH + 3;
  localparam int TEMPLATE_SHIFT = dtof_pkg::pool_template_shift(COUNT_WIDTH);
  localparam int HIDDEN_CLOCKS = 5;  // from a bin's template entry to its sum
  localparam int TAKEN_WIDTH = dtof_pkg::max_of(BIN_SUM_WIDTH, dtof_pkg::POOL_TEMPLATE_WIDTH + TEMPLATE_SHIFT);
  localparam logic [5:0] NOWHERE = 6'd48;  // a pair number that is more than two away from every pair

  // Bins of the five groups, each one clock after the group before.

  logic [LINE_WIDTH-1:0] above_q, own_q, below_q, left_q, right_q;
  logic [COUNT_WIDTH-1:0] own_bin;
  logic signed [TAKEN_WIDTH:0] above_sum_q, own_sum_q, below_sum_q, left_sum_q, bin_sum;
  logic [BIN_SUM_WIDTH-1:0] bin_sum_q, last_sum_q;
  logic [HIDDEN_CLOCKS+2:0] hidden_q;  // hidden_i of the last clocks, the newest lowest
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

  // Background: five times the least octet of the group's own histogram, >> COUNT_WIDTH.

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

  // Prior. A candidate's cell is at most 1 away from 4 (i + 1), the middle of its own pair i, and more than PRIOR_REACH = 2 away from
  // the middle of all other pairs. So a used candidate raises the sum of its own pair only, one clock before that sum is complete.

  logic [SUM_WIDTH-1:0] last_sum, raised;  // raised: part of the head's pair sum that comes from PRIOR
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

  // Least pair sum.

  logic [SUM_WIDTH-1:0] pair_sum, least_q;

  assign pair_sum = SUM_WIDTH'(bin_sum_q) + last_sum;

  always_ff @(posedge clk_i) begin
    if (command_i.fill) begin
      if (command_i.pair == 5'd0) begin
        least_q <= '1;  // more than any pair sum
      end else if (!pair_hidden && pair_sum < least_q) begin
        least_q <= pair_sum;
      end
    end
  end

  // Ring of {taken, sum}. The last candidate's leak is subtracted from an entry on its way to the head.

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

  // With pair 0 at the head the peak is new, and the registers below are still those of the peak before. The new peak's leak is
  // registered one clock after the peak was found, in time for pair 1, which only a peak in pair 3 changes.
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
      if (new_peak_q) begin  // values for pair 2
        beside_q <= !command_i.first_label && (best_pair_q <= 5'd3);
        two_away_q <= !command_i.first_label && (best_pair_q == 5'd4);
      end else begin
        beside_q <= (from_peak == 6'd0) || (from_peak == 6'd1) || (from_peak == 6'd63);
        // While the ring fills, peak_q still belongs to the group before.
        two_away_q <= command_i.search && ((from_peak == 6'd2) || (from_peak == 6'd62));
      end
      new_leak_q <= new_leak;
    end
  end

  // Largest pair sum of a turn, the lowest pair on a tie, and the sums of its two neighbours.

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
          after_q <= '0;  // stays 0 if the peak is the last pair
        end else if (next_pending_q) begin
          after_q <= head;
        end
      end
    end
  end

  // In the next turn: at pair 0 the candidate's leak and tilt, at pair 1 its cell.

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

  // Significance of each candidate. If pair i is at the ring's head, entry j is pair i + j; the highest entries are those that have
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
