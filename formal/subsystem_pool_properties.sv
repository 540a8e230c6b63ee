// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_subsystem with poolPointer, in any number of continuous frames after reset and the writes of its registers: the words at the
// sink are those of a second array, for any timestamps, any gaps of the source, any s_tlast_i and any waits of the sink. Around the second array
// are only a queue of two lines, a watchdog, a clock gate that is shut while a line is late inside an acquisition, and a queue of two words. Both
// arrays are in step.
//
// With FIXED = 1 all inputs are fixed: pseudo-random timestamps, source and sink wait in about a quarter of the clocks, and s_tlast_i is where it
// belongs.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module subsystem_pool_properties #(
    parameter int FIXED = 0,
    localparam int COLUMNS = 2,
    localparam int ROWS = 2,
    localparam int NP = 8,
    localparam int SLOTS = 2,
    localparam int ACQUISITIONS = 3,  // one in each phase
    localparam int COARSE_END = 1,
    localparam int TRACK_END = 2,
    localparam int WATCHDOG = 20,  // clocks
    localparam int ACQ_WIDTH = 4,
    localparam int COUNT_WIDTH = 4,
    localparam int ADVANTAGE_WIDTH = 4,
    localparam int ACQUISITION_LINES = ROWS * SLOTS,
    localparam int WIDTH = COLUMNS * NP,
    localparam int TDATA_WIDTH = 8 * ((WIDTH + 7) / 8)
) (
    input logic             clk_i,
    input logic             s_tvalid_i,
    input logic [WIDTH-1:0] s_tdata_i,
    input logic             s_tlast_i,
    input logic             m_tready_i
);

  logic checking = 1'b0;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  // Writes of the registers after reset, two clocks each, which the first one's wait states precede. The last one starts continuous frames.
  localparam int WRITES = 6;
  logic [2:0] number_q;  // of the write
  logic psel, penable_q, pready;
  logic [11:0] paddr;
  logic [31:0] pwdata;

  always_ff @(posedge clk_i or negedge checking) begin
    if (!checking) begin
      number_q <= '0;
      penable_q <= 1'b0;
    end else begin
      penable_q <= psel && (!penable_q || !pready);
      if (penable_q && pready) number_q <= number_q + 1'b1;
    end
  end

  assign psel = (32'(number_q) < WRITES);

  always_comb begin
    paddr = dtof_registers_pkg::CONTROL;
    pwdata = (32'd1 << dtof_registers_pkg::CONTROL_START_LSB) | (32'd1 << dtof_registers_pkg::CONTROL_CONTINUOUS_LSB);
    if (32'(number_q) < WRITES - 1) begin
      case (number_q)
        3'd0: begin
          paddr = dtof_registers_pkg::ACQUISITIONS;
          pwdata = 32'(ACQUISITIONS);
        end
        3'd1: begin
          paddr = dtof_registers_pkg::COARSE_END;
          pwdata = 32'(COARSE_END);
        end
        3'd2: begin
          paddr = dtof_registers_pkg::TRACK_END;
          pwdata = 32'(TRACK_END);
        end
        3'd3: begin
          paddr = dtof_registers_pkg::WATCHDOG;
          pwdata = 32'(WATCHDOG);
        end
        default: begin
          paddr = dtof_registers_pkg::OUTPUT;
          pwdata = (32'd1 << dtof_registers_pkg::OUTPUT_PRIOR_LSB) | (32'd1 << dtof_registers_pkg::OUTPUT_SMOOTH_LSB);
        end
      endcase
    end
  end

  // Source and sink.
  logic s_tvalid, s_tready, s_tlast, m_tvalid, m_tready, m_tuser, m_tlast;
  logic [WIDTH-1:0] line;
  logic [63:0] m_tdata;
  logic [15:0] random_q;  // a pseudo-random sequence

  assign s_tvalid = (FIXED == 0) ? s_tvalid_i : random_q[1:0] != 2'd0;
  assign m_tready = (FIXED == 0) ? m_tready_i : random_q[9:8] != 2'd0;

  always_ff @(posedge clk_i) begin
    random_q <= !checking ? 16'd1 : {random_q[14:0], random_q[15] ^ random_q[13] ^ random_q[12] ^ random_q[10]};
  end

  assign line = (FIXED == 0) ? s_tdata_i : WIDTH'({random_q[5:0], random_q[15:6], random_q});

  logic [7:0] place_q;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      place_q <= '0;
    end else if (s_tvalid && s_tready) begin
      place_q <= (32'(place_q) == ACQUISITION_LINES - 1) ? '0 : place_q + 1'b1;
    end
  end

  assign s_tlast = (FIXED == 0) ? s_tlast_i : 32'(place_q) == ACQUISITION_LINES - 1;

  logic pslverr, irq, shot;
  logic [31:0] prdata;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] cfg, reference_cfg;

  dtof_subsystem #(
      .READOUT         (dtof_pkg::READOUT_POOLPOINTER),
      .NP              (NP),
      .PIXELS_PER_SRAM (ROWS),
      .SRAM_NUM        (COLUMNS),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .LABELS          (2),
      .SCORE_BITS      (1),
      .OFFSET_BITS     (0),
      .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH),
      .POINTER_SHIFT   (0),
      .PRIOR           (1),
      .ENGINE_COLUMNS  (2),
      .BROADCAST_STAGES(1),
      .CLOCK_WAITS     (1),
      .BUFFER_LINES    (2)
  ) u_dut (
      .clk_i          (clk_i),
      .rst_ni         (checking),
      .scan_mode_i    (1'b0),
      .sram_cfg_i     ('0),
      .sram_cfg_o     (cfg),
      .psel_i         (psel),
      .penable_i      (penable_q),
      .pwrite_i       (1'b1),
      .paddr_i        (paddr),
      .pwdata_i       (pwdata),
      .pstrb_i        (4'hf),
      .pready_o       (pready),
      .prdata_o       (prdata),
      .pslverr_o      (pslverr),
      .irq_o          (irq),
      .shot_o         (shot),
      .s_axis_tvalid_i(s_tvalid),
      .s_axis_tready_o(s_tready),
      .s_axis_tdata_i (TDATA_WIDTH'(line)),
      .s_axis_tlast_i (s_tlast),
      .m_axis_tvalid_o(m_tvalid),
      .m_axis_tready_i(m_tready),
      .m_axis_tdata_o (m_tdata),
      .m_axis_tuser_o (m_tuser),
      .m_axis_tlast_o (m_tlast)
  );

  // The second array: its settings, its frames, its clock, and eight clocks of reset and three of rest.
  localparam int COLUMN_WIDTH = dtof_pkg::index_width(COLUMNS);
  localparam int ROW_WIDTH = dtof_pkg::index_width(ROWS);
  localparam int CONFIDENCE_WIDTH = dtof_pkg::pool_confidence_width(ADVANTAGE_WIDTH);
  localparam int RESULT_WIDTH = COLUMN_WIDTH + ROW_WIDTH + 16 + CONFIDENCE_WIDTH;
  logic [3:0] reset_q;
  logic [3*ACQ_WIDTH+1:0] written_q, settings_q;  // {smooth, prior, coarse_end, track_end, acquisitions}; START commits what was written
  logic [ACQ_WIDTH-1:0] acquisitions, coarse_end, track_end;
  logic [23:0] limit_q;  // of the watchdog
  logic smooth, prior, continuous_q, starts_q, again_q, running_q, in_reset_q, offered_q, committed_q, write;
  logic begins, legal, start, busy, done, late, clock, valid, ready, tvalid, tready, tlast;
  logic [WIDTH-1:0] head;
  logic [RESULT_WIDTH-1:0] tdata;

  assign write = psel && penable_q && pready && offered_q;
  assign begins = (starts_q && !running_q && reset_q == '0) || again_q;
  assign {smooth, prior, coarse_end, track_end, acquisitions} = settings_q;
  assign legal = coarse_end <= track_end && track_end <= acquisitions && committed_q;
  assign start = begins && legal;

  always_ff @(posedge clk_i) begin
    if (psel && (!penable_q || !pready)) offered_q <= 1'b1;
    if (write && paddr == dtof_registers_pkg::CONTROL) {committed_q, settings_q} <= {1'b1, written_q};
  end

  always_ff @(posedge clk_i or negedge checking) begin
    if (!checking) begin
      reset_q <= 4'd11;
      in_reset_q <= 1'b1;
      {starts_q, again_q, running_q, continuous_q} <= '0;
      limit_q <= 24'(dtof_registers_pkg::WATCHDOG_RESET);
      written_q <= {2'b10, {3 * ACQ_WIDTH{1'b0}}};
    end else begin
      if (reset_q != '0) reset_q <= reset_q - 1'b1;
      in_reset_q <= (reset_q > 4'd4);
      starts_q <= write && paddr == dtof_registers_pkg::CONTROL;
      again_q <= running_q && done && !late && continuous_q;
      running_q <= start || (running_q && !(done && !late));
      if (begins && !legal) continuous_q <= 1'b0;
      if (write) begin
        case (paddr)
          dtof_registers_pkg::ACQUISITIONS: written_q[0+:ACQ_WIDTH] <= pwdata[ACQ_WIDTH-1:0];
          dtof_registers_pkg::TRACK_END: written_q[ACQ_WIDTH+:ACQ_WIDTH] <= pwdata[ACQ_WIDTH-1:0];
          dtof_registers_pkg::COARSE_END: written_q[2*ACQ_WIDTH+:ACQ_WIDTH] <= pwdata[ACQ_WIDTH-1:0];
          dtof_registers_pkg::WATCHDOG: limit_q <= pwdata[23:0];
          dtof_registers_pkg::OUTPUT:
          written_q[3*ACQ_WIDTH+:2] <= {pwdata[dtof_registers_pkg::OUTPUT_SMOOTH_LSB], pwdata[dtof_registers_pkg::OUTPUT_PRIOR_LSB]};
          default: continuous_q <= pwdata[dtof_registers_pkg::CONTROL_CONTINUOUS_LSB];
        endcase
      end
    end
  end

  dtof_clock_gate u_clock (
      .clk_i      (clk_i),
      .enable_i   (((start || busy) && !late) || in_reset_q),
      .scan_mode_i(1'b0),
      .clk_o      (clock)
  );

  dtof_pool_pointer_array #(
      .NP              (NP),
      .PIXELS_PER_SRAM (ROWS),
      .SRAM_NUM        (COLUMNS),
      .SLOTS           (SLOTS),
      .COUNT_WIDTH     (COUNT_WIDTH),
      .ACQ_WIDTH       (ACQ_WIDTH),
      .LABELS          (2),
      .SCORE_BITS      (1),
      .OFFSET_BITS     (0),
      .ADVANTAGE_WIDTH (ADVANTAGE_WIDTH),
      .POINTER_SHIFT   (0),
      .PRIOR           (1),
      .ENGINE_COLUMNS  (2),
      .BROADCAST_STAGES(1)
  ) u_reference (
      .clk_i          (clock),
      .rst_ni         (checking && !in_reset_q),
      .sram_cfg_i     ('0),
      .sram_cfg_o     (reference_cfg),
      .start_i        (start),
      .acq_num_i      (acquisitions),
      .gate_begin_i   ('0),
      .gate_end_i     ('0),
      .coarse_end_i   (coarse_end),
      .track_end_i    (track_end),
      .smooth_i       (smooth),
      .template_i     ('0),
      .prior_i        (prior),
      .busy_o         (busy),
      .done_o         (done),
      .tdc_valid_i    (valid && !late),
      .tdc_ready_o    (ready),
      .tdc_timestamp_i(head),
      .result_tvalid_o(tvalid),
      .result_tready_i(tready),
      .result_tdata_o (tdata),
      .result_tlast_o (tlast)
  );

  // The queue of lines, each with a flag: it is the last one of its acquisition. The array takes an acquisition's lines in successive clocks
  // of its own. Lines that an acquisition lacks are "no detection"; lines behind its last one are ignored. When the watchdog expires, the
  // queue is emptied, and all lines up to the frame's end are "no detection".
  logic [1:0] stored_q;
  logic live_q, begun_q, write_q, read_q, inside_q, fill_q, behind_q, drain_q, starved_q;
  logic step, take, room, accepted, stores, last_stored, head_last, last_step, missing, wanted, starved, expired, expires;
  logic [7:0] line_q, source_line_q;
  logic [WIDTH:0] lines_q[2];

  dtof_watchdog #(
      .WIDTH(24)
  ) u_watchdog (
      .clk_i    (clk_i),
      .rst_ni   (checking),
      .limit_i  (limit_q),
      .waits_i  (starved && (running_q || again_q) && !stores),
      .expired_o(expired)
  );

  assign wanted = ready && reset_q == '0;
  assign late = inside_q && stored_q == '0 && !fill_q && !drain_q;
  assign valid = inside_q || drain_q || stored_q != '0;
  assign step = valid && wanted && !late;
  assign missing = drain_q || fill_q || (inside_q && stored_q == '0);
  assign take = step && stored_q != '0 && !missing;
  assign last_step = (32'(line_q) == ACQUISITION_LINES - 1);
  assign starved = ((starved_q || wanted) && !valid) || late;
  assign expires = expired && (running_q || again_q) && starved;
  assign room = (stored_q != 2'd2 || take);
  assign accepted = s_tvalid && live_q && (behind_q || room) && !(expired && (running_q || again_q));
  assign stores = accepted && !behind_q;
  assign last_stored = s_tlast || 32'(source_line_q) == ACQUISITION_LINES - 1;
  assign head_last = lines_q[read_q][WIDTH];
  assign head = (!begun_q || missing) ? '1 : lines_q[read_q][WIDTH-1:0];

  always_ff @(posedge clk_i or negedge checking) begin
    if (!checking) begin
      {live_q, stored_q, write_q, read_q, inside_q, fill_q, behind_q, drain_q, starved_q, line_q, source_line_q} <= '0;
    end else begin
      live_q <= 1'b1;
      starved_q <= starved;
      drain_q <= expires || (drain_q && !(done && !late));
      if (expires) begin
        {stored_q, write_q, read_q, source_line_q} <= '0;
        behind_q <= behind_q || source_line_q != '0;
      end else begin
        stored_q <= stored_q + 2'(stores) - 2'(take);
        write_q <= write_q ^ stores;
        read_q <= read_q ^ take;
        if (accepted) behind_q <= !s_tlast && (behind_q || last_stored);
        if (stores) source_line_q <= last_stored ? '0 : source_line_q + 1'b1;
      end
      if (step) begin
        inside_q <= !last_step;
        line_q <= last_step ? '0 : line_q + 1'b1;
        fill_q <= (missing || head_last) && !last_step;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    begun_q <= begun_q || start;
    if (s_tvalid && room) lines_q[write_q] <= {last_stored, line};
  end

  // The queue of words: {first of the frame, last, word}.
  logic port_q, waiting_q, first_q, enters;
  logic [65:0] word, port_word_q, waiting_word_q;
  logic [15:0] confidence;

  assign tready = !waiting_q;
  assign enters = tvalid && !late && tready && reset_q == '0;
  assign confidence = 16'(tdata[CONFIDENCE_WIDTH-1:0]);
  assign word = {first_q, tlast, 4'b0000, !begun_q, confidence == '0, 1'b0, begun_q && confidence != '0, 12'(tdata[RESULT_WIDTH-1-:COLUMN_WIDTH]),
                 12'(tdata[CONFIDENCE_WIDTH+16+:ROW_WIDTH]), confidence, tdata[CONFIDENCE_WIDTH+:16]};

  always_ff @(posedge clk_i or negedge checking) begin
    if (!checking) begin
      {port_q, waiting_q} <= '0;
      first_q <= 1'b1;
    end else begin
      if (enters) first_q <= tlast;
      if (!port_q || m_tready) begin
        port_q <= waiting_q || enters;
        waiting_q <= 1'b0;
      end else begin
        waiting_q <= waiting_q || enters;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (enters) waiting_word_q <= word;
    if (!port_q || m_tready) port_word_q <= waiting_q ? waiting_word_q : word;
  end

  `PROVE(a_accepted, (s_tvalid && s_tready) == accepted)
  `PROVE(a_valid, m_tvalid == port_q)
  `PROVE(a_word, !m_tvalid || {m_tuser, m_tlast, m_tdata} == port_word_q)

  // Frames that the sink has taken whole.
  logic [1:0] frames_q;

  always_ff @(posedge clk_i) begin
    if (!checking) begin
      frames_q <= '0;
    end else if (m_tvalid && m_tready && m_tlast && frames_q != 2'd2) begin
      frames_q <= frames_q + 1'b1;
    end
  end

  `GOAL(frames_q == 2'd2)

  logic unused;
  assign unused = ^{s_tlast_i, s_tvalid_i, m_tready_i, random_q, place_q, pslverr, prdata, irq, shot, cfg, reference_cfg};

endmodule

`default_nettype wire
