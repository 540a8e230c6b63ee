// SPDX-License-Identifier: Apache-2.0
// Bench of dtof_async_line_fifo for scripts/tests/test_async_line_fifo.py: two clocks, a source and a sink that pause, resets of either side.
// A list has the lines that must leave. The last line of the output is PASS with what was seen, or FAIL with a sentence.
//
// +seed=, +half_tdc=, +half_read= (half periods, even), +window= (dtof_synchroniser below), +lines= (to send), +gap=, +stall= (sixteenths of
// the clocks in which source and sink pause), +resets= (one side's reset about every so many units of time, 0: none)
`default_nettype none

module bench;
  parameter int WIDTH = 16;
  parameter int DEPTH = 4;
  localparam int RESET_CLOCKS = 4;
  localparam int PATIENCE = 40;  // clocks of the slower side

  integer seed, half_tdc, half_read, window, lines, gap, stall, resets;
  logic clk_tdc = 1'b0, clk = 1'b0, rst_tdc_n = 1'b0, rst_n = 1'b0;
  logic s_tvalid = 1'b0, s_tlast = 1'b0, m_tready = 1'b0;
  logic [WIDTH-1:0] s_tdata = '0;
  wire s_tready, m_tvalid, m_tlast;
  wire [WIDTH-1:0] m_tdata;

  dtof_async_line_fifo #(
      .WIDTH(WIDTH),
      .DEPTH(DEPTH)
  ) u_fifo (
      .clk_tdc_i (clk_tdc),
      .rst_tdc_ni(rst_tdc_n),
      .s_tvalid_i(s_tvalid),
      .s_tready_o(s_tready),
      .s_tdata_i (s_tdata),
      .s_tlast_i (s_tlast),
      .clk_i     (clk),
      .rst_ni    (rst_n),
      .m_tvalid_o(m_tvalid),
      .m_tready_i(m_tready),
      .m_tdata_o (m_tdata),
      .m_tlast_o (m_tlast)
  );

  function automatic integer drawn(input integer below);
    drawn = $unsigned($random(seed)) % below;
  endfunction

  integer sent = 0, taken = 0, full = 0, empty = 0, ends = 0, skipped = 0, lost = 0, tdc_resets = 0, read_resets = 0;
  integer slow_clocks = 0, closed = 0;
  logic over = 1'b0;

  task automatic fail(input [80*8-1:0] sentence);
    if (!over) begin
      $display("FAIL %0s at %0d", sentence, $time);
      over = 1'b1;
      $finish(0);
    end
  endtask

  // What must leave, in order. A line counts when its next clock has come without a reset.
  logic [WIDTH:0] expected[1 << 17];
  integer head = 0, tail = 0;
  logic [WIDTH:0] pending, held;
  logic is_pending = 1'b0, source_inside = 1'b0, kept_inside = 1'b0, skip = 1'b0, is_held = 1'b0;

  // The source keeps a line until it is taken. Acquisitions have one to four lines.
  always @(posedge clk_tdc) begin
    if (is_pending) begin
      expected[tail] = pending;
      tail = tail + 1;
      kept_inside = !pending[WIDTH];
      is_pending = 1'b0;
    end
    if (rst_tdc_n && s_tvalid && s_tready) begin
      sent = sent + 1;
      if (!rst_n) lost = lost + 1;
      else if (skip) skipped = skipped + 1;
      is_pending = rst_n && !skip;
      pending = {s_tlast, s_tdata};
      source_inside = !s_tlast;
      if (s_tlast) skip = 1'b0;
    end
    if (rst_tdc_n && s_tvalid && !s_tready && tail - head >= DEPTH) full = full + 1;
    if (tail - head + is_pending > DEPTH + 1) fail("more than DEPTH lines are inside");
    if (rst_tdc_n) begin
      if (!s_tvalid || s_tready) begin
        s_tvalid <= sent < lines && drawn(16) >= gap;
        s_tdata <= sent[WIDTH-1:0] & {1'b0, {(WIDTH - 1) {1'b1}}};
        s_tlast <= drawn(4) == 0;
      end
    end
  end

  always @(posedge clk) begin
    if (rst_n) begin
      if (m_tvalid !== 1'b0 && m_tvalid !== 1'b1) fail("m_tvalid_o is unknown");
      if (is_held && (!m_tvalid || {m_tlast, m_tdata} !== held)) fail("an offered line did not stay");
      if (m_tvalid && m_tready) begin
        if (head == tail) fail("a line leaves that nobody sent");
        if ({m_tlast, m_tdata} !== expected[head]) fail("another line leaves");
        if (&expected[head]) ends = ends + 1;
        head = head + 1;
        taken = taken + 1;
      end
      if (!m_tvalid && m_tready) empty = empty + 1;
      is_held = m_tvalid && !m_tready;
      held = {m_tlast, m_tdata};
      m_tready <= drawn(16) >= stall;
    end
  end

  // Resets fall and rise between clock edges, which have even times.
  always @(negedge rst_tdc_n) begin
    is_pending = 1'b0;
    source_inside = 1'b0;
    skip = 1'b0;
    if (kept_inside && rst_n) begin
      expected[tail] = {(WIDTH + 1) {1'b1}};
      tail = tail + 1;
      kept_inside = 1'b0;
    end
    s_tvalid <= 1'b0;
    #1 if (s_tready !== 1'b0) fail("s_tready_o is high in reset");
  end
  always @(negedge rst_n) begin
    lost = lost + tail - head + is_pending;
    head = tail;
    is_pending = 1'b0;
    is_held = 1'b0;
    kept_inside = 1'b0;
    m_tready <= 1'b0;
    #1 if (m_tvalid !== 1'b0) fail("m_tvalid_o is high in reset");
  end
  always @(posedge rst_n) skip = source_inside;

  task automatic wait_in_reset;
    #(2 * RESET_CLOCKS * ((half_tdc > half_read) ? half_tdc : half_read) + 2 + 2 * drawn(50));
  endtask

  task automatic wait_slow(input integer clocks);
    repeat (clocks) begin
      if (half_tdc > half_read) @(posedge clk_tdc);
      else @(posedge clk);
    end
  endtask

  // Nothing may wait for ever: with both sides out of reset, lines leave or the source is asked for them.
  always begin
    wait_slow(1);
    slow_clocks = slow_clocks + 1;
    closed = (s_tready || m_tvalid) ? 0 : closed + (rst_n && rst_tdc_n);
    if (closed > 4 * PATIENCE) fail("nothing moves");
  end

  integer first, from_clock;
  initial begin
    if (!$value$plusargs("seed=%d", seed)) seed = 1;
    if (!$value$plusargs("half_tdc=%d", half_tdc)) half_tdc = 10;
    if (!$value$plusargs("half_read=%d", half_read)) half_read = 10;
    if (!$value$plusargs("window=%d", window)) window = 0;
    if (!$value$plusargs("lines=%d", lines)) lines = 1000;
    if (!$value$plusargs("gap=%d", gap)) gap = 4;
    if (!$value$plusargs("stall=%d", stall)) stall = 4;
    if (!$value$plusargs("resets=%d", resets)) resets = 0;
    first = drawn(2);  // which side leaves reset first
    fork
      begin
        #(2 * drawn(half_tdc)) forever #half_tdc clk_tdc = !clk_tdc;
      end
      begin
        #(2 * drawn(half_read)) forever #half_read clk = !clk;
      end
      begin
        #(1 + first * 500) wait_in_reset;
        rst_tdc_n = 1'b1;
      end
      begin
        #(1 + (1 - first) * 500) wait_in_reset;
        rst_n = 1'b1;
      end
      begin
        wait (rst_tdc_n && rst_n && s_tready);
        #1 from_clock = slow_clocks;
        if (resets != 0) begin
          while (sent < lines) begin
            #(2 * drawn(resets) + 2);
            case (drawn(5))
              0, 1: begin
                tdc_resets = tdc_resets + 1;
                rst_tdc_n = 1'b0;
                wait_in_reset;
                rst_tdc_n = 1'b1;
              end
              2, 3: begin
                read_resets = read_resets + 1;
                rst_n = 1'b0;
                wait_in_reset;
                rst_n = 1'b1;
              end
              default: begin
                rst_tdc_n = 1'b0;
                if (drawn(2) == 0) #(2 * drawn(half_tdc));
                rst_n = 1'b0;
                wait_in_reset;
                rst_tdc_n = 1'b1;
                #(2 * drawn(half_tdc + half_read)) rst_n = 1'b1;
              end
            endcase
          end
        end
        wait (sent >= lines);
        stall = 0;
        wait_slow(PATIENCE);
        if (head != tail) fail("a line is lost");
        if (!over) begin
          over = 1'b1;
          $display("PASS sent=%0d taken=%0d full=%0d empty=%0d ends=%0d skipped=%0d lost=%0d tdc_resets=%0d read_resets=%0d clocks=%0d",
                   sent, taken, full, empty, ends, skipped, lost, tdc_resets, read_resets, slow_clocks - from_clock);
        end
        $finish(0);
      end
    join
  end
endmodule

`default_nettype wire
