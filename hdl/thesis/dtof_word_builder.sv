// SPDX-License-Identifier: Apache-2.0
// One word a pixel in an SRAM, changed by the timestamps of all the pixel's slots in one read and one write.
//
// 1. The word is read while the pixel before is served, and registered a clock later.
// 2. It is shown at word_t1_o beside each of the pixel's timestamps at T1, and next_t1_i takes its place: what lies
//    between the two ports, combinational, is the user's update (dtof_pointer_builder: a step of a pointer).
// 3. Two clocks after the pixel's last timestamp it is written, if one of them changed it.
// 4. Outside the stream a word is set to start_word_i, or read for the result: word_o has the word last read.
//
// With very few pixels a pixel's word is read before its last visit was written; its place in the cycle is then
// fixed, so the word is taken from a short history instead (no comparators).
//
//   clock             what happens
//   a pixel ahead     SRAM read, data registered one clock later
//   T1 first slot     word_t1_o is the word just read
//   T1 further slots  word_t1_o is next_t1_i of the slot before
//   T2 last slot      SRAM write
//
// Reads fall on first-slot clocks and writes one clock behind, so PORTS = 1 works for SLOTS >= 2. A broadcast flag
// arrives late in a column: the first slot is registered here, like the timestamp.
//
// Where nothing is detected the registers rest: word_q takes a word only if a timestamp of its visit may change it, and
// the multiplexer before the update turns to word_q only for a timestamp behind the first slot that may.
// Cost: 2 WIDTH + 3 flip-flops, a multiplexer, PIXELS_PER_SRAM words of SRAM; an FPGA's block RAM fits.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_word_builder #(
    parameter int WIDTH = 14,             // bits of a word
    parameter int PIXELS_PER_SRAM = 160,  // words
    parameter int SLOTS = 2,              // timestamps of a pixel one after the other
    parameter int PORTS = 2,              // ports of the SRAM; 1 needs SLOTS >= 2
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM)
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,           // of the assertions alone
    // side band of the SRAM macros, which the technology folder gives a meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // schedule, common to all columns
    input  logic                 read_i,           // fetch ahead, or result read-out
    input  logic [ROW_WIDTH-1:0] read_pixel_i,
    input  logic                 read_done_i,      // read_i one clock later
    input  logic                 first_slot_t0_i,  // whether or not an acquisition is under way
    input  logic                 visit_t1_i,       // first slot of a pixel's visit
    input  logic                 first_acq_t1_i,   // in the first acquisition of a pass
    input  logic                 write_i,          // last slot at T2
    input  logic [ROW_WIDTH-1:0] write_pixel_i,
    // the update, between these two
    input  logic                 may_change_t0_i,  // the timestamp at T0 may change the word
    input  logic                 changes_t1_i,     // the timestamp at T1 does, of those that may
    output logic [    WIDTH-1:0] word_t1_o,        // of the pixel whose timestamp is at T1, where that may change it
    input  logic [    WIDTH-1:0] next_t1_i,        // ... behind that timestamp
    // start value of a pixel, never in the clock of write_i
    input  logic                 start_write_i,
    input  logic [ROW_WIDTH-1:0] start_pixel_i,
    input  logic [    WIDTH-1:0] start_word_i,
    // result
    output logic [    WIDTH-1:0] word_o            // the word last read, two clocks after read_i
);

  `DTOF_REQUIRE(g_illegal_ports, PORTS == 2 || SLOTS >= 2,
                "dtof_word_builder: a single-port SRAM (PORTS = 1) needs SLOTS of at least 2")

  // A pixel's next read precedes its write if a round of all pixels is shorter than the pipeline.
  localparam int NEEDS_HISTORY = (PIXELS_PER_SRAM * SLOTS < 2 * SLOTS + 2) ? 1 : 0;

  logic [WIDTH-1:0] sram_data, read_q, fetched, word_q;
  logic first_slot_t1_q, take_fetched, load_word, write_changed;

  dtof_sram #(
      .PORTS(PORTS),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(WIDTH)
  ) u_word_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read_i),
      .read_addr_i (read_pixel_i),
      .read_data_o (sram_data),
      .write_en_i  (write_changed || start_write_i),
      .write_addr_i(start_write_i ? start_pixel_i : write_pixel_i),
      .write_data_i(start_write_i ? start_word_i : word_q)
  );

  always_ff @(posedge clk_i) begin
    if (read_done_i) begin
      read_q <= sram_data;
    end
    if (load_word) begin
      word_q <= next_t1_i;
    end
    first_slot_t1_q <= first_slot_t0_i;
  end

  generate
    if (NEEDS_HISTORY != 0) begin : g_history
      // history_q[n]: the word of the pixel served n + 1 pixels before the one in word_q.
      logic [WIDTH*PIXELS_PER_SRAM-1:0] history_q;
      always_ff @(posedge clk_i) begin
        if (visit_t1_i) begin
          history_q <= (WIDTH*PIXELS_PER_SRAM)'({history_q, word_q});
        end
      end
      if (PIXELS_PER_SRAM == 1) begin : g_one_pixel
        assign fetched = first_acq_t1_i ? read_q : word_q;
      end else begin : g_few_pixels
        assign fetched = first_acq_t1_i ? read_q : history_q[(PIXELS_PER_SRAM-2)*WIDTH+:WIDTH];
      end
      // The history takes word_q over at each visit, changed or not.
      assign take_fetched = visit_t1_i;
      assign load_word = 1'b1;
      assign write_changed = write_i;
      logic unused_changes;
      assign unused_changes = ^{may_change_t0_i, changes_t1_i, first_slot_t1_q};
    end else begin : g_no_history
      logic unused_history;
      assign unused_history = first_acq_t1_i ^ visit_t1_i;
      assign fetched = read_q;
      logic take_fetched_q, changed_q, later_slot_may;
      always_ff @(posedge clk_i) begin
        take_fetched_q <= first_slot_t0_i || (take_fetched_q && !may_change_t0_i);
        changed_q <= changes_t1_i || (changed_q && !first_slot_t1_q);
      end
      assign take_fetched = take_fetched_q;
      // In a visit's first slot a word is kept for a later one: with two slots that is the one at T0.
      assign later_slot_may = (SLOTS > 2) || (SLOTS == 2 && may_change_t0_i);
      assign load_word = changes_t1_i || (first_slot_t1_q && later_slot_may);
      assign write_changed = write_i && changed_q;
    end
  endgenerate

  assign word_t1_o = take_fetched ? fetched : word_q;
  assign word_o = read_q;

  `DTOF_ASSERT(a_one_write, !(write_i && start_write_i), "a word is started while another one is written")

endmodule

`default_nettype wire
