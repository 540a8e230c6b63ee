// SPDX-License-Identifier: Apache-2.0
// The histograms of a column in one two-port SRAM; counts one timestamp per clock (thesis 4.4, Fig. 4.9 to 4.11).
//
// 1. Counting. The count at a timestamp's address {pixel, bin} is read, incremented and written back. This takes five
//    clocks, and a new timestamp may start in every clock.
// 2. Forwarding. Timestamps up to three clocks apart may have the same address before the first count is written. In this case T4
//    uses the pending count instead of the SRAM's data. There is a comparator only for distances at which two timestamps can be of
//    one pixel.
// 3. Freezing. A bin at 2^COUNT_WIDTH - 1 is full. With FREEZE = 1 the write that fills the first bin of a pixel freezes the
//    pixel: the writes of all its later timestamps are dropped until clear_all_i, so that no other bin catches up with
//    the full bin, and no counter wraps. A flip-flop per pixel stores this; it is read and set at T5. A count that was forwarded from
//    a dropped write is dropped, too, because it is of the same pixel and later. With FREEZE = 0 a full bin stays full, and the
//    other bins count on.
// 4. Scanning. The control reads the addresses one after the other. count_s2_o has each count, and the address is cleared one
//    clock after the read. With SIGNALLED_CLEAR = 1 a status bit per address says whether the address was written since the
//    last clear_all_i, and no address is cleared by a write.
//
//   clock    counting                              scanning
//   T1       bin and hit arrive
//   T2 / S0  SRAM read                             SRAM read
//   T3 / S1  data registered, bins compared        data registered, the address cleared
//   T4 / S2  + 1                                   the count is at count_s2_o
//   T5       SRAM write, unless frozen
//
// The registers need no reset, because beat_t5_i masks every write. Without a hit and without a scan they hold.
// Latency: 4 clocks from hit_t1_i to the write, 2 clocks from scan_s0_i to count_s2_o.
// Cost at the defaults: 47 flip-flops and with FREEZE one per pixel, an incrementer, one bin comparator; block RAM on an FPGA.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_histogram_builder #(
    parameter int PIXELS_PER_SRAM = 160,  // histograms
    parameter int BIN_WIDTH = 5,         // log2 of the bins of a histogram
    parameter int SLOTS = 2,             // consecutive timestamps of a pixel
    parameter int COUNT_WIDTH = 10,      // bits of a count
    parameter int FREEZE = 1,            // 1: a pixel's first full bin ends its counting; 0: full bins stay full
    parameter int SIGNALLED_CLEAR = 0,   // 1: a status bit per address replaces clearing
    parameter int PARITY = 0,            // 1: each word has a parity bit
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,          // for assertions and the check of parity only
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // timestamp at T1
    input  logic                   hit_t1_i,        // the timestamp counts
    input  logic [  BIN_WIDTH-1:0] bin_t1_i,
    // schedule, the same for all columns; no scan and no clear while a timestamp is in the pipeline
    input  logic [          3:1]   same_pixel_t3_i,  // [d]: the timestamp d clocks ahead is of the same pixel
    input  logic                   beat_t5_i,       // a timestamp is at T5
    input  logic                   scan_s0_i,       // read for the scan instead of T2
    input  logic [  BIN_WIDTH-1:0] scan_bin_s0_i,
    input  logic [  ROW_WIDTH-1:0] read_pixel_i,    // pixel of T2 or S0
    input  logic                   clear_s1_i,      // clear instead of T5
    input  logic [  BIN_WIDTH-1:0] clear_bin_s1_i,
    input  logic [  ROW_WIDTH-1:0] write_pixel_i,   // pixel of T5 or S1
    input  logic                   clear_all_i,     // clears all frozen flags, and all status bits with SIGNALLED_CLEAR = 1
    output logic [COUNT_WIDTH-1:0] count_s2_o,      // count at the address of S0
    output logic                   full_t5_o,       // a bin becomes full now; with FREEZE = 0 also if it was full before
    output logic                   parity_error_o   // with PARITY = 1: the count that was read two clocks ago is damaged
);

  localparam int BINS = 1 << BIN_WIDTH;
  localparam int DEPTH = PIXELS_PER_SRAM * BINS;
  localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH);
  // Shortest distance from a pixel's last slot to its first slot of the next acquisition.
  localparam int NEXT_VISIT = (PIXELS_PER_SRAM - 1) * SLOTS + 1;
  localparam int FORWARD_DEPTH = (NEXT_VISIT <= 3) ? 3 : ((SLOTS - 1 < 3) ? SLOTS - 1 : 3);

  logic hit_t2_q, hit_t3_q, hit_t4_q, hit_t5_q, read_done_q;
  logic [BIN_WIDTH-1:0] bin_t2_q, bin_t3_q, bin_t4_q, bin_t5_q;
  logic [COUNT_WIDTH-1:0] sram_data, valid_data, count_q, operand, incremented, written_q;
  logic [ADDR_WIDTH-1:0] read_addr, write_addr;
  logic read_en, build_write, fills_t5, frozen, write_en, ignored;

  assign read_en = scan_s0_i || hit_t2_q;
  assign read_addr = ADDR_WIDTH'({read_pixel_i, scan_s0_i ? scan_bin_s0_i : bin_t2_q});
  assign build_write = beat_t5_i && hit_t5_q && !frozen;
  assign fills_t5 = beat_t5_i && hit_t5_q && (&written_q);
  assign full_t5_o = fills_t5 && !frozen;
  assign write_addr = ADDR_WIDTH'({write_pixel_i, clear_s1_i ? clear_bin_s1_i : bin_t5_q});

  dtof_parity_sram #(
      .PORTS(2),
      .DEPTH(DEPTH),
      .WIDTH(COUNT_WIDTH),
      .PARITY(PARITY)
  ) u_histogram_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read_en),
      .read_addr_i (read_addr),
      .read_data_o (sram_data),
      .ignore_i    (ignored),
      .error_o     (parity_error_o),
      .write_en_i  (write_en),
      .write_addr_i(write_addr),
      .write_data_i(clear_s1_i ? '0 : written_q)
  );

  generate
    if (SIGNALLED_CLEAR != 0) begin : g_signalled_clear
      logic valid;
      dtof_status_bits #(
          .DEPTH(DEPTH)
      ) u_status_bits (
          .clk_i       (clk_i),
          .clear_i     (clear_all_i),
          .write_i     (build_write),
          .write_addr_i(write_addr),
          .read_i      (read_en),
          .read_addr_i (read_addr),
          .valid_o     (valid)
      );
      assign valid_data = valid ? sram_data : '0;
      assign ignored = !valid;
      assign write_en = build_write;
    end else begin : g_clear
      logic unused_clear_all;
      assign unused_clear_all = clear_all_i;
      assign valid_data = sram_data;
      assign ignored = 1'b0;
      assign write_en = build_write || clear_s1_i;
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    hit_t2_q <= hit_t1_i;
    hit_t3_q <= hit_t2_q;
    hit_t4_q <= hit_t3_q;
    hit_t5_q <= hit_t4_q;
    read_done_q <= read_en;
    if (hit_t1_i) begin
      bin_t2_q <= bin_t1_i;
    end
    if (hit_t2_q) begin
      bin_t3_q <= bin_t2_q;
    end
    if (hit_t3_q) begin
      bin_t4_q <= bin_t3_q;
    end
    if (hit_t4_q) begin
      bin_t5_q <= bin_t4_q;
      written_q <= incremented;
    end
    if (read_done_q) begin
      count_q <= valid_data;
    end
  end

  assign count_s2_o = count_q;

  generate
    if (FREEZE != 0) begin : g_freeze
      // One-hot decoder of the pixel at T5, in rows and columns of a square, which is smaller than a full decoder.
      localparam int LOW_WIDTH = dtof_pkg::min_of(ROW_WIDTH, 4);
      localparam int LOWS = 1 << LOW_WIDTH;
      localparam int HIGHS = (PIXELS_PER_SRAM + LOWS - 1) / LOWS;
      logic [LOWS-1:0] low;
      logic [HIGHS-1:0] high;
      logic [HIGHS*LOWS-1:0] selected;
      logic [PIXELS_PER_SRAM-1:0] frozen_q;
      logic unused_selected;
      assign low = LOWS'(1) << write_pixel_i[LOW_WIDTH-1:0];
      assign high = HIGHS'(1) << (32'(write_pixel_i) >> LOW_WIDTH);
      genvar h;
      for (h = 0; h < HIGHS; h = h + 1) begin : g_high
        assign selected[h*LOWS+:LOWS] = {LOWS{high[h]}} & low;
      end
      assign unused_selected = ^selected;
      // All flags share one enable, so that their clock can be gated. The enable does not depend on `frozen`, which comes late: if a write
      // is dropped, its pixel is frozen already.
      always_ff @(posedge clk_i) begin
        if (clear_all_i || fills_t5) begin
          frozen_q <= clear_all_i ? '0 : frozen_q | selected[PIXELS_PER_SRAM-1:0];
        end
      end
      assign frozen = |(frozen_q & selected[PIXELS_PER_SRAM-1:0]);
      // A full bin's pixel is frozen, so a wrapped count is never written.
      assign incremented = operand + 1'b1;
    end else begin : g_saturate
      // All ones plus one overflows to zero; the overflow bit then sets all bits again, beside the adder.
      logic [COUNT_WIDTH:0] plus_one;
      assign plus_one = {1'b0, operand} + 1'b1;
      assign frozen = 1'b0;
      assign incremented = plus_one[COUNT_WIDTH-1:0] | {COUNT_WIDTH{plus_one[COUNT_WIDTH]}};
    end
  endgenerate

  // A pending count is forwarded if pixel and bin are equal; decided at T3, one clock before the addition.
  generate
    if (FORWARD_DEPTH == 0) begin : g_no_forward
      logic unused_forward;
      assign unused_forward = ^same_pixel_t3_i;
      assign operand = count_q;
    end else if (FORWARD_DEPTH == 1) begin : g_forward_one
      logic unused_forward;
      assign unused_forward = ^same_pixel_t3_i[3:2];
      logic forward_t4_q;
      always_ff @(posedge clk_i) begin
        forward_t4_q <= same_pixel_t3_i[1] && hit_t4_q && (bin_t4_q == bin_t3_q);
      end
      assign operand = forward_t4_q ? written_q : count_q;
    end else begin : g_forward
      // Stages after the write: T6 and T7.
      logic hit_t6_q;
      logic [BIN_WIDTH-1:0] bin_t6_q;
      logic [COUNT_WIDTH-1:0] written_t6_q, written_t7_q;
      logic [3:1] forward_t4_q;
      always_ff @(posedge clk_i) begin
        hit_t6_q <= hit_t5_q;
        bin_t6_q <= bin_t5_q;
        written_t6_q <= written_q;
        written_t7_q <= written_t6_q;
        forward_t4_q[1] <= same_pixel_t3_i[1] && hit_t4_q && (bin_t4_q == bin_t3_q);
        forward_t4_q[2] <= same_pixel_t3_i[2] && hit_t5_q && (bin_t5_q == bin_t3_q);
        forward_t4_q[3] <= same_pixel_t3_i[3] && hit_t6_q && (bin_t6_q == bin_t3_q);
      end
      assign operand = forward_t4_q[1] ? written_q
          : forward_t4_q[2] ? written_t6_q
          : forward_t4_q[3] ? written_t7_q : count_q;
    end
  endgenerate

  `DTOF_ASSERT(a_no_scan_while_building, !(scan_s0_i && hit_t2_q),
               "histogram scanned while a timestamp is being counted")
  `DTOF_ASSERT(a_no_clear_while_building, !(clear_s1_i && build_write),
               "histogram cleared while a count is being written")

endmodule

`default_nettype wire
