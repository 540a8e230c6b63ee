// SPDX-License-Identifier: Apache-2.0
// dtof_sram with optional parity bits in each word, which are checked at each read.
//
// 1. With PARITY = 1 a word is stored with the XOR of its bits. A word that is read with an odd number of wrong bits raises error_o;
//    read_data_o has the wrong word. An even number of wrong bits has no effect on error_o. With PARITIES > 1 the word has as many parts of
//    one width, except the last ones, which may be narrower, and each part has a parity bit. The trees of XORs are then shorter, for data that come late in the clock of a write.
// 2. With PARITY = 0 this module is a dtof_sram and nothing else.
// 3. A word whose data nothing uses is not checked: a word that is written in the clock of its read, and a word for which ignore_i is
//    high in the clock of the data. A word that was never written has no parity yet, so its reader raises ignore_i.
//
// Contract: that of dtof_sram.
// Schedule: read_en_i in clock 0, data and ignore_i in clock 1, error_o in clock 2 for one clock, from a flip-flop.
// Latency: 1 clock to the data, 2 clocks to error_o.
// Cost with PARITY = 1: PARITIES bits per word, two trees of WIDTH XORs, two flip-flops; with PORTS = 2 a comparator of addresses.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_parity_sram #(
    parameter int PORTS = 2,
    parameter int DEPTH = 160,  // words
    parameter int WIDTH = 10,   // bits of a word without parity
    parameter int PARITY = 0,   // 1: each word has parity bits
    parameter int PARITIES = 1,  // with PARITY = 1: parity bits of a word
    localparam int ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] cfg_i,  // side band of the macro
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] cfg_o,
    input  logic                  read_en_i,
    input  logic [ADDR_WIDTH-1:0] read_addr_i,
    output logic [     WIDTH-1:0] read_data_o,
    input  logic                  ignore_i,             // the word that was read one clock ago is not used
    output logic                  error_o,              // the word that was read two clocks ago is damaged
    input  logic                  write_en_i,
    input  logic [ADDR_WIDTH-1:0] write_addr_i,
    input  logic [     WIDTH-1:0] write_data_i
);

  `DTOF_REQUIRE(g_illegal_parity, PARITY == 0 || PARITY == 1, "dtof_parity_sram: PARITY must be 0 or 1")

  `DTOF_REQUIRE(g_illegal_parities, PARITIES >= 1 && PARITIES <= WIDTH, "dtof_parity_sram: PARITIES must be 1 to WIDTH")

  localparam int STORED_WIDTH = WIDTH + ((PARITY != 0) ? PARITIES : 0);

  logic [STORED_WIDTH-1:0] stored, written;

  assign read_data_o = stored[WIDTH-1:0];

  dtof_sram #(
      .PORTS(PORTS),
      .DEPTH(DEPTH),
      .WIDTH(STORED_WIDTH)
  ) u_words (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (cfg_i),
      .cfg_o       (cfg_o),
      .read_en_i   (read_en_i),
      .read_addr_i (read_addr_i),
      .read_data_o (stored),
      .write_en_i  (write_en_i),
      .write_addr_i(write_addr_i),
      .write_parts_i(1'b1),
      .write_data_i(written)
  );

  generate
    if (PARITY != 0) begin : g_parity
      localparam int PART = (WIDTH + PARITIES - 1) / PARITIES;  // bits of all parts but the last ones
      logic read_q, error_q, overtaken;
      logic [PARITIES-1:0] odd;  // parts of the stored word with an odd number of wrong bits
      genvar k;
      for (k = 0; k < PARITIES; k = k + 1) begin : g_part
        localparam int FIRST = (k * PART < WIDTH - 1) ? k * PART : WIDTH - 1;
        localparam int BITS = (WIDTH - FIRST < PART) ? WIDTH - FIRST : PART;
        assign written[WIDTH+k] = ^write_data_i[FIRST+:BITS];
        assign odd[k] = ^{stored[WIDTH+k], stored[FIRST+:BITS]};
      end
      assign overtaken = write_en_i && (PORTS == 1 || write_addr_i == read_addr_i);
      assign written[WIDTH-1:0] = write_data_i;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          read_q <= 1'b0;
          error_q <= 1'b0;
        end else begin
          read_q <= read_en_i && !overtaken;
          error_q <= read_q && !ignore_i && odd != '0;
        end
      end
      assign error_o = error_q;
    end else begin : g_no_parity
      logic unused_ignore;
      assign unused_ignore = ignore_i;
      assign written = write_data_i;
      assign error_o = 1'b0;
    end
  endgenerate

endmodule

`default_nettype wire
