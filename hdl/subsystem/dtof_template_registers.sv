// SPDX-License-Identifier: Apache-2.0
// The registers TEMPLATE: the coarse template of poolPointer, four entries a register. A write is valid at once. Without HAS_SCHEDULE there are
// none, and template_o is 0. dtof_writable_bits refuses writes within a frame.
//
// Latency: an entry is at template_o in the clock after its write.
// Cost: 256 flip-flops and a multiplexer for reads.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_template_registers #(
    parameter int HAS_SCHEDULE = 0,
    localparam int WORDS = dtof_registers_pkg::TEMPLATE_NUMBER
) (
    input  logic                clk_i,
    input  logic                rst_ni,
    input  logic [        11:0] offset_i,
    input  logic                write_i,
    input  logic [        31:0] mask_i,      // bits that are written
    input  logic [        31:0] written_i,   // bits that are written as 1
    output logic [        31:0] data_o,      // value of the register at offset_i; 0 at an offset of another one
    output logic [32*WORDS-1:0] template_o
);

  localparam logic [11:0] FIRST = dtof_registers_pkg::TEMPLATE;
  localparam logic [2:0] FIRST_INDEX = 3'(FIRST >> 2);

  generate
    if (HAS_SCHEDULE != 0) begin : g_template
      // The register at TEMPLATE + 4 k has entries 4 k to 4 k + 3.
      genvar w;
      for (w = 0; w < WORDS; w = w + 1) begin : g_word
        logic [31:0] word_q;
        always_ff @(posedge clk_i or negedge rst_ni) begin
          if (!rst_ni) begin
            word_q <= '0;
          end else if (write_i && offset_i == FIRST + 12'(4 * w)) begin
            word_q <= (word_q & ~mask_i) | written_i;
          end
        end
        assign template_o[32*w+:32] = word_q;
      end

      logic [2:0] index;
      assign index = offset_i[4:2] - FIRST_INDEX;
      assign data_o = (offset_i >= FIRST && offset_i < FIRST + 12'(4 * WORDS)) ? template_o[32*index+:32] : '0;
    end else begin : g_no_template
      logic unused;
      assign unused = ^{clk_i, rst_ni, offset_i, write_i, mask_i, written_i};
      assign template_o = '0;
      assign data_o = '0;
    end
  endgenerate

endmodule

`default_nettype wire
