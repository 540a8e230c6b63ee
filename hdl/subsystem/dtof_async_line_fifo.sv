// SPDX-License-Identifier: Apache-2.0
// Takes lines of timestamps from the TDCs' clock to the read-out's clock. Optional, in front of dtof_subsystem's s_axis_*. The two clocks may
// have any ratio and phase, and either may stop.
//
// 1. A line is written to a memory in clk_tdc_i. The write pointer crosses one clock later, the read pointer crosses back, both in Gray code
//    through dtof_synchroniser. s_tready_o is low when DEPTH lines are in the memory, so no line is lost or overwritten.
// 2. The two sides have a reset each. s_tready_o and m_tvalid_o are low in the reset of their side. Lines pass when both sides have left reset
//    and have agreed on an empty memory:
//
//      on_q     TDC side   0 -> 1: the reader waits; the write pointer is cleared.  1 -> 0: the reader was reset, or has drained.
//      reader_q            off -> waits: on_q is 0; the read pointer is cleared.    waits -> live: on_q is 1.
//                          live -> drains: on_q is 0.    drains -> off: the memory is empty, and the last acquisition has its end.
//
//    A line is accepted only with on_q in front of a live reader, and the pointers are cleared only where nothing reads them.
// 3. Reset of the TDC side alone: the read-out gets every line that was accepted more than a clock before. A line of the last clock may be
//    missing, never a part of it. If the reset cuts an acquisition, the FIFO ends it with a line of "no detection" and m_tlast_o. An offered line
//    stays.
// 4. Reset of the read-out side alone: the lines in the memory are lost. If the source is inside an acquisition, the FIFO takes and drops the
//    rest of it, up to s_tlast_i. The first line after the reset is therefore the first line of an acquisition.
// A reset lasts at least four clocks of the other side.
//
// Pipeline, with T = clk_tdc_i and R = clk_i:
//   T 0        s_tvalid_i and s_tready_o: the line is written, the pointer steps
//   T 1        the pointer is in shown_q
//   R 0, R 1   the pointer is in the synchroniser
//   R 2        m_tvalid_o; when the line is taken, its place is free two clocks of T later
// Latency: two clocks of clk_tdc_i and two of clk_i, one more of clk_i where a bit changes at its edge. A depth of eight lines passes a line
// in each clock of the slower side.
// Cost: DEPTH x (WIDTH + 1) flip-flops and a multiplexer of DEPTH lines, WIDTH OR gates; 7 (log2(DEPTH) + 1) + 12 flip-flops.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_async_line_fifo #(
    parameter int WIDTH = 2000,  // bits of a line
    parameter int DEPTH = 8      // lines that the memory holds, a power of two
) (
    // TDCs
    input  logic             clk_tdc_i,
    input  logic             rst_tdc_ni,
    input  logic             s_tvalid_i,
    output logic             s_tready_o,  // low in reset, and until both sides have left reset
    input  logic [WIDTH-1:0] s_tdata_i,
    input  logic             s_tlast_i,   // the last line of an acquisition
    // read-out
    input  logic             clk_i,
    input  logic             rst_ni,
    output logic             m_tvalid_o,  // low in reset
    input  logic             m_tready_i,
    output logic [WIDTH-1:0] m_tdata_o,
    output logic             m_tlast_o
);

  `DTOF_REQUIRE(g_illegal_width, WIDTH >= 1, "dtof_async_line_fifo: WIDTH must be at least 1")
  `DTOF_REQUIRE(g_illegal_depth, DEPTH >= 2 && (DEPTH & (DEPTH - 1)) == 0, "dtof_async_line_fifo: DEPTH must be a power of two, at least 2")

  localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1;
  localparam int POINTER_WIDTH = ADDR_WIDTH + 1;
  localparam logic [POINTER_WIDTH-1:0] WHOLE_DEPTH = POINTER_WIDTH'(3 << (POINTER_WIDTH - 2));  // between Gray codes that are DEPTH apart
  // States of the reader. From state to state one bit changes, except in reset.
  localparam logic [1:0] OFF = 2'b00, WAITS = 2'b01, LIVE = 2'b11, DRAINS = 2'b10;

  logic on_q;
  logic [1:0] reader_q;
  logic [POINTER_WIDTH-1:0] shown_q, read_pointer;  // as the other side sees them
  logic [WIDTH:0] memory[DEPTH];                    // {last, line}

  // TDC side

  logic [1:0] reader;  // reader_q in this clock
  logic [POINTER_WIDTH-1:0] write_pointer, freed;
  logic [ADDR_WIDTH-1:0] write_address;
  logic accepted, write, begins;
  logic inside_q;  // the source is inside an acquisition
  logic skip_q;    // the rest of this acquisition is dropped

  dtof_synchroniser #(
      .WIDTH(2)
  ) u_reader (
      .clk_i (clk_tdc_i),
      .rst_ni(rst_tdc_ni),
      .d_i   (reader_q),
      .q_o   (reader)
  );

  dtof_synchroniser #(
      .WIDTH(POINTER_WIDTH)
  ) u_freed (
      .clk_i (clk_tdc_i),
      .rst_ni(rst_tdc_ni),
      .d_i   (read_pointer),
      .q_o   (freed)
  );

  dtof_gray_pointer #(
      .WIDTH(POINTER_WIDTH)
  ) u_write_pointer (
      .clk_i    (clk_tdc_i),
      .rst_ni   (rst_tdc_ni),
      .clear_i  (begins),
      .step_i   (write),
      .gray_o   (write_pointer),
      .address_o(write_address)
  );

  assign s_tready_o = on_q && (reader == LIVE) && (write_pointer != (freed ^ WHOLE_DEPTH));
  assign accepted = s_tvalid_i && s_tready_o;
  assign write = accepted && !skip_q;
  assign begins = !on_q && (reader == WAITS);

  always_ff @(posedge clk_tdc_i or negedge rst_tdc_ni) begin
    if (!rst_tdc_ni) begin
      on_q <= 1'b0;
      inside_q <= 1'b0;
      skip_q <= 1'b0;
    end else begin
      on_q <= on_q ? reader[0] : begins;
      if (accepted) begin
        inside_q <= !s_tlast_i;
      end
      if (on_q && !reader[0]) begin
        skip_q <= inside_q;
      end else if (accepted && s_tlast_i) begin
        skip_q <= 1'b0;
      end
    end
  end

  // The memory has no reset. A reset in the clock of a write may leave a part of the line behind; the pointer to it is not shown then.
  always_ff @(posedge clk_tdc_i) begin
    if (write) begin
      memory[write_address] <= {s_tlast_i, s_tdata_i};
    end
    if (begins) begin
      shown_q <= '0;
    end else if (on_q) begin
      shown_q <= write_pointer;
    end
  end

  // Read-out side

  logic [POINTER_WIDTH-1:0] stored;
  logic [ADDR_WIDTH-1:0] read_address;
  logic on, empty, take;
  logic open_q;  // the read-out has lines of an acquisition, and not its end

  dtof_synchroniser #(
      .WIDTH      (1),
      .RESET_VALUE(1'b1)
  ) u_on (
      .clk_i (clk_i),
      .rst_ni(rst_ni),
      .d_i   (on_q),
      .q_o   (on)
  );

  dtof_synchroniser #(
      .WIDTH(POINTER_WIDTH)
  ) u_stored (
      .clk_i (clk_i),
      .rst_ni(rst_ni),
      .d_i   (shown_q),
      .q_o   (stored)
  );

  dtof_gray_pointer #(
      .WIDTH(POINTER_WIDTH)
  ) u_read_pointer (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .clear_i  (reader_q == OFF),
      .step_i   (take && !empty),
      .gray_o   (read_pointer),
      .address_o(read_address)
  );

  assign empty = (read_pointer == stored);
  // The last pointer may arrive a clock after on: drains begins a clock after on, too.
  assign m_tvalid_o = reader_q[1] && (!empty || (reader_q == DRAINS && open_q));
  assign take = m_tvalid_o && m_tready_i;
  assign {m_tlast_o, m_tdata_o} = memory[read_address] | {(WIDTH + 1) {empty}};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      reader_q <= OFF;
      open_q <= 1'b0;
    end else begin
      if (take) begin
        open_q <= !m_tlast_o;
      end
      case (reader_q)
        OFF: if (!on) reader_q <= WAITS;
        WAITS: if (on) reader_q <= LIVE;
        LIVE: if (!on) reader_q <= DRAINS;
        default: if (empty && !open_q) reader_q <= OFF;
      endcase
    end
  end

endmodule

`default_nettype wire
