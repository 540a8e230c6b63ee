// SPDX-License-Identifier: Apache-2.0
// The histograms of a column in one two-port SRAM: counts one timestamp per clock, is scanned and cleared
// (thesis 4.4, Fig. 4.9 to 4.11).
//
// Equation: count[pixel, bin] = min(count + 1, 2^COUNT_WIDTH - 1) for every kept timestamp.
// Schedule: T1 bin and hit arrive; T2 SRAM read; T3 data registered; T4 +1; T5 SRAM write. A scan reads at S0,
// shows the count at S2 (count_s2_o) and clears the address at S1.
// Hazard: timestamps up to three clocks apart may meet in one address before it is written. Pending counts
// are forwarded at T4; only distances at which two timestamps can be of one pixel have a comparator.
// Latency: 5 clocks from T0 to the write. Reset of the columns is not needed: beat_t5_i masks every write.
// Cost at the defaults: 46 flip-flops, an incrementer, one bin comparator.
`include "dtof_macros.svh"

module histogram_builder #(
    parameter int PIXELS_PER_SRAM = 160,
    parameter int BIN_WIDTH = 5,  // log2 of the bins a pixel
    parameter int SLOTS = 2,
    parameter int COUNT_WIDTH = 10,
    parameter int SIGNALLED_CLEAR = 0,
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    // timestamp at T1
    input  logic                   hit_t1_i,
    input  logic [  BIN_WIDTH-1:0] bin_t1_i,
    // schedule, common to all columns
    input  logic [          3:1]   same_pixel_t3_i,
    input  logic                   beat_t5_i,
    input  logic                   scan_s0_i,       // read for the scan instead of T2
    input  logic [  BIN_WIDTH-1:0] scan_bin_s0_i,
    input  logic [  ROW_WIDTH-1:0] read_pixel_i,    // pixel of T2 or S0
    input  logic                   clear_s1_i,      // clear instead of T5
    input  logic [  BIN_WIDTH-1:0] clear_bin_s1_i,
    input  logic [  ROW_WIDTH-1:0] write_pixel_i,   // pixel of T5 or S1
    input  logic                   clear_all_i,     // signalled clear
    output logic [COUNT_WIDTH-1:0] count_s2_o
);

  localparam int BINS = 1 << BIN_WIDTH;
  localparam int DEPTH = PIXELS_PER_SRAM * BINS;
  localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH);
  // Shortest distance from a pixel's last slot to its first slot of the next acquisition.
  localparam int NEXT_VISIT = (PIXELS_PER_SRAM - 1) * SLOTS + 1;
  localparam int FORWARD_DEPTH = (NEXT_VISIT <= 3) ? 3 : ((SLOTS - 1 < 3) ? SLOTS - 1 : 3);

  logic hit_t2_q, hit_t3_q, hit_t4_q, hit_t5_q;
  logic [BIN_WIDTH-1:0] bin_t2_q, bin_t3_q, bin_t4_q, bin_t5_q;
  logic [COUNT_WIDTH-1:0] sram_data, valid_data, count_q, operand, incremented, written_q;
  logic [ADDR_WIDTH-1:0] read_addr, write_addr;
  logic read_en, build_write, write_en;

  assign read_en = scan_s0_i || hit_t2_q;
  assign read_addr = ADDR_WIDTH'({read_pixel_i, scan_s0_i ? scan_bin_s0_i : bin_t2_q});
  assign build_write = beat_t5_i && hit_t5_q;
  assign write_addr = ADDR_WIDTH'({write_pixel_i, clear_s1_i ? clear_bin_s1_i : bin_t5_q});

  dtof_sram #(
      .PORTS(2),
      .DEPTH(DEPTH),
      .WIDTH(COUNT_WIDTH)
  ) u_histogram_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .read_en_i   (read_en),
      .read_addr_i (read_addr),
      .read_data_o (sram_data),
      .write_en_i  (write_en),
      .write_addr_i(write_addr),
      .write_data_i(clear_s1_i ? '0 : written_q)
  );

  generate
    if (SIGNALLED_CLEAR != 0) begin : g_signalled_clear
      logic valid;
      status_bits #(
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
      assign write_en = build_write;
    end else begin : g_clear
      logic unused_clear_all;
      assign unused_clear_all = clear_all_i;
      assign valid_data = sram_data;
      assign write_en = build_write || clear_s1_i;
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    hit_t2_q <= hit_t1_i;
    hit_t3_q <= hit_t2_q;
    hit_t4_q <= hit_t3_q;
    hit_t5_q <= hit_t4_q;
    bin_t2_q <= bin_t1_i;
    bin_t3_q <= bin_t2_q;
    bin_t4_q <= bin_t3_q;
    bin_t5_q <= bin_t4_q;
    count_q <= valid_data;
    written_q <= incremented;
  end

  assign count_s2_o = count_q;
  // All ones plus one overflows to zero: the overflow bit puts the ones back, beside the adder.
  logic [COUNT_WIDTH:0] plus_one;
  assign plus_one = {1'b0, operand} + 1'b1;
  assign incremented = plus_one[COUNT_WIDTH-1:0] | {COUNT_WIDTH{plus_one[COUNT_WIDTH]}};

  // A pending count is forwarded if pixel and bin are the same; decided at T3, one clock before the addition.
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
      // Stages behind the write: T6 and T7.
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
      always_comb begin
        if (forward_t4_q[1]) begin
          operand = written_q;
        end else if (forward_t4_q[2]) begin
          operand = written_t6_q;
        end else if (forward_t4_q[3]) begin
          operand = written_t7_q;
        end else begin
          operand = count_q;
        end
      end
    end
  endgenerate

  `DTOF_ASSERT(a_no_scan_while_building, !(scan_s0_i && hit_t2_q),
               "histogram scanned while a timestamp is being counted")
  `DTOF_ASSERT(a_no_clear_while_building, !(clear_s1_i && build_write),
               "histogram cleared while a count is being written")

endmodule
