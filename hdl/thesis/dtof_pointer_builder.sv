// SPDX-License-Identifier: Apache-2.0
// The pointers of a column: one word per pixel, which the timestamps of all its slots move (thesis 4.3).
//
// The word {tag, confidence, pointer} is stored in a dtof_word_builder, which has the schedule, the SRAM and its hazards.
// dtof_pointer_update between two of its ports computes the next word (equation there). The tag (hisPointer: the coarse peak) is stored
// with the pointer. tag_t1_o gives the tag to the window test of the column, which drives hit_t1_i in the same clock.
//
// Broadcast signals arrive late in a column. Therefore the step is registered here like the timestamp, if it is not constant.
// Schedule and latency: those of dtof_word_builder.
// Cost at the defaults: 31 flip-flops, one dtof_pointer_update, PIXELS_PER_SRAM words of SRAM, per column.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pointer_builder #(
    parameter int NP = 10,               // bits of a timestamp
    parameter int PIXELS_PER_SRAM = 160,  // pointers
    parameter int SLOTS = 2,             // consecutive timestamps of a pixel
    parameter int POINTER_STEP = 1,      // bins that a pointer moves
    parameter int FRACTION_BITS = 0,     // fractional bits of a pointer
    parameter int CONFIDENCE_WIDTH = 4,  // 0: no confidence
    parameter int TAG_WIDTH = 0,         // 0: no tag
    parameter int PORTS = 2,             // ports of the SRAM; 1 needs SLOTS >= 2
    parameter int PARITY = 0,            // 1: each word has a parity bit
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int POINTER_WIDTH = NP + FRACTION_BITS,
    localparam int CONFIDENCE_BITS = dtof_pkg::max_of(CONFIDENCE_WIDTH, 1),
    localparam int TAG_BITS = dtof_pkg::max_of(TAG_WIDTH, 1),
    localparam int STEP_WIDTH = dtof_pkg::step_width(POINTER_STEP, FRACTION_BITS)
) (
    input  logic                       clk_i,
    input  logic                       rst_ni,           // for assertions and the check of parity only
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // schedule, the same for all columns
    input  logic                       read_i,           // read before the pixel's timestamps, or for its result
    input  logic [      ROW_WIDTH-1:0] read_pixel_i,
    input  logic                       read_done_i,      // read_i one clock later
    input  logic                       first_slot_t0_i,  // also while no acquisition is in progress
    input  logic                       visit_t1_i,       // first slot of a pixel's visit
    input  logic                       first_acq_t1_i,   // the visit is in the first acquisition of a pass
    input  logic                       write_i,          // last slot of a pixel at T2
    input  logic [      ROW_WIDTH-1:0] write_pixel_i,
    input  logic [     STEP_WIDTH-1:0] step_t0_i,        // (POINTER_STEP << FRACTION_BITS) >> gear
    // timestamp at T1
    input  logic                       may_hit_t0_i,     // the timestamp at T0 may move the pointer
    input  logic                       hit_t1_i,         // the timestamp at T1 moves the pointer, or changes its confidence
    input  logic [             NP-1:0] timestamp_t1_i,
    output logic [       TAG_BITS-1:0] tag_t1_o,         // tag of the timestamp's pixel
    // start value of a pixel, never in the clock of write_i; its confidence is 0
    input  logic                       start_write_i,
    input  logic [      ROW_WIDTH-1:0] start_pixel_i,
    input  logic [  POINTER_WIDTH-1:0] start_pointer_i,
    input  logic [       TAG_BITS-1:0] start_tag_i,
    // result: the word that was read last
    output logic [  POINTER_WIDTH-1:0] pointer_o,
    output logic [CONFIDENCE_BITS-1:0] confidence_o,
    output logic                       parity_error_o    // with PARITY = 1: the word that was read two clocks ago is damaged
);

  localparam int WORD_WIDTH = POINTER_WIDTH + CONFIDENCE_WIDTH + TAG_WIDTH;

  logic [WORD_WIDTH-1:0] read_word, current, moved, start_word;
  logic [CONFIDENCE_BITS-1:0] current_confidence, moved_confidence;
  logic [POINTER_WIDTH-1:0] moved_pointer;
  logic [STEP_WIDTH-1:0] step_t1;

  dtof_word_builder #(
      .WIDTH          (WORD_WIDTH),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SLOTS          (SLOTS),
      .PORTS          (PORTS),
      .PARITY         (PARITY)
  ) u_word_builder (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .sram_cfg_i     (sram_cfg_i),
      .sram_cfg_o     (sram_cfg_o),
      .read_i         (read_i),
      .read_pixel_i   (read_pixel_i),
      .read_done_i    (read_done_i),
      .first_slot_t0_i(first_slot_t0_i),
      .visit_t1_i     (visit_t1_i),
      .first_acq_t1_i (first_acq_t1_i),
      .write_i        (write_i),
      .write_pixel_i  (write_pixel_i),
      .may_change_t0_i(may_hit_t0_i),
      .changes_t1_i   (hit_t1_i),
      .word_t1_o      (current),
      .next_t1_i      (moved),
      .start_write_i  (start_write_i),
      .start_pixel_i  (start_pixel_i),
      .start_word_i   (start_word),
      .word_o         (read_word),
      .parity_error_o (parity_error_o)
  );

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

  dtof_pointer_update #(
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

  assign pointer_o = read_word[POINTER_WIDTH-1:0];
  assign moved[POINTER_WIDTH-1:0] = moved_pointer;
  assign start_word[POINTER_WIDTH-1:0] = start_pointer_i;

  generate
    if (CONFIDENCE_WIDTH > 0) begin : g_confidence
      assign current_confidence = current[POINTER_WIDTH+:CONFIDENCE_WIDTH];
      assign confidence_o = read_word[POINTER_WIDTH+:CONFIDENCE_WIDTH];
      assign moved[POINTER_WIDTH+:CONFIDENCE_WIDTH] = moved_confidence;
      assign start_word[POINTER_WIDTH+:CONFIDENCE_WIDTH] = '0;
    end else begin : g_no_confidence
      logic unused_confidence;
      assign unused_confidence = moved_confidence[0];
      assign current_confidence = '0;
      assign confidence_o = '0;
    end
    if (TAG_WIDTH > 0) begin : g_tag
      logic unused_read_tag;  // the result has no tag
      assign unused_read_tag = ^read_word[POINTER_WIDTH+CONFIDENCE_WIDTH+:TAG_WIDTH];
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

`default_nettype wire
