// SPDX-License-Identifier: Apache-2.0
// Drives one array, or the RTL and the netlist of an array side by side, through the frames that dtof-vectors wrote, and
// checks every clock. The first failure is printed and ends the simulation; "DTOF_PASS ..." is printed at the end.
//
// Stimuli: pauses between acquisitions with X on the timestamps, back-pressure, start pulses while busy, X on the
// settings except in a start, a reset at a random clock of a frame that has run before.
// Checks: results against those of the model in the order of the stream, rules of AXI4-Stream, handshake, no X on a control
// output after the first reset, no X on a valid result, an error for each start while busy and no other error, the side band of
// the SRAMs (the bench sends the start pulse, and the stand-ins return it), and with COMPARE every output of the
// netlist in every clock in which that of the RTL is not X.
module stream_bench #(
    parameter int NP = 10,
    parameter int PIXELS_PER_SRAM = 3,
    parameter int SRAM_NUM = 2,
    parameter int SLOTS = 2,
    parameter int ACQ_WIDTH = 16,
    parameter int FRACTION_BITS = 0,     // fractional bits of a result
    parameter int CONFIDENCE_WIDTH = 4,  // bits of a result's confidence
    parameter int UNCHECKED_WIDTH = 0,  // bits above the code that are in no vector (second target, amplitude, ambient): RTL and netlist have the same
    parameter int TURNS = 1,  // number of turns in which the engines send their columns; 1 without engines
    parameter int COMPARE = 0,
    parameter int FRAMES = 1,            // lines of frames.txt
    parameter int BEATS = 1,             // lines of timestamps.hex
    parameter int SEED = 1,
    localparam int COLUMN_WIDTH = dtof_pkg::index_width(SRAM_NUM),
    localparam int ROW_WIDTH = dtof_pkg::index_width(PIXELS_PER_SRAM),
    localparam int RESULT_WIDTH = UNCHECKED_WIDTH + NP + FRACTION_BITS + CONFIDENCE_WIDTH,
    localparam int TDATA_WIDTH = COLUMN_WIDTH + ROW_WIDTH + RESULT_WIDTH,
    localparam int OUTPUT_WIDTH = 14 + TDATA_WIDTH
) (
    output logic                   clk_o,
    output logic                   rst_no,
    output logic                   start_o,
    output logic [  ACQ_WIDTH-1:0] acq_num_o,
    output logic [  ACQ_WIDTH-1:0] setting_0_o,
    output logic [  ACQ_WIDTH-1:0] setting_1_o,
    output logic [  ACQ_WIDTH-1:0] setting_2_o,
    output logic                   tdc_valid_o,
    output logic [SRAM_NUM*NP-1:0] tdc_timestamp_o,
    output logic                   result_tready_o,
    // {parity_error, counter_full, error, sram_cfg, busy, done, state, tdc_ready, tvalid, tlast, tdata}
    input  logic [OUTPUT_WIDTH-1:0] rtl_i,
    input  logic [OUTPUT_WIDTH-1:0] netlist_i
);

  localparam int BEATS_PER_ACQUISITION = PIXELS_PER_SRAM * SLOTS;
  localparam int RESULTS = PIXELS_PER_SRAM * SRAM_NUM;
  localparam int CLOCKS_WITHOUT_PROGRESS = 20000 + 2 * PIXELS_PER_SRAM * (1 << NP);  // a histogram of 2^NP bins is cleared, and scanned

  // Files that dtof-vectors wrote.

  logic [SRAM_NUM*NP-1:0] timestamps[0:BEATS-1];
  logic [47:0] expected[0:FRAMES*RESULTS-1];  // code, fraction, confidence, 16 bits each
  integer frame_acquisitions[FRAMES];
  integer frame_setting_0[FRAMES];
  integer frame_setting_1[FRAMES];
  integer frame_setting_2[FRAMES];
  integer frame_pause[FRAMES];
  integer frame_stall[FRAMES];
  integer frame_reset[FRAMES];

  // Outputs of the RTL and of the netlist.

  logic [dtof_pkg::ERROR_WIDTH-1:0] error, wanted_error;
  logic unused_parity_error, unused_counter_full, sram_cfg, busy, done, tdc_ready, tvalid, tlast;
  logic [2:0] state;
  logic [TDATA_WIDTH-1:0] tdata;
  logic netlist_tvalid, netlist_tlast;
  logic [TDATA_WIDTH-1:0] netlist_tdata;

  assign {unused_parity_error, unused_counter_full, error, sram_cfg, busy, done, state, tdc_ready, tvalid, tlast, tdata} = rtl_i;
  assign {netlist_tvalid, netlist_tlast, netlist_tdata} = netlist_i[TDATA_WIDTH+1:0];

  // Random numbers (xorshift), the same in every simulator.

  logic [31:0] random;

  function automatic logic [31:0] next_random(input logic [31:0] value);
    logic [31:0] mixed;
    begin
      mixed = value ^ (value << 13);
      mixed = mixed ^ (mixed >> 17);
      next_random = mixed ^ (mixed << 5);
    end
  endfunction

  task draw(input integer count, output integer number);
    begin
      random = next_random(random);
      number = {1'b0, random[31:1]} % count;
    end
  endtask

  // Progress of the frame.

  integer frame, beat, acquisition, first_beat, result, clocks, frame_clocks, idle_clocks;
  integer turn, row, column;
  integer total_results;
  logic checking, failed, stalled, held_tlast;
  logic [TDATA_WIDTH-1:0] held_tdata;
  integer drawn;

  task fail;
    begin
      if (!failed) begin
        failed = 1'b1;
        $display("DTOF_FAIL in frame %0d (%0d acquisitions), %0d clocks after its start, clock %0d of all", frame,
                 frame_acquisitions[frame], frame_clocks, clocks);
        $finish;
      end
    end
  endtask

  // Compares one output and names it in a failure.
  task compare(input [8*16-1:0] name, input integer low, input integer width);
    integer bit_number;
    logic differs;
    begin
      differs = 1'b0;
      for (bit_number = low; bit_number < low + width; bit_number = bit_number + 1) begin
        if (rtl_i[bit_number] !== 1'bx && rtl_i[bit_number] !== netlist_i[bit_number]) begin
          differs = 1'b1;
        end
      end
      if (differs && !failed) begin
        $display("netlist differs from RTL: output %0s, RTL %b, netlist %b", name,
                 (rtl_i >> low) & ~({OUTPUT_WIDTH{1'b1}} << width),
                 (netlist_i >> low) & ~({OUTPUT_WIDTH{1'b1}} << width));
        fail;
      end
    end
  endtask

  task check_unknown;
    begin
      if ((^rtl_i[OUTPUT_WIDTH-1:TDATA_WIDTH+1]) === 1'bx) begin
        $display("RTL: a control output is X: {parity_error, counter_full, error, sram_cfg, busy, done, state, tdc_ready, tvalid} = %b",
                 rtl_i[OUTPUT_WIDTH-1:TDATA_WIDTH+1]);
        fail;
      end
      if (tvalid && (^{tdata, tlast}) === 1'bx) begin
        $display("RTL: a valid result is X: tdata %b, tlast %b", tdata, tlast);
        fail;
      end
      if (COMPARE != 0) begin
        if ((^netlist_i[OUTPUT_WIDTH-1:TDATA_WIDTH+1]) === 1'bx) begin
          $display("netlist: a control output is X: {parity_error, counter_full, error, sram_cfg, busy, done, state, tdc_ready, tvalid} = %b",
                   netlist_i[OUTPUT_WIDTH-1:TDATA_WIDTH+1]);
          fail;
        end
        if (netlist_tvalid && (^{netlist_tdata, netlist_tlast}) === 1'bx) begin
          $display("netlist: a valid result is X: tdata %b, tlast %b", netlist_tdata, netlist_tlast);
          fail;
        end
      end
    end
  endtask

  task check_netlist;
    begin
      if (COMPARE != 0 && rtl_i !== netlist_i) begin
        compare("parity_error_o", TDATA_WIDTH + 13, 1);
        compare("counter_full_o", TDATA_WIDTH + 12, 1);
        compare("error_o", TDATA_WIDTH + 9, 3);
        compare("sram_cfg_o", TDATA_WIDTH + 8, 1);
        compare("busy_o", TDATA_WIDTH + 7, 1);
        compare("done_o", TDATA_WIDTH + 6, 1);
        compare("state_o", TDATA_WIDTH + 3, 3);
        compare("tdc_ready_o", TDATA_WIDTH + 2, 1);
        compare("result_tvalid_o", TDATA_WIDTH + 1, 1);
        compare("result_tlast_o", TDATA_WIDTH, 1);
        compare("result_tdata_o", 0, TDATA_WIDTH);
      end
    end
  endtask

  task check_side_outputs;
    begin
      if (error !== wanted_error || sram_cfg !== start_o) begin
        $display("error_o %b, sram_cfg_o %b; wanted: %b, %b", error, sram_cfg, wanted_error, start_o);
        fail;
      end
    end
  endtask

  task check_stream;
    begin
      if (stalled && (tvalid !== 1'b1 || tdata !== held_tdata || tlast !== held_tlast)) begin
        $display("result_tvalid_o, tdata or tlast changed before tready: %b %h %b, before 1 %h %b", tvalid, tdata,
                 tlast, held_tdata, held_tlast);
        fail;
      end
      stalled = tvalid && !result_tready_o;
      held_tdata = tdata;
      held_tlast = tlast;
    end
  endtask

  task check_result;
    logic [47:0] model;
    logic [TDATA_WIDTH-1:0] wanted, unchecked;
    begin
      if (result == RESULTS) begin
        $display("a result too many: %h", tdata);
        fail;
      end else begin
        model = expected[frame*RESULTS+row*SRAM_NUM+column];
        wanted = (TDATA_WIDTH'(column) << (ROW_WIDTH + RESULT_WIDTH)) | (TDATA_WIDTH'(row) << RESULT_WIDTH)
            | (TDATA_WIDTH'(model[47:32]) << (FRACTION_BITS + CONFIDENCE_WIDTH))
            | (TDATA_WIDTH'(model[31:16]) << CONFIDENCE_WIDTH) | TDATA_WIDTH'(model[15:0]);
        unchecked = ((TDATA_WIDTH'(1) << UNCHECKED_WIDTH) - TDATA_WIDTH'(1)) << (RESULT_WIDTH - UNCHECKED_WIDTH);
        wanted = wanted | (tdata & unchecked);
        if (tdata !== wanted || tlast !== (result == RESULTS - 1)) begin
          $display("result_tdata_o: %h, tlast %b; the model: %h, tlast %b (column %0d, row %0d)", tdata, tlast,
                   wanted, result == RESULTS - 1, column, row);
          fail;
        end
        result = result + 1;
        total_results = total_results + 1;
        column = column + TURNS;
        if (column >= SRAM_NUM) begin
          row = row + 1;
          if (row == PIXELS_PER_SRAM) begin
            row = 0;
            turn = turn + 1;
          end
          column = turn;
        end
      end
    end
  endtask

  // One clock: set the inputs, let the outputs settle, check them, then the edge.

  task settle;
    begin
      #1;
      if (checking) begin
        check_unknown;
        check_netlist;
        check_side_outputs;
        check_stream;
      end
    end
  endtask

  task step;
    begin
      wanted_error = '0;
      wanted_error[dtof_pkg::ERROR_START_IGNORED] = rst_no && start_o && busy;
      #1 clk_o = 1'b1;
      #2 clk_o = 1'b0;
      clocks = clocks + 1;
    end
  endtask

  task set_settings(input logic known);
    begin
      acq_num_o = known ? ACQ_WIDTH'(frame_acquisitions[frame]) : {ACQ_WIDTH{1'bx}};
      setting_0_o = known ? ACQ_WIDTH'(frame_setting_0[frame]) : {ACQ_WIDTH{1'bx}};
      setting_1_o = known ? ACQ_WIDTH'(frame_setting_1[frame]) : {ACQ_WIDTH{1'bx}};
      setting_2_o = known ? ACQ_WIDTH'(frame_setting_2[frame]) : {ACQ_WIDTH{1'bx}};
    end
  endtask

  task drive;
    begin
      // A start while busy, with the settings of another frame, changes nothing; neither does a start with done_o.
      draw(8, drawn);
      start_o = (frame_clocks == 0) || (drawn == 0) || done;
      set_settings(frame_clocks == 0);
      if (frame_clocks != 0 && start_o) begin
        draw(1 << 15, drawn);
        acq_num_o = ACQ_WIDTH'(drawn);
        setting_0_o = ACQ_WIDTH'(drawn >> 1);
        setting_1_o = ACQ_WIDTH'(drawn >> 2);
        setting_2_o = ACQ_WIDTH'(drawn >> 3);
      end
      draw(100, drawn);
      tdc_valid_o = (beat != 0) || (drawn >= frame_pause[frame]);
      tdc_timestamp_o = {SRAM_NUM * NP{1'bx}};
      if (tdc_valid_o && acquisition < frame_acquisitions[frame]) begin
        tdc_timestamp_o = timestamps[first_beat+acquisition*BEATS_PER_ACQUISITION+beat];
      end
      draw(100, drawn);
      result_tready_o = (drawn >= frame_stall[frame]);
    end
  endtask

  // Evaluates the clock with the present inputs and outputs.
  task follow;
    begin
      idle_clocks = idle_clocks + 1;
      if (tdc_valid_o && tdc_ready) begin
        idle_clocks = 0;
        if (acquisition == frame_acquisitions[frame]) begin
          $display("an acquisition too many was taken");
          fail;
        end
        beat = beat + 1;
        if (beat == BEATS_PER_ACQUISITION) begin
          beat = 0;
          acquisition = acquisition + 1;
        end
      end else if (beat != 0) begin
        $display("tdc_ready_o fell inside an acquisition");
        fail;
      end
      if (tvalid && result_tready_o) begin
        idle_clocks = 0;
        check_result;
      end
      if (frame_clocks != 0 && busy !== 1'b1) begin
        $display("busy_o fell before done_o");
        fail;
      end
      if (idle_clocks == CLOCKS_WITHOUT_PROGRESS) begin
        $display("nothing taken or sent for %0d clocks, state %0d", idle_clocks, state);
        fail;
      end
    end
  endtask

  // Runs a frame, or with reset_at other than 0 as many clocks of it and then a reset. `length`: clocks of the frame.
  task run_frame(input integer reset_at, output integer length);
    logic ended;
    begin
      beat = 0;
      acquisition = 0;
      result = 0;
      turn = 0;
      row = 0;
      column = 0;
      frame_clocks = 0;
      idle_clocks = 0;
      ended = 1'b0;
      while (!ended && !failed) begin
        drive;
        settle;
        if (!failed) follow;
        ended = done || (frame_clocks == reset_at && reset_at != 0);
        if (done && (acquisition != frame_acquisitions[frame] || result != RESULTS)) begin
          $display("done_o after %0d acquisitions and %0d of %0d results", acquisition, result, RESULTS);
          fail;
        end
        if (!failed && ended && !done) begin
          reset_array;
        end else if (!failed) begin
          step;
          frame_clocks = frame_clocks + 1;
        end
      end
      length = frame_clocks;
      rest;
    end
  endtask

  task reset_array;
    begin
      rst_no = 1'b0;
      start_o = 1'b0;
      tdc_valid_o = 1'b0;
      tdc_timestamp_o = {SRAM_NUM * NP{1'bx}};
      wanted_error = '0;
      stalled = 1'b0;
      checking = 1'b1;
      draw(3, drawn);
      repeat (drawn + 1) begin
        settle;
        if (busy || tvalid) begin
          $display("busy_o %b or result_tvalid_o %b in reset", busy, tvalid);
          fail;
        end
        step;
      end
      rst_no = 1'b1;
    end
  endtask

  // Between frames: nothing is accepted, nothing is sent.
  task rest;
    begin
      start_o = 1'b0;
      set_settings(1'b0);
      draw(4, drawn);
      repeat (drawn + 1) begin
        if (!failed) begin
          draw(2, drawn);
          tdc_valid_o = (drawn != 0);
          tdc_timestamp_o = {SRAM_NUM * NP{1'bx}};
          settle;
          if (busy || done || tdc_ready || tvalid) begin
            $display("busy_o %b, done_o %b, tdc_ready_o %b or result_tvalid_o %b between frames", busy, done,
                     tdc_ready, tvalid);
            fail;
          end
          step;
        end
      end
    end
  endtask

  task read_frames;
    integer file, found, i;
    begin
      $readmemh("timestamps.hex", timestamps);
      $readmemh("results.hex", expected);
      file = $fopen("frames.txt", "r");
      for (i = 0; i < FRAMES; i = i + 1) begin
        found = $fscanf(file, "%d %d %d %d %d %d %d", frame_acquisitions[i], frame_setting_0[i],
                        frame_setting_1[i], frame_setting_2[i], frame_pause[i], frame_stall[i], frame_reset[i]);
        if (found != 7) begin
          $display("frames.txt: line %0d cannot be read", i + 1);
          frame = 0;
          fail;
        end
      end
      $fclose(file);
    end
  endtask

  integer length, reset_at;

  initial begin
    failed = 1'b0;
    checking = 1'b0;
    stalled = 1'b0;
    clocks = 0;
    frame = 0;
    frame_clocks = 0;
    total_results = 0;
    first_beat = 0;
    random = 32'd2463534242 ^ SEED;
    read_frames;
    clk_o = 1'b0;
    rst_no = 1'bx;
    start_o = 1'b0;
    tdc_valid_o = 1'b0;
    tdc_timestamp_o = {SRAM_NUM * NP{1'bx}};
    result_tready_o = 1'b0;
    set_settings(1'b0);
    repeat (2) step;
    reset_array;
    for (frame = 0; frame < FRAMES && !failed; frame = frame + 1) begin
      run_frame(0, length);
      if (frame_reset[frame] != 0 && !failed) begin
        draw(length - 1, reset_at);
        run_frame(reset_at + 1, length);
      end
      first_beat = first_beat + frame_acquisitions[frame] * BEATS_PER_ACQUISITION;
    end
    if (!failed) begin
      $display("DTOF_PASS frames %0d results %0d clocks %0d", FRAMES, total_results, clocks);
      $finish;
    end
  end

  // +trace=<file> writes a waveform of the whole simulation.
  logic [8*512-1:0] trace;

  initial begin
    if ($value$plusargs("trace=%s", trace)) begin
      $dumpfile(trace);
      $dumpvars;
    end
  end

endmodule
