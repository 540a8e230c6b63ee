// SPDX-License-Identifier: Apache-2.0
// The pointers of a column: one SRAM word a pixel, moved by the timestamps of all its slots in one
// read-modify-write (thesis 4.3).
//
// Word: {tag, confidence, pointer}; the tag (hisPointer: the coarse peak) is stored with the pointer and
// handed to the user's window test through tag_t1_o.
// Schedule: read (a pixel ahead), data registered one clock later; T1 first slot moves the word just read,
// further slots move word_q; the word is written two clocks after the pixel's last timestamp (T0 of the last
// slot + 2). Reads fall on first-slot clocks and writes one clock behind, so PORTS = 1 works for SLOTS >= 2.
// Hazard: with very few pixels a pixel's word is read before it is written; its place in the cycle is fixed, so
// the word is taken from a short history instead (no comparators).
// A broadcast flag arrives late in a column: first slot and step are registered here, like the timestamp.
// Cost at the defaults: 29 flip-flops of a column, one pointer_update, PIXELS_PER_SRAM words of SRAM.
`include "dtof_macros.svh"

module pointer_builder #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 160,
    parameter int SLOTS = 2,
    parameter int POINTER_STEP = 1,
    parameter int FRACTION_BITS = 0,
    parameter int CONFIDENCE_WIDTH = 4,
    parameter int TAG_WIDTH = 0,  // 0: no tag
    parameter int PORTS = 2,      // ports of the SRAM
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int POINTER_WIDTH = NP + FRACTION_BITS,
    localparam int CONFIDENCE_BITS = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1),
    localparam int TAG_BITS = dtof_pkg::max_of(TAG_WIDTH, 1),
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, FRACTION_BITS)
) (
    input  logic                       clk_i,
    input  logic                       rst_ni,
    // schedule, common to all columns
    input  logic                       read_i,            // fetch ahead, or result read-out
    input  logic [      ROW_WIDTH-1:0] read_pixel_i,
    input  logic                       read_done_i,       // read_i one clock later
    input  logic                       first_slot_t0_i,   // whether or not an acquisition is under way
    input  logic                       visit_t1_i,        // first slot of a pixel's visit
    input  logic                       first_acq_t1_i,
    input  logic                       write_i,           // last slot at T2
    input  logic [      ROW_WIDTH-1:0] write_pixel_i,
    input  logic [     STEP_WIDTH-1:0] step_t0_i,
    // timestamp at T1
    input  logic                       hit_t1_i,
    input  logic [             NP-1:0] timestamp_t1_i,
    output logic [       TAG_BITS-1:0] tag_t1_o,
    // start value of a pixel
    input  logic                       start_write_i,
    input  logic [      ROW_WIDTH-1:0] start_pixel_i,
    input  logic [  POINTER_WIDTH-1:0] start_pointer_i,
    input  logic [       TAG_BITS-1:0] start_tag_i,
    // result: the word last read
    output logic [  POINTER_WIDTH-1:0] pointer_o,
    output logic [CONFIDENCE_BITS-1:0] confidence_o
);

  `DTOF_REQUIRE(g_illegal_ports, PORTS == 2 || SLOTS >= 2,
                "pointer_builder: a single-port SRAM (PORTS = 1) needs SLOTS of at least 2")

  localparam int WORD_WIDTH = POINTER_WIDTH + CONFIDENCE_WIDTH + TAG_WIDTH;
  // A pixel's next read precedes its write if a round of all pixels is shorter than the pipeline.
  localparam int NEEDS_HISTORY = (PIXELS_PER_SRAM * SLOTS < 2 * SLOTS + 2) ? 1 : 0;

  logic [WORD_WIDTH-1:0] sram_data, read_q, fetched, current, moved, word_q, start_word;
  logic [CONFIDENCE_BITS-1:0] current_confidence, moved_confidence;
  logic [POINTER_WIDTH-1:0] moved_pointer;
  logic [STEP_WIDTH-1:0] step_t1;
  logic first_slot_t1_q, take_fetched;

  dtof_sram #(
      .PORTS(PORTS),
      .DEPTH(PIXELS_PER_SRAM),
      .WIDTH(WORD_WIDTH)
  ) u_pointer_sram (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .read_en_i   (read_i),
      .read_addr_i (read_pixel_i),
      .read_data_o (sram_data),
      .write_en_i  (write_i || start_write_i),
      .write_addr_i(start_write_i ? start_pixel_i : write_pixel_i),
      .write_data_i(start_write_i ? start_word : word_q)
  );

  always_ff @(posedge clk_i) begin
    if (read_done_i) begin
      read_q <= sram_data;
    end
    word_q <= moved;
    first_slot_t1_q <= first_slot_t0_i;
  end

  generate
    if (FRACTION_BITS > 0) begin : g_step
      logic [STEP_WIDTH-1:0] step_t1_q;
      always_ff @(posedge clk_i) begin
        step_t1_q <= step_t0_i;
      end
      assign step_t1 = step_t1_q;
    end else begin : g_constant_step
      assign step_t1 = step_t0_i;
    end
  endgenerate

  generate
    if (NEEDS_HISTORY != 0) begin : g_history
      // history_q[n]: the word of the pixel served n + 1 pixels before the one in word_q.
      logic [WORD_WIDTH*PIXELS_PER_SRAM-1:0] history_q;
      always_ff @(posedge clk_i) begin
        if (visit_t1_i) begin
          history_q <= (WORD_WIDTH*PIXELS_PER_SRAM)'({history_q, word_q});
        end
      end
      if (PIXELS_PER_SRAM == 1) begin : g_one_pixel
        assign fetched = first_acq_t1_i ? read_q : word_q;
      end else begin : g_few_pixels
        assign fetched = first_acq_t1_i ? read_q : history_q[(PIXELS_PER_SRAM-2)*WORD_WIDTH+:WORD_WIDTH];
      end
    end else begin : g_no_history
      logic unused_history;
      assign unused_history = first_acq_t1_i ^ visit_t1_i;
      assign fetched = read_q;
    end
  endgenerate

  // Between acquisitions word_q may be overwritten, but where the history takes it over.
  assign take_fetched = (NEEDS_HISTORY != 0) ? visit_t1_i : first_slot_t1_q;
  assign current = take_fetched ? fetched : word_q;

  pointer_update #(
      .NP              (NP),
      .POINTER_STEP    (POINTER_STEP),
      .FRACTION_BITS   (FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH)
  ) u_update (
      .hit_i       (hit_t1_i),
      .timestamp_i (timestamp_t1_i),
      .step_i      (step_t1),
      .pointer_i   (current[POINTER_WIDTH-1:0]),
      .confidence_i(current_confidence),
      .pointer_o   (moved_pointer),
      .confidence_o(moved_confidence)
  );

  `DTOF_ASSERT(a_one_write, !(write_i && start_write_i), "a pointer is started while another one is written")

  assign pointer_o = read_q[POINTER_WIDTH-1:0];
  assign moved[POINTER_WIDTH-1:0] = moved_pointer;
  assign start_word[POINTER_WIDTH-1:0] = start_pointer_i;

  generate
    if (CONFIDENCE_WIDTH > 0) begin : g_confidence
      assign current_confidence = current[POINTER_WIDTH+:CONFIDENCE_WIDTH];
      assign confidence_o = read_q[POINTER_WIDTH+:CONFIDENCE_WIDTH];
      assign moved[POINTER_WIDTH+:CONFIDENCE_WIDTH] = moved_confidence;
      assign start_word[POINTER_WIDTH+:CONFIDENCE_WIDTH] = '0;
    end else begin : g_no_confidence
      logic unused_confidence;
      assign unused_confidence = moved_confidence[0];
      assign current_confidence = '0;
      assign confidence_o = '0;
    end
    if (TAG_WIDTH > 0) begin : g_tag
      assign tag_t1_o = current[POINTER_WIDTH+CONFIDENCE_WIDTH+:TAG_WIDTH];
      assign moved[POINTER_WIDTH+CONFIDENCE_WIDTH+:TAG_WIDTH] = tag_t1_o;
      assign start_word[POINTER_WIDTH+CONFIDENCE_WIDTH+:TAG_WIDTH] = start_tag_i;
    end else begin : g_no_tag
      logic unused_tag;
      assign unused_tag = start_tag_i[0];
      assign tag_t1_o = '0;
    end
  endgenerate

endmodule
