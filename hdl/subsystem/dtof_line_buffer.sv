// SPDX-License-Identifier: Apache-2.0
// Buffers lines of timestamps for an array. An array that has begun an acquisition takes a line in each of its clocks.
//
// 1. A line has one timestamp of every column. The source may pause before any line.
// 2. s_tlast_i ends an acquisition. If it comes early, the acquisition is short: the missing lines are "no detection". If it does not
//    come with the ACQUISITION_LINES-th line, the acquisition is long: the buffer ignores the lines after this line, up to and with
//    the next s_tlast_i. In both cases the next acquisition begins after s_tlast_i.
// 3. CLOCK_WAITS = 1: the buffer offers an acquisition to the array when the first line has arrived. While a line is late inside an
//    acquisition, wait_o is high and the array's clock is stopped: the ports of the array have no effect in these clocks.
// 4. CLOCK_WAITS = 0, for an array whose clock cannot be gated: the buffer offers an acquisition when its last line, or release_i
//    lines, have arrived. With release_i = ACQUISITION_LINES the acquisition is complete and cannot be interrupted. With less, the
//    buffer may run empty inside an acquisition (underrun_o). The other lines of this acquisition are then "no detection", and the
//    buffer ignores the lines that the source still delivers for it.
// 5. SOURCE_WAITS = 0, for a source that cannot wait: s_tready_o is high outside of reset. If there is no room for a line, the buffer
//    drops the line's whole acquisition (dropped_o), which the array has not begun. SOURCE_WAITS = 1: the source waits. With
//    CLOCK_WAITS = 0 the buffer then offers an acquisition at the latest when the lines of ARRAY_WAIT clocks still find room, whatever
//    release_i is. Otherwise an array that cannot begin in the clock in which the buffer becomes full would lose each acquisition.
// 6. After expire_i every line is "no detection", without a pause, until done_i. The buffer stores lines that arrive in this time for
//    the next frame.
// 7. flush_i, abort_i and expire_i empty the buffer. After abort_i and expire_i the buffer ignores the rest of the acquisition that the
//    source is delivering, up to and with its s_tlast_i. After flush_i the next line begins an acquisition.
//
// Latency: one clock from a line's acceptance to its offer with REGISTERS = 1, else two. One line per clock enters and leaves.
// Cost: LINES x (WIDTH + 1) flip-flops and a multiplexer of LINES lines, or an SRAM of LINES x (WIDTH + 1 + PARITY) bits; two
// addresses, five counters.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_line_buffer #(
    parameter int ACQUISITION_LINES = 320,  // of an acquisition
    parameter int LINES = 2,                // lines that the memory holds; an SRAM has one more line at its output
    parameter int WIDTH = 2000,             // bits of a line
    parameter int REGISTERS = 1,            // 1: lines are in registers, 0: in an SRAM
    parameter int CLOCK_WAITS = 1,          // 1: wait_o stops the array's clock
    parameter int SOURCE_WAITS = 1,         // 0: a line without room is lost, with its acquisition
    parameter int ARRAY_WAIT = 1,           // clocks for which a waiting array lets an offered acquisition wait, at most
    parameter int PARITY = 0,               // 1: each word of an SRAM has a parity bit
    localparam int LEVEL_WIDTH = $clog2(LINES + 2)
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    // side band of the SRAM macros; the technology folder defines its meaning
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    input  logic                   flush_i,      // without abort_i: only between acquisitions
    input  logic                   abort_i,      // the array's frame ends now
    input  logic                   expire_i,     // no effect while starved_o is low
    input  logic                   done_i,       // the array's frame ends regularly
    input  logic [           15:0] release_i,    // 1 to ACQUISITION_LINES; CLOCK_WAITS = 0: at most LINES
    output logic [LEVEL_WIDTH-1:0] level_o,      // lines in the buffer
    output logic                   starved_o,    // the array waits for an acquisition or for a line inside one
    output logic                   wait_o,       // stops the array's clock: a line is late inside an acquisition
    output logic                   queued_o,     // the buffer has an acquisition that the array has not begun
    output logic                   inside_o,     // the source is inside an acquisition after this clock
    output logic                   early_o,      // do not request the next acquisition yet: the source delivers an ignored rest; CLOCK_WAITS = 1:
                                                 // fewer than release_i lines of the present one have come or, if release_i is a whole acquisition,
                                                 // the array does not wait; CLOCK_WAITS = 0 and SOURCE_WAITS = 0, and the buffer cannot hold an
                                                 // acquisition: the source is inside one, or the array does not wait
    // each high for one clock
    output logic                   kept_o,       // a line was accepted and stored
    output logic                   arrives_o,    // the first line of an acquisition was accepted
    output logic                   rest_ends_o,  // the last line of an ignored rest was accepted
    output logic                   taken_o,      // the array takes the first line of an acquisition
    output logic                   taken_last_o, // the array takes the last line of an acquisition
    output logic                   underrun_o,   // the array needs a line that has not arrived; once per acquisition
    output logic                   short_o,      // s_tlast_i came before an acquisition's last line
    output logic                   long_o,       // s_tlast_i did not come with an acquisition's last line
    output logic                   dropped_o,    // an acquisition found no room
    output logic [  LEVEL_WIDTH:0] lost_lines_o, // number of the source's lines that are lost in this clock
    output logic                   parity_error_o,      // a line that was read two clocks ago is damaged
    output logic [            1:0] lost_acquisitions_o, // one for a dropped acquisition, one for an acquisition that the array has taken with missing lines
    // from the source, AXI4-Stream
    input  logic                   s_tvalid_i,
    output logic                   s_tready_o,   // low in reset
    input  logic [      WIDTH-1:0] s_tdata_i,
    input  logic                   s_tlast_i,    // the last line of an acquisition
    // to the array
    output logic                   line_valid_o,  // high for a whole acquisition, also during wait_o
    input  logic                   line_ready_i,
    output logic [      WIDTH-1:0] line_o
);

  localparam int ADDR_WIDTH = dtof_pkg::index_width(LINES);
  localparam int INDEX_WIDTH = dtof_pkg::index_width(ACQUISITION_LINES);
  localparam logic [ADDR_WIDTH-1:0] LAST_ADDRESS = ADDR_WIDTH'(LINES - 1);
  localparam logic [INDEX_WIDTH-1:0] LAST_LINE = INDEX_WIDTH'(ACQUISITION_LINES - 1);

  `DTOF_REQUIRE(g_illegal_acquisition, ACQUISITION_LINES >= 1, "dtof_line_buffer: ACQUISITION_LINES must be at least 1")
  `DTOF_REQUIRE(g_illegal_lines, LINES >= 2, "dtof_line_buffer: LINES must be at least 2")
  `DTOF_REQUIRE(g_illegal_room, SOURCE_WAITS != 0 || REGISTERS != 0 || LINES >= 3,
                "dtof_line_buffer: LINES of an SRAM must be at least 3 with SOURCE_WAITS = 0")

  localparam int CANNOT_HOLD = (SOURCE_WAITS == 0 && LINES < ACQUISITION_LINES) ? 1 : 0;  // an acquisition neither waits nor fits
  // With so many lines an acquisition is offered at the latest. A buffer for a whole acquisition has its last line before it is full.
  localparam int LATEST_RELEASE = (CANNOT_HOLD != 0) ? LINES - ARRAY_WAIT : LINES;

  // Source side. Each line is stored with a flag: its acquisition ends with it.

  logic [ADDR_WIDTH-1:0] write_address_q, read_address_q;
  logic [LEVEL_WIDTH-1:0] stored_q;    // in the memory
  logic [LEVEL_WIDTH-1:0] complete_q;  // acquisitions whose end is in the buffer
  logic [LEVEL_WIDTH-1:0] queued_q;    // acquisitions of which a line has arrived, and that the array has not begun
  logic [INDEX_WIDTH-1:0] source_line_q;
  logic live_q;    // not in reset
  logic behind_q;  // the rest of a past acquisition, up to s_tlast_i, is ignored
  logic rest_q;    // likewise, but not because of an abort or a timeout
  logic drain_q;   // the rest of the frame is "no detection" for the array
  logic accepted, write, ends, read, take, head_here, head_ends, empties, expires;
  logic begun, drops;  // begun: the array has begun the source's acquisition; always 1 with SOURCE_WAITS = 1
  logic room;          // room for a line; registers also have room if a line leaves in this clock
  logic [ADDR_WIDTH-1:0] first_address_q;  // of the source's acquisition
  logic [ADDR_WIDTH-1:0] following_read;
  logic [LEVEL_WIDTH-1:0] kept;  // lines that remain after this clock if the source's acquisition is dropped

  assign empties = flush_i || abort_i || expires;
  assign accepted = s_tvalid_i && s_tready_o;
  // An SRAM is never written at the address that is read. With SOURCE_WAITS = 0 it keeps one place free for an acquisition that has begun.
  assign room = (REGISTERS != 0) ? (stored_q != LEVEL_WIDTH'(LINES) || take)
      : (SOURCE_WAITS != 0) ? (stored_q != LEVEL_WIDTH'(LINES)) : (stored_q < LEVEL_WIDTH'(LINES - 1) || begun);
  assign write = accepted && !behind_q && !empties && !drops;

  generate
    if (SOURCE_WAITS != 0) begin : g_source_waits
      assign s_tready_o = live_q && (behind_q || room) && !flush_i && !abort_i && !expire_i;
      assign {begun, drops} = 2'b10;
    end else begin : g_source_goes_on
      assign s_tready_o = live_q;
      assign begun = (source_line_q != '0) && (queued_q == LEVEL_WIDTH'(taken_o && !drain_q));
      assign drops = accepted && !behind_q && !room && !empties;
    end
  endgenerate

  assign following_read = !read ? read_address_q : (read_address_q == LAST_ADDRESS) ? '0 : read_address_q + 1'b1;
  assign dropped_o = drops;
  assign kept = level_o - LEVEL_WIDTH'(source_line_q) - LEVEL_WIDTH'(take);
  assign ends = s_tlast_i || (source_line_q == LAST_LINE);
  assign short_o = write && s_tlast_i && (source_line_q != LAST_LINE);
  assign long_o = write && !s_tlast_i && (source_line_q == LAST_LINE);
  assign kept_o = write;
  assign arrives_o = accepted && !behind_q && (source_line_q == '0);
  assign rest_ends_o = accepted && behind_q && s_tlast_i;
  assign queued_o = (queued_q != '0);
  assign inside_o = accepted ? !s_tlast_i : behind_q || (source_line_q != '0);

  generate
    if (CLOCK_WAITS != 0) begin : g_early_by_release
      assign early_o = rest_q
          || ((source_line_q != '0) ? 16'(source_line_q) < release_i : 32'(release_i) == ACQUISITION_LINES && !starved_o);
    end else if (CANNOT_HOLD != 0) begin : g_early_unless_starved
      assign early_o = rest_q || (source_line_q != '0) || !starved_o;
    end else begin : g_early_in_a_rest
      assign early_o = rest_q;
    end
  endgenerate

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      live_q <= 1'b0;
      behind_q <= 1'b0;
      rest_q <= 1'b0;
      write_address_q <= '0;
      read_address_q <= '0;
      stored_q <= '0;
      complete_q <= '0;
      queued_q <= '0;
      source_line_q <= '0;
      first_address_q <= '0;
    end else begin
      live_q <= 1'b1;
      if (empties) begin
        behind_q <= !flush_i && (accepted ? !s_tlast_i : behind_q || source_line_q != '0);
        rest_q <= 1'b0;
        write_address_q <= '0;
        read_address_q <= '0;
        stored_q <= '0;
        complete_q <= '0;
        queued_q <= '0;
        source_line_q <= '0;
        first_address_q <= '0;
      end else begin
        if (accepted) begin
          behind_q <= !s_tlast_i && (behind_q || long_o || drops);
          rest_q <= !s_tlast_i && (rest_q || long_o || drops);
        end
        if (write && source_line_q == '0) begin
          first_address_q <= write_address_q;
        end
        if (write) begin
          write_address_q <= (write_address_q == LAST_ADDRESS) ? '0 : write_address_q + 1'b1;
          source_line_q <= ends ? '0 : source_line_q + 1'b1;
        end
        read_address_q <= following_read;
        stored_q <= stored_q + LEVEL_WIDTH'(write) - LEVEL_WIDTH'(read);
        if (drops) begin
          source_line_q <= '0;
          stored_q <= kept - LEVEL_WIDTH'(REGISTERS == 0 && kept != '0);
          if (source_line_q != '0) begin
            write_address_q <= first_address_q;
            read_address_q <= (kept == '0) ? first_address_q : following_read;
          end
        end
        complete_q <= complete_q + LEVEL_WIDTH'(write && ends) - LEVEL_WIDTH'(take && head_ends);
        queued_q <= queued_q + LEVEL_WIDTH'(arrives_o && write) - LEVEL_WIDTH'(taken_o && !drain_q)
            - LEVEL_WIDTH'(drops && source_line_q != '0);
      end
    end
  end

  // The line at the head stays until the array takes it or the buffer ignores it.

  logic [WIDTH-1:0] head;

  generate
    if (REGISTERS != 0) begin : g_registers
      logic [LINES*(WIDTH+1)-1:0] lines_q;

      assign head_here = (stored_q != '0);
      assign read = take;
      assign level_o = stored_q;
      assign parity_error_o = 1'b0;
      assign sram_cfg_o = '1;

      integer i;
      always_ff @(posedge clk_i) begin
        for (i = 0; i < LINES; i = i + 1) begin
          if (s_tvalid_i && room && write_address_q == ADDR_WIDTH'(i)) begin  // a line that is not accepted leaves the place free
            lines_q[i*(WIDTH+1)+:WIDTH+1] <= {ends, s_tdata_i};
          end
        end
      end

      integer j;
      always_comb begin
        {head_ends, head} = '0;
        for (j = 0; j < LINES; j = j + 1) begin
          {head_ends, head} = {head_ends, head} | (lines_q[j*(WIDTH+1)+:WIDTH+1] & {(WIDTH + 1) {read_address_q == ADDR_WIDTH'(j)}});
        end
      end

      logic unused_cfg;
      assign unused_cfg = ^sram_cfg_i;
    end else begin : g_sram
      logic head_q;  // the memory's output has a line

      assign head_here = head_q;
      assign read = (stored_q != '0) && (!head_q || take);
      assign level_o = stored_q + LEVEL_WIDTH'(head_q);

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          head_q <= 1'b0;
        end else begin
          head_q <= !empties && (drops ? (kept != '0) : read || (head_q && !take));
        end
      end

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
          .ignore_i    (1'b0),
          .error_o     (parity_error_o),
          .write_en_i  (write),
          .write_addr_i(write_address_q),
          .write_data_i({ends, s_tdata_i})
      );
    end
  endgenerate

  // Array side.

  logic inside_q, starved_q;
  logic fill_q;     // the rest of the acquisition is "no detection"
  logic discard_q;  // lines at the head are too late, up to the end of their acquisition
  logic [INDEX_WIDTH-1:0] line_q;  // number of the line in the acquisition
  logic begin_allowed, step, last_line, missing;
  logic [LEVEL_WIDTH-1:0] lost_stored, lost_here;  // lost lines that were stored; lost lines at the head or at the source

  assign begin_allowed = drain_q
      || (head_here && !discard_q
          && (CLOCK_WAITS != 0 || complete_q != '0 || 32'(level_o) >= LATEST_RELEASE || 16'(level_o) >= release_i));
  assign line_valid_o = inside_q || begin_allowed;
  assign wait_o = (CLOCK_WAITS != 0) && inside_q && !head_here && !fill_q && !drain_q;
  assign step = line_valid_o && line_ready_i && !wait_o;
  assign last_line = (line_q == LAST_LINE);
  assign taken_o = step && (line_q == '0);
  assign taken_last_o = step && last_line;
  assign missing = drain_q || fill_q || (inside_q && !head_here);
  assign underrun_o = step && inside_q && !head_here && !fill_q && !drain_q;
  assign line_o = missing ? '1 : head;
  assign take = head_here && ((step && !missing) || discard_q);
  // A line between the SRAM and its output has arrived.
  assign starved_o = ((starved_q || line_ready_i) && !line_valid_o) || (wait_o && stored_q == '0);
  assign expires = expire_i && starved_o;
  assign lost_stored = expires ? level_o : drops ? LEVEL_WIDTH'(source_line_q) : '0;
  assign lost_here = LEVEL_WIDTH'(take && discard_q && !expires) + LEVEL_WIDTH'(accepted && (behind_q || drops || expires));
  assign lost_lines_o = (LEVEL_WIDTH + 1)'(lost_stored) + (LEVEL_WIDTH + 1)'(lost_here);
  assign lost_acquisitions_o = 2'(drops) + 2'(step && last_line && missing);

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
  `DTOF_ASSERT(a_room, !write || read || stored_q != LEVEL_WIDTH'(LINES), "a line is written where there is no room")
  `DTOF_ASSERT(a_dropped_whole, !drops || !begun, "an acquisition is dropped that the array has begun")
  `DTOF_ASSERT(a_flush_between, !flush_i || abort_i || !inside_q, "the buffer is flushed inside an acquisition")

endmodule

`default_nettype wire
