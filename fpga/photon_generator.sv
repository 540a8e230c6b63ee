// SPDX-License-Identifier: Apache-2.0
// Source of lines of TDC timestamps without a sensor: pseudo-random photons of each pixel's target, and of the background.
//
// In every acquisition a pixel has
//   - with a probability of 1/4 an event of its target, at target + a + b - 31, where a and b are uniform in 0 to 31: a triangular
//     pulse with a width of 32 codes at half its height; an event outside the codes is no detection;
//   - with a probability of 1/2 an event of the background, uniform over all codes.
// The earlier event is in slot 0, the other in slot 1. All randomness comes from one xorshift register (Marsaglia 2003: shifts 13, 17,
// 5), with one step per pixel. Targets begin as a ramp over the pixels, TARGET_FIRST + pixel x TARGET_STEP, and are written
// through target_*; pixel = row x COLUMNS + column.
//
// | clock of a pixel | work |
// | 0 | read the pixel's target |
// | 1 | draw random bits; register both codes |
// | 2 | sort the codes and shift them into the row's two lines |
//
// Latency: 3 clocks from the read of a target to its codes in the lines. Rate: two lines every COLUMNS + 4 clocks, if the sink takes
// them. The stream obeys AXI4-Stream; tlast ends an acquisition.
// Cost: a memory of ROWS x COLUMNS targets, the two lines, 32 bits of the random register.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module photon_generator #(
    parameter int NP = 10,
    parameter int COLUMNS = 8,
    parameter int ROWS = 8,
    parameter logic [31:0] SEED = 32'h2545F491,
    localparam int PIXEL_WIDTH = dtof_pkg::index_width(ROWS * COLUMNS),
    localparam int TDATA_WIDTH = 8 * ((COLUMNS * NP + 7) / 8)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   target_write_i,   // one clock; then not for the next COLUMNS + ROWS x COLUMNS
    input  logic [PIXEL_WIDTH-1:0] target_pixel_i,
    input  logic [         NP-1:0] target_code_i,
    output logic                   m_axis_tvalid_o,
    input  logic                   m_axis_tready_i,
    output logic [TDATA_WIDTH-1:0] m_axis_tdata_o,   // a timestamp of every column, column 0 in the lowest bits
    output logic                   m_axis_tlast_o
);

  localparam int PIXELS = ROWS * COLUMNS;
  localparam int PULSE_REACH = 31;  // codes before and behind the target
  localparam int TARGET_FIRST = 1 << (NP - 3);
  localparam int TARGET_STEP = ((1 << NP) - 2 * TARGET_FIRST) / PIXELS;
  localparam int COLUMN_WIDTH = dtof_pkg::index_width(COLUMNS);
  localparam logic [PIXEL_WIDTH-1:0] LAST_PIXEL = PIXEL_WIDTH'(PIXELS - 1);
  localparam logic [COLUMN_WIDTH-1:0] LAST_COLUMN = COLUMN_WIDTH'(COLUMNS - 1);

  `DTOF_REQUIRE(g_illegal_np, NP >= 6 && NP <= 16, "photon_generator: NP must be 6 to 16")
  `DTOF_REQUIRE(g_illegal_seed, SEED != 0, "photon_generator: SEED must not be 0, where xorshift stays")

  localparam logic [2:0] FILL = 3'd0, DRAW = 3'd1, SETTLE = 3'd2, SEND_FIRST = 3'd3, SEND_SECOND = 3'd4;

  logic [2:0] state_q;
  logic [PIXEL_WIDTH-1:0] pixel_q;
  logic [COLUMN_WIDTH-1:0] column_q;
  logic last_column, draw, ordered, sent;
  logic drawn_q, settled_q;

  assign draw = (state_q == DRAW);
  assign last_column = (column_q == LAST_COLUMN);
  assign ordered = settled_q;
  assign sent = m_axis_tvalid_o && m_axis_tready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q <= FILL;
      pixel_q <= '0;
      column_q <= '0;
      drawn_q <= 1'b0;
      settled_q <= 1'b0;
    end else begin
      drawn_q <= draw;
      settled_q <= drawn_q;
      if (state_q == FILL || draw) begin
        pixel_q <= (pixel_q == LAST_PIXEL) ? '0 : pixel_q + 1'b1;
      end
      if (draw) begin
        column_q <= last_column ? '0 : column_q + 1'b1;
      end
      case (state_q)
        FILL: if (pixel_q == LAST_PIXEL) state_q <= DRAW;
        DRAW: if (last_column) state_q <= SETTLE;
        SETTLE: if (!drawn_q) state_q <= SEND_FIRST;
        SEND_FIRST: if (sent) state_q <= SEND_SECOND;
        default: if (sent) state_q <= DRAW;
      endcase
    end
  end

  // Targets. A written target is stored when no target is read.

  logic fill, write_q, write;
  logic [PIXEL_WIDTH-1:0] write_pixel_q;
  logic [NP-1:0] write_code_q, fill_code_q, target;

  assign fill = (state_q == FILL);
  assign write = fill || (write_q && !draw);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      write_q <= 1'b0;
      fill_code_q <= NP'(TARGET_FIRST);
    end else begin
      write_q <= target_write_i || (write_q && (fill || draw));
      if (fill) begin
        fill_code_q <= fill_code_q + NP'(TARGET_STEP);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (target_write_i) begin
      write_pixel_q <= target_pixel_i;
      write_code_q <= target_code_i;
    end
  end

  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] unused_cfg;

  dtof_sram #(
      .PORTS(2),
      .DEPTH(PIXELS),
      .WIDTH(NP)
  ) u_targets (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       ('0),
      .cfg_o       (unused_cfg),
      .read_en_i   (draw),
      .read_addr_i (pixel_q),
      .read_data_o (target),
      .write_en_i  (write),
      .write_addr_i(fill ? pixel_q : write_pixel_q),
      .write_parts_i(1'b1),
      .write_data_i(fill ? fill_code_q : write_code_q)
  );

  // Random bits.

  logic [31:0] random_q, step_1, step_2, step_3;

  assign step_1 = random_q ^ (random_q << 13);
  assign step_2 = step_1 ^ (step_1 >> 17);
  assign step_3 = step_2 ^ (step_2 << 5);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      random_q <= SEED;
    end else if (drawn_q) begin
      random_q <= step_3;
    end
  end

  // Events: bits 1:0 select an event of the target, bits 6:2 and 11:7 its position; bit 12 selects an event of the background, bits from 13 on its position.

  logic [NP+1:0] place;  // the sign is the highest bit
  logic target_here;
  logic [NP-1:0] target_event_q, background_event_q;

  assign place = (NP + 2)'(target) + (NP + 2)'(random_q[6:2]) + (NP + 2)'(random_q[11:7]) - (NP + 2)'(PULSE_REACH);
  assign target_here = (random_q[1:0] == '0) && (place[NP+1:NP] == '0);

  always_ff @(posedge clk_i) begin
    if (drawn_q) begin
      target_event_q <= target_here ? place[NP-1:0] : '1;
      background_event_q <= random_q[12] ? random_q[13+:NP] : '1;
    end
  end

  // Lines of the row. After the last column, column 0 has been shifted to the lowest bits.

  logic target_first;
  logic [COLUMNS*NP-1:0] first_q, second_q, line;

  assign target_first = (target_event_q <= background_event_q);

  always_ff @(posedge clk_i) begin
    if (ordered) begin
      first_q <= {target_first ? target_event_q : background_event_q, first_q[COLUMNS*NP-1:NP]};
      second_q <= {target_first ? background_event_q : target_event_q, second_q[COLUMNS*NP-1:NP]};
    end
  end

  assign m_axis_tvalid_o = (state_q == SEND_FIRST) || (state_q == SEND_SECOND);
  assign line = (state_q == SEND_FIRST) ? first_q : second_q;
  assign m_axis_tdata_o = TDATA_WIDTH'(line);
  assign m_axis_tlast_o = (state_q == SEND_SECOND) && (pixel_q == '0);

endmodule

`default_nettype wire
