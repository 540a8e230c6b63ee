// SPDX-License-Identifier: Apache-2.0
// The settings of a frame. Each exists twice: what software wrote last, which it reads, and what the last commit made valid. A commit makes all
// settings valid together.
//
// Latency: a committed setting is at its output in the clock after commit_i.
// Cost: two flip-flops per bit of a setting, SRAM_NUM such bits for the columns, and a multiplexer for reads.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_setting_registers #(
    parameter int HAS_SCHEDULE = 0,
    parameter int TIME_GATE = 0,
    parameter int SECOND_TARGET = 0,
    parameter int AMPLITUDE = 0,
    parameter int PRIOR = 0,
    parameter int RAW_HISTOGRAM = 0,
    parameter int NP = 10,
    parameter int SRAM_NUM = 200,
    parameter int ACQ_WIDTH = 16,
    parameter int WEAK_WIDTH = 5,
    parameter int MOST_RELEASE = 320
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    // write of a register
    input  logic [         11:0] offset_i,
    input  logic                 write_i,
    input  logic [         31:0] mask_i,         // bits that are written
    input  logic [         31:0] written_i,      // bits that are written as 1
    input  logic                 commit_i,
    output logic [         31:0] data_o,         // value of the register at offset_i; 0 at an offset of another one
    // committed settings
    output logic                 second_o,       // 0 without SECOND_TARGET
    output logic                 amplitude_o,    // 0 without AMPLITUDE
    output logic                 raw_o,          // raw_o, raw_first_o and raw_last_o are 0 without RAW_HISTOGRAM
    output logic [         11:0] raw_first_o,
    output logic [         11:0] raw_last_o,
    output logic [ACQ_WIDTH-1:0] acquisitions_o,
    output logic [ACQ_WIDTH-1:0] coarse_end_o,   // coarse_end_o, track_end_o and smooth_o are 0 without HAS_SCHEDULE
    output logic [ACQ_WIDTH-1:0] track_end_o,
    output logic                 smooth_o,
    output logic                 prior_o,        // 0 without PRIOR
    output logic                 short_words_o,
    output logic [       NP-1:0] gate_begin_o,   // gate_begin_o and gate_end_o are 0 without TIME_GATE
    output logic [       NP-1:0] gate_end_o,
    output logic [         15:0] release_o,
    output logic [         15:0] weak_below_o,
    output logic [ SRAM_NUM-1:0] enable_o,
    output logic [          2:0] shot_bits_o,
    output logic [          7:0] shot_unit_o,
    output logic [         15:0] settle_o
);

  logic [ACQ_WIDTH-1:0] acquisitions_q;
  logic [15:0] release_q, settle_q;
  logic [WEAK_WIDTH-1:0] weak_below_q;
  logic [2:0] shot_bits_q;
  logic [7:0] shot_unit_q;
  logic short_words_q;
  logic [SRAM_NUM-1:0] enable_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      acquisitions_q <= '0;
      release_q <= 16'(MOST_RELEASE);
      weak_below_q <= '0;
      shot_bits_q <= dtof_registers_pkg::SHOT_RESET[dtof_registers_pkg::SHOT_BITS_LSB+:3];
      shot_unit_q <= dtof_registers_pkg::SHOT_RESET[dtof_registers_pkg::SHOT_UNIT_LSB+:8];
      settle_q <= '0;
      short_words_q <= 1'b0;
    end else if (write_i) begin
      case (offset_i)
        dtof_registers_pkg::ACQUISITIONS:
        acquisitions_q <= (acquisitions_q & ~mask_i[ACQ_WIDTH-1:0]) | written_i[ACQ_WIDTH-1:0];
        dtof_registers_pkg::RELEASE:
        release_q <= (release_q & ~mask_i[15:0]) | written_i[15:0];
        dtof_registers_pkg::WEAK_BELOW:
        weak_below_q <= (weak_below_q & ~mask_i[WEAK_WIDTH-1:0]) | written_i[WEAK_WIDTH-1:0];
        dtof_registers_pkg::SHOT: begin
          shot_bits_q <= (shot_bits_q & ~mask_i[dtof_registers_pkg::SHOT_BITS_LSB+:3])
              | written_i[dtof_registers_pkg::SHOT_BITS_LSB+:3];
          shot_unit_q <= (shot_unit_q & ~mask_i[dtof_registers_pkg::SHOT_UNIT_LSB+:8])
              | written_i[dtof_registers_pkg::SHOT_UNIT_LSB+:8];
        end
        dtof_registers_pkg::SETTLE: settle_q <= (settle_q & ~mask_i[15:0]) | written_i[15:0];
        dtof_registers_pkg::OUTPUT:
        if (mask_i[dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB]) begin
          short_words_q <= written_i[dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB];
        end
        default: begin
        end
      endcase
    end
  end

  // Settings that not every configuration has.

  logic second, amplitude, raw, smooth, prior;
  logic [11:0] raw_first, raw_last;
  logic [ACQ_WIDTH-1:0] coarse_end, track_end;
  logic [NP-1:0] gate_begin, gate_end;

  generate
    if (HAS_SCHEDULE != 0) begin : g_schedule
      logic [ACQ_WIDTH-1:0] coarse_end_q, track_end_q;
      logic smooth_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          coarse_end_q <= '0;
          track_end_q <= '0;
          smooth_q <= 1'b1;
        end else if (write_i) begin
          case (offset_i)
            dtof_registers_pkg::COARSE_END:
            coarse_end_q <= (coarse_end_q & ~mask_i[ACQ_WIDTH-1:0]) | written_i[ACQ_WIDTH-1:0];
            dtof_registers_pkg::TRACK_END:
            track_end_q <= (track_end_q & ~mask_i[ACQ_WIDTH-1:0]) | written_i[ACQ_WIDTH-1:0];
            dtof_registers_pkg::OUTPUT:
            if (mask_i[dtof_registers_pkg::OUTPUT_SMOOTH_LSB]) begin
              smooth_q <= written_i[dtof_registers_pkg::OUTPUT_SMOOTH_LSB];
            end
            default: begin
            end
          endcase
        end
      end
      assign coarse_end = coarse_end_q;
      assign track_end = track_end_q;
      assign smooth = smooth_q;
    end else begin : g_no_schedule
      assign coarse_end = '0;
      assign track_end = '0;
      assign smooth = 1'b0;
    end

    if (TIME_GATE != 0) begin : g_gate
      localparam int BEGIN_LSB = dtof_registers_pkg::GATE_BEGIN_LSB;
      localparam int END_LSB = dtof_registers_pkg::GATE_END_LSB;
      logic [NP-1:0] gate_begin_q, gate_end_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          gate_begin_q <= '0;
          gate_end_q <= {NP{1'b1}};
        end else if (write_i && offset_i == dtof_registers_pkg::GATE) begin
          gate_begin_q <= (gate_begin_q & ~mask_i[BEGIN_LSB+:NP]) | written_i[BEGIN_LSB+:NP];
          gate_end_q <= (gate_end_q & ~mask_i[END_LSB+:NP]) | written_i[END_LSB+:NP];
        end
      end
      assign gate_begin = gate_begin_q;
      assign gate_end = gate_end_q;
    end else begin : g_no_gate
      assign gate_begin = '0;
      assign gate_end = '0;
    end

    if (SECOND_TARGET != 0) begin : g_second_target
      logic second_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          second_q <= 1'b0;
        end else if (write_i && offset_i == dtof_registers_pkg::OUTPUT
                     && mask_i[dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB]) begin
          second_q <= written_i[dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB];
        end
      end
      assign second = second_q;
    end else begin : g_one_target
      assign second = 1'b0;
    end

    if (AMPLITUDE != 0) begin : g_amplitude
      logic amplitude_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          amplitude_q <= 1'b0;
        end else if (write_i && offset_i == dtof_registers_pkg::OUTPUT && mask_i[dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB]) begin
          amplitude_q <= written_i[dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB];
        end
      end
      assign amplitude = amplitude_q;
    end else begin : g_no_amplitude
      assign amplitude = 1'b0;
    end

    if (PRIOR != 0) begin : g_prior
      logic prior_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          prior_q <= 1'b0;
        end else if (write_i && offset_i == dtof_registers_pkg::OUTPUT && mask_i[dtof_registers_pkg::OUTPUT_PRIOR_LSB]) begin
          prior_q <= written_i[dtof_registers_pkg::OUTPUT_PRIOR_LSB];
        end
      end
      assign prior = prior_q;
    end else begin : g_no_prior
      assign prior = 1'b0;
    end

    if (RAW_HISTOGRAM != 0) begin : g_raw_histogram
      localparam int FIRST_LSB = dtof_registers_pkg::RAW_ROWS_FIRST_LSB;
      localparam int LAST_LSB = dtof_registers_pkg::RAW_ROWS_LAST_LSB;
      logic raw_q;
      logic [11:0] raw_first_q, raw_last_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          raw_q <= 1'b0;
          raw_first_q <= '0;
          raw_last_q <= '0;
        end else if (write_i && offset_i == dtof_registers_pkg::OUTPUT && mask_i[dtof_registers_pkg::OUTPUT_RAW_LSB]) begin
          raw_q <= written_i[dtof_registers_pkg::OUTPUT_RAW_LSB];
        end else if (write_i && offset_i == dtof_registers_pkg::RAW_ROWS) begin
          raw_first_q <= (raw_first_q & ~mask_i[FIRST_LSB+:12]) | written_i[FIRST_LSB+:12];
          raw_last_q <= (raw_last_q & ~mask_i[LAST_LSB+:12]) | written_i[LAST_LSB+:12];
        end
      end
      assign raw = raw_q;
      assign raw_first = raw_first_q;
      assign raw_last = raw_last_q;
    end else begin : g_no_raw_histogram
      assign raw = 1'b0;
      assign raw_first = '0;
      assign raw_last = '0;
    end
  endgenerate

  // Columns: the register at COLUMN_ENABLE + 4 k has columns from 32 k on.

  localparam int ENABLE_WORDS = (SRAM_NUM + 31) / 32;
  logic [32*ENABLE_WORDS-1:0] enable_words;
  assign enable_words = (32 * ENABLE_WORDS)'(enable_q);

  genvar w;
  generate
    for (w = 0; w < ENABLE_WORDS; w = w + 1) begin : g_enable
      localparam int FIRST = 32 * w;
      localparam int BITS = dtof_pkg::min_of(32, SRAM_NUM - FIRST);
      localparam logic [11:0] OFFSET = dtof_registers_pkg::COLUMN_ENABLE + 12'(4 * w);
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          enable_q[FIRST+:BITS] <= {BITS{1'b1}};
        end else if (write_i && offset_i == OFFSET) begin
          enable_q[FIRST+:BITS] <= (enable_q[FIRST+:BITS] & ~mask_i[BITS-1:0]) | written_i[BITS-1:0];
        end
      end
    end
  endgenerate

  localparam int ENABLE_INDEX_WIDTH = dtof_pkg::index_width(ENABLE_WORDS);
  logic [9:0] enable_index;
  logic [31:0] enable_word;
  assign enable_index = offset_i[11:2] - 10'(dtof_registers_pkg::COLUMN_ENABLE >> 2);
  assign enable_word = (32'(enable_index) < ENABLE_WORDS)
      ? enable_words[32*enable_index[ENABLE_INDEX_WIDTH-1:0]+:32] : '0;

  logic unused;
  assign unused = ^{mask_i, written_i};

  // Committed settings. They need no reset, because no frame begins before START, which commits.

  always_ff @(posedge clk_i) begin
    if (commit_i) begin
      acquisitions_o <= acquisitions_q;
      coarse_end_o <= coarse_end;
      track_end_o <= track_end;
      smooth_o <= smooth;
      prior_o <= prior;
      second_o <= second;
      amplitude_o <= amplitude;
      raw_o <= raw;
      raw_first_o <= raw_first;
      raw_last_o <= raw_last;
      gate_begin_o <= gate_begin;
      gate_end_o <= gate_end;
      release_o <= release_q;
      weak_below_o <= 16'(weak_below_q);
      enable_o <= enable_q;
      shot_bits_o <= shot_bits_q;
      shot_unit_o <= shot_unit_q;
      short_words_o <= short_words_q;
      settle_o <= settle_q;
    end
  end

  // Read data.

  always_comb begin
    data_o = '0;
    case (offset_i)
      dtof_registers_pkg::SHOT: begin
        data_o[dtof_registers_pkg::SHOT_BITS_LSB+:3] = shot_bits_q;
        data_o[dtof_registers_pkg::SHOT_UNIT_LSB+:8] = shot_unit_q;
      end
      dtof_registers_pkg::SETTLE: data_o = 32'(settle_q);
      dtof_registers_pkg::ACQUISITIONS: data_o = 32'(acquisitions_q);
      dtof_registers_pkg::COARSE_END: data_o = 32'(coarse_end);
      dtof_registers_pkg::TRACK_END: data_o = 32'(track_end);
      dtof_registers_pkg::GATE: begin
        data_o[dtof_registers_pkg::GATE_BEGIN_LSB+:16] = 16'(gate_begin);
        data_o[dtof_registers_pkg::GATE_END_LSB+:16] = 16'(gate_end);
      end
      dtof_registers_pkg::RELEASE: data_o = 32'(release_q);
      dtof_registers_pkg::WEAK_BELOW: data_o = 32'(weak_below_q);
      dtof_registers_pkg::OUTPUT: begin
        data_o[dtof_registers_pkg::OUTPUT_SECOND_TARGET_LSB] = second;
        data_o[dtof_registers_pkg::OUTPUT_RAW_LSB] = raw;
        data_o[dtof_registers_pkg::OUTPUT_SMOOTH_LSB] = smooth;
        data_o[dtof_registers_pkg::OUTPUT_PRIOR_LSB] = prior;
        data_o[dtof_registers_pkg::OUTPUT_AMPLITUDE_LSB] = amplitude;
        data_o[dtof_registers_pkg::OUTPUT_SHORT_WORDS_LSB] = short_words_q;
      end
      dtof_registers_pkg::RAW_ROWS: begin
        data_o[dtof_registers_pkg::RAW_ROWS_FIRST_LSB+:12] = raw_first;
        data_o[dtof_registers_pkg::RAW_ROWS_LAST_LSB+:12] = raw_last;
      end
      default: data_o = enable_word;
    endcase
  end

endmodule

`default_nettype wire
