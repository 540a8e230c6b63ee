// SPDX-License-Identifier: Apache-2.0
// Lines of timestamps on their way to an array, which takes an acquisition without a pause once it has begun.
//
// 1. A line, one timestamp of every column, comes whenever the source has one; the source may pause anywhere.
// 2. s_tlast_i ends an acquisition. One that ends early is short: its missing lines are "no detection". One that does not
//    end with its ACQUISITION_LINES-th line is long: the lines behind are thrown away, up to and with the next s_tlast_i.
//    Either way the next acquisition begins behind s_tlast_i.
// 3. An acquisition is offered to the array when its last line is in the buffer, or release_i lines are. With
//    release_i = ACQUISITION_LINES it is whole then, and cannot be interrupted.
// 4. With less, the buffer may run empty inside an acquisition (underrun_o). Its other lines then are "no detection",
//    and those that the source still delivers for it are thrown away.
// 5. Behind expire_i every line is "no detection", without a pause, until done_i. Lines that come meanwhile are kept for
//    the next frame.
// 6. flush_i, abort_i and expire_i empty the buffer. Behind abort_i and expire_i the rest of the acquisition that the source
//    is in is thrown away, up to and with its s_tlast_i; behind flush_i the next line begins an acquisition.
//
// Latency: two clocks from a line's acceptance to its offer. A line a clock goes in and out at the same time.
// Cost: an SRAM of LINES x (WIDTH + 1 + PARITY) bits, two addresses, five counters.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_line_buffer #(
    parameter int ACQUISITION_LINES = 320,  // of an acquisition
    parameter int LINES = 324,              // that the memory holds; one more waits at its output
    parameter int WIDTH = 2000,             // bits of a line
    parameter int PARITY = 0,               // 1: each word of the memory has a parity bit
    localparam int LEVEL_WIDTH = $clog2(LINES + 2)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    // side band of the SRAM macros, which the technology folder gives a meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    input  logic                   flush_i,      // without abort_i: not while an acquisition is under way
    input  logic                   abort_i,      // the array's frame ends here
    input  logic                   expire_i,     // without effect where starved_o is low
    input  logic                   done_i,       // the array's frame ends by itself
    input  logic [LEVEL_WIDTH-1:0] release_i,    // 1 to the smaller of ACQUISITION_LINES and LINES
    output logic [LEVEL_WIDTH-1:0] level_o,      // lines in the buffer
    output logic                   starved_o,    // the array waits for an acquisition
    output logic                   queued_o,     // an acquisition is here of which the array has no line yet
    output logic                   inside_o,     // the source is inside an acquisition
    // these for one clock
    output logic                   kept_o,       // a line was accepted and is no rest of a long acquisition
    output logic                   arrives_o,    // likewise, the first of an acquisition
    output logic                   rest_ends_o,  // the last line of a rest that is thrown away was accepted
    output logic                   taken_o,      // the array takes the first line of an acquisition
    output logic                   underrun_o,   // the array needs a line that is not here: once an acquisition
    output logic                   short_o,      // s_tlast_i came before an acquisition's last line
    output logic                   long_o,       // s_tlast_i did not come with it
    output logic [LEVEL_WIDTH-1:0] lost_lines_o, // so many lines of the source are thrown away by themselves
    output logic                   parity_error_o,      // a line that was read two clocks ago is damaged
    output logic                   lost_acquisition_o,  // the array has taken an acquisition with lines that are missing
    // from the source, AXI4-Stream
    input  logic                   s_tvalid_i,
    output logic                   s_tready_o,   // low in reset
    input  logic [      WIDTH-1:0] s_tdata_i,
    input  logic                   s_tlast_i,    // the last line of an acquisition
    // to the array
    output logic                   line_valid_o,  // high for a whole acquisition
    input  logic                   line_ready_i,
    output logic [      WIDTH-1:0] line_o
);

  localparam int ADDR_WIDTH = dtof_pkg::index_width(LINES);
  localparam int INDEX_WIDTH = dtof_pkg::index_width(ACQUISITION_LINES);
  localparam logic [ADDR_WIDTH-1:0] LAST_ADDRESS = ADDR_WIDTH'(LINES - 1);
  localparam logic [INDEX_WIDTH-1:0] LAST_LINE = INDEX_WIDTH'(ACQUISITION_LINES - 1);

  `DTOF_REQUIRE(g_illegal_acquisition, ACQUISITION_LINES >= 1, "dtof_line_buffer: ACQUISITION_LINES must be at least 1")
  `DTOF_REQUIRE(g_illegal_lines, LINES >= 2, "dtof_line_buffer: LINES must be at least 2")

  // The source's side. A line is stored with whether its acquisition ends with it.

  logic [ADDR_WIDTH-1:0] write_address_q, read_address_q;
  logic [LEVEL_WIDTH-1:0] stored_q;    // in the memory
  logic [LEVEL_WIDTH-1:0] complete_q;  // acquisitions whose end is in the buffer
  logic [LEVEL_WIDTH-1:0] queued_q;    // acquisitions that have begun to arrive, and the array has not begun them
  logic [INDEX_WIDTH-1:0] source_line_q;
  logic live_q;    // not in reset
  logic behind_q;  // what comes up to s_tlast_i belongs to an acquisition that is over
  logic drain_q;   // the rest of the frame is "no detection" for the array
  logic accepted, write, ends, read, take, head_q, head_ends, empties, expires;

  assign empties = flush_i || abort_i || expires;
  assign s_tready_o = live_q && (behind_q || stored_q != LEVEL_WIDTH'(LINES)) && !flush_i && !abort_i && !expire_i;
  assign accepted = s_tvalid_i && s_tready_o;
  assign write = accepted && !behind_q;
  assign ends = s_tlast_i || (source_line_q == LAST_LINE);
  assign short_o = write && s_tlast_i && (source_line_q != LAST_LINE);
  assign long_o = write && !s_tlast_i && (source_line_q == LAST_LINE);
  assign kept_o = write;
  assign arrives_o = write && (source_line_q == '0);
  assign rest_ends_o = accepted && behind_q && s_tlast_i;
  assign queued_o = (queued_q != '0);
  assign inside_o = behind_q || (source_line_q != '0);

  // The line at the memory's output (head_q) stays there until the next is read.
  assign read = (stored_q != '0) && (!head_q || take);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      live_q <= 1'b0;
      behind_q <= 1'b0;
      write_address_q <= '0;
      read_address_q <= '0;
      stored_q <= '0;
      complete_q <= '0;
      queued_q <= '0;
      source_line_q <= '0;
      head_q <= 1'b0;
    end else begin
      live_q <= 1'b1;
      if (empties) begin
        behind_q <= !flush_i && (behind_q || source_line_q != '0);
        write_address_q <= '0;
        read_address_q <= '0;
        stored_q <= '0;
        complete_q <= '0;
        queued_q <= '0;
        source_line_q <= '0;
        head_q <= 1'b0;
      end else begin
        if (accepted) begin
          behind_q <= !s_tlast_i && (behind_q || long_o);
        end
        if (write) begin
          write_address_q <= (write_address_q == LAST_ADDRESS) ? '0 : write_address_q + 1'b1;
          source_line_q <= ends ? '0 : source_line_q + 1'b1;
        end
        if (read) begin
          read_address_q <= (read_address_q == LAST_ADDRESS) ? '0 : read_address_q + 1'b1;
        end
        stored_q <= stored_q + LEVEL_WIDTH'(write) - LEVEL_WIDTH'(read);
        complete_q <= complete_q + LEVEL_WIDTH'(write && ends) - LEVEL_WIDTH'(take && head_ends);
        queued_q <= queued_q + LEVEL_WIDTH'(arrives_o) - LEVEL_WIDTH'(taken_o && !drain_q);
        head_q <= read || (head_q && !take);
      end
    end
  end

  logic [WIDTH-1:0] head;

  dtof_parity_sram #(
      .PORTS (2),
      .DEPTH (LINES),
      .WIDTH (WIDTH + 1),
      .PARITY(PARITY)
  ) u_lines (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read),
      .read_addr_i (read_address_q),
      .read_data_o ({head_ends, head}),
      .error_o     (parity_error_o),
      .write_en_i  (write),
      .write_addr_i(write_address_q),
      .write_data_i({ends, s_tdata_i})
  );

  // The array's side.

  logic inside_q, starved_q;
  logic fill_q;     // the rest of the acquisition is "no detection"
  logic discard_q;  // the lines at the head up to their acquisition's end are too late
  logic [INDEX_WIDTH-1:0] line_q;  // of the acquisition
  logic begin_allowed, step, last_line, missing;

  assign level_o = stored_q + LEVEL_WIDTH'(head_q);
  assign begin_allowed = drain_q || (head_q && !discard_q && (complete_q != '0 || level_o >= release_i));
  assign line_valid_o = inside_q || begin_allowed;
  assign step = line_valid_o && line_ready_i;
  assign last_line = (line_q == LAST_LINE);
  assign taken_o = step && (line_q == '0);
  assign missing = drain_q || fill_q || (inside_q && !head_q);
  assign underrun_o = step && inside_q && !head_q && !fill_q && !drain_q;
  assign line_o = missing ? '1 : head;
  assign take = head_q && ((step && !missing) || discard_q);
  assign starved_o = (starved_q || line_ready_i) && !line_valid_o;
  assign expires = expire_i && starved_o;
  assign lost_lines_o = expires ? level_o : LEVEL_WIDTH'(accepted && behind_q) + LEVEL_WIDTH'(take && discard_q);
  assign lost_acquisition_o = step && last_line && missing;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      inside_q <= 1'b0;
      starved_q <= 1'b0;
      fill_q <= 1'b0;
      discard_q <= 1'b0;
      drain_q <= 1'b0;
      line_q <= '0;
    end else if (abort_i) begin
      inside_q <= 1'b0;
      starved_q <= 1'b0;
      fill_q <= 1'b0;
      discard_q <= 1'b0;
      drain_q <= 1'b0;
      line_q <= '0;
    end else begin
      starved_q <= starved_o;
      if (step) begin
        inside_q <= !last_line;
        line_q <= last_line ? '0 : line_q + 1'b1;
        fill_q <= (missing || head_ends) && !last_line;
      end
      if (empties) begin
        discard_q <= 1'b0;
      end else if (underrun_o) begin
        discard_q <= 1'b1;
      end else if (take && head_ends) begin
        discard_q <= 1'b0;
      end
      drain_q <= expires || (drain_q && !done_i);
    end
  end

  `DTOF_ASSERT(a_queued, !taken_o || drain_q || queued_o, "the array takes an acquisition that has not arrived")
  `DTOF_ASSERT(a_release, release_i != '0, "release_i is 0")
  `DTOF_ASSERT(a_flush_between, !flush_i || abort_i || !inside_q, "the buffer is flushed inside an acquisition")

endmodule

`default_nettype wire
