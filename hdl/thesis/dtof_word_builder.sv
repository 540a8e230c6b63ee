// SPDX-License-Identifier: Apache-2.0
// One word per pixel in an SRAM. All timestamps of a pixel's visit change the word with one read and one write.
//
// 1. The word is read while the pixel before is in work, and registered one clock later.
// 2. At T1 of each of the pixel's timestamps word_t1_o has the word, and next_t1_i replaces it. The user's combinational
//    update lies between these two ports (dtof_pointer_builder: a step of a pointer).
// 3. Two clocks after the pixel's last timestamp the word is written, if a timestamp has changed it.
// 4. Outside a pass a word is set to start_word_i, or read for the result: word_o has the word that was read last.
//
// With very few pixels a word is read before its last visit was written. The distance to that visit is then constant,
// so the word is taken from a short history instead (no comparators).
//
//   clock             work
//   a pixel ahead     SRAM read, data registered one clock later
//   T1 first slot     word_t1_o is the word that was read
//   T1 further slots  word_t1_o is next_t1_i of the slot before
//   T2 last slot      SRAM write
//
// Reads are in first-slot clocks and writes one clock after, so PORTS = 1 works for SLOTS >= 2. Broadcast signals
// arrive late in a column; therefore the first slot is registered here, like the timestamp.
//
// Without a detection the registers hold: word_q is loaded only if a timestamp of the visit may change the word, and
// the multiplexer before the update selects word_q only for a timestamp after the first slot that may change the word.
// Latency: none from word_t1_o to next_t1_i; 1 clock from the last slot at T1 to the write; word_o two clocks after read_i.
// Cost: 2 WIDTH + 3 flip-flops, a multiplexer, PIXELS_PER_SRAM words of SRAM; block RAM on an FPGA.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_word_builder #(
    parameter int WIDTH = 14,             // bits of a word
    parameter int PIXELS_PER_SRAM = 160,  // words
    parameter int SLOTS = 2,              // consecutive timestamps of a pixel
    parameter int PORTS = 2,              // ports of the SRAM; 1 needs SLOTS >= 2
    parameter int PARITY = 0,             // 1: each word has a parity bit
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM)
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,           // for assertions and the check of parity only
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // schedule, the same for all columns
    input  logic                 read_i,           // read before the pixel's timestamps, or for its result
    input  logic [ROW_WIDTH-1:0] read_pixel_i,
    input  logic                 read_done_i,      // read_i one clock later
    input  logic                 first_slot_t0_i,  // also while no acquisition is in progress
    input  logic                 visit_t1_i,       // first slot of a pixel's visit
    input  logic                 first_acq_t1_i,   // the visit is in the first acquisition of a pass
    input  logic                 write_i,          // last slot of a pixel at T2
    input  logic [ROW_WIDTH-1:0] write_pixel_i,
    // update of the word, between word_t1_o and next_t1_i
    input  logic                 may_change_t0_i,  // the timestamp at T0 may change the word
    input  logic                 changes_t1_i,     // the timestamp at T1 changes the word; only if may_change_t0_i was high
    output logic [    WIDTH-1:0] word_t1_o,        // word of the pixel at T1, valid if the timestamp may change it
    input  logic [    WIDTH-1:0] next_t1_i,        // word after that timestamp
    // start value of a pixel, never in the clock of write_i
    input  logic                 start_write_i,
    input  logic [ROW_WIDTH-1:0] start_pixel_i,
    input  logic [    WIDTH-1:0] start_word_i,
    // result
    output logic [    WIDTH-1:0] word_o,           // the word that was read last, two clocks after read_i
    output logic                 parity_error_o    // with PARITY = 1: the word of two clocks ago is damaged
);

  `DTOF_REQUIRE(g_illegal_ports, PORTS == 2 || SLOTS >= 2,
                "dtof_word_builder: a single-port SRAM (PORTS = 1) needs SLOTS of at least 2")

  // A pixel's next read comes before its write if a round of all pixels is shorter than the pipeline.
  localparam int NEEDS_HISTORY = (PIXELS_PER_SRAM * SLOTS < 2 * SLOTS + 2) ? 1 : 0;

  logic [WIDTH-1:0] sram_data, read_q, fetched, word_q;
  logic first_slot_t1_q, take_fetched, load_word, write_changed;

  dtof_parity_sram #(
      .PORTS(PORTS),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(WIDTH),
      .PARITY(PARITY)
  ) u_word_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read_i),
      .read_addr_i (read_pixel_i),
      .read_data_o (sram_data),
      .ignore_i    (1'b0),
      .error_o     (parity_error_o),
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
      // history_q[n]: word of the pixel that was served n + 1 pixels before that of word_q.
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
      // The history takes word_q at each visit, changed or not.
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
      // In the first slot of a visit the word is kept for a later slot; with two slots that slot is at T0.
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
