// SPDX-License-Identifier: Apache-2.0
// poolPointer: parities of the words that an SRAM reads and writes (dtof_pool_quad with PARITY = 1), for dtof_pool_parity_store.
//
// The parity is the XOR of a word's bits. The last bits of a pair's data to write come late in their clock, so a tree of XORs in front of
// the SRAM would make the clock slower. This module stores parities of a few bits each in registers instead, and combines these one clock
// later. The SRAM's words have no parity bit: the parities are stored in a memory of their own, in which all accesses come later.
//   clock after the access   0                1                2                          3
//   write                    parities of      all of them      the written or the         parity_o
//                            chunks           combined         read word's parity
//   read                                      parities of      all of them combined       parity_o
//                                             chunks
// Latency: POOL_PARITY_CLOCKS from an access to parity_o and accessed_o.
// Cost: two trees of XORs, each with one XOR for every bit of the word; a flip-flop for every 2 late bits and for every 16 other bits of
// the written word, a flip-flop for every 24 bits of the read word, seven more flip-flops.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_word_parity #(
    parameter int PAIRS = 2,
    parameter int WORD_WIDTH = 116,  // bits of a pair's part of the word
    parameter int LATE_WIDTH = 29,   // its last bits, which come late in the clock of the write
    localparam int WIDTH = PAIRS * WORD_WIDTH
) (
    input  logic             clk_i,
    input  logic             read_i,        // the SRAM is read in this clock
    input  logic [WIDTH-1:0] read_data_i,   // one clock after read_i
    input  logic             write_i,       // the SRAM is written in this clock
    input  logic [WIDTH-1:0] write_data_i,
    output logic             accessed_o,    // the SRAM was accessed POOL_PARITY_CLOCKS ago
    output logic             parity_o       // with accessed_o: parity of the word that was read or written
);

  // Bits in front of a register: the fewer, the later they may come.
  localparam int READ_CHUNK = 24;
  localparam int CHUNK = 16;
  localparam int LATE_CHUNK = 2;
  localparam int EARLY_WIDTH = WORD_WIDTH - LATE_WIDTH;
  localparam int EARLY_CHUNKS = (EARLY_WIDTH + CHUNK - 1) / CHUNK;
  localparam int LATE_CHUNKS = (LATE_WIDTH + LATE_CHUNK - 1) / LATE_CHUNK;
  localparam int PAIR_CHUNKS = EARLY_CHUNKS + LATE_CHUNKS;
  localparam int READ_CHUNKS = (WIDTH + READ_CHUNK - 1) / READ_CHUNK;

  logic [PAIRS*PAIR_CHUNKS-1:0] written_d, written_q;
  logic [READ_CHUNKS-1:0] read_d, read_q;
  logic read_t1_q, read_t2_q, accessed_t1_q, accessed_t2_q, accessed_q, written_parity_q, parity_q;

  genvar p, c;
  generate
    for (p = 0; p < PAIRS; p = p + 1) begin : g_pair
      for (c = 0; c < EARLY_CHUNKS; c = c + 1) begin : g_early
        localparam int FIRST = c * CHUNK;
        localparam int BITS = (EARLY_WIDTH - FIRST < CHUNK) ? EARLY_WIDTH - FIRST : CHUNK;
        assign written_d[p*PAIR_CHUNKS+c] = ^write_data_i[p*WORD_WIDTH+FIRST+:BITS];
      end
      for (c = 0; c < LATE_CHUNKS; c = c + 1) begin : g_late
        localparam int FIRST = c * LATE_CHUNK;
        localparam int BITS = (LATE_WIDTH - FIRST < LATE_CHUNK) ? LATE_WIDTH - FIRST : LATE_CHUNK;
        assign written_d[p*PAIR_CHUNKS+EARLY_CHUNKS+c] = ^write_data_i[p*WORD_WIDTH+EARLY_WIDTH+FIRST+:BITS];
      end
    end
    for (c = 0; c < READ_CHUNKS; c = c + 1) begin : g_read
      localparam int FIRST = c * READ_CHUNK;
      localparam int BITS = (WIDTH - FIRST < READ_CHUNK) ? WIDTH - FIRST : READ_CHUNK;
      assign read_d[c] = ^read_data_i[FIRST+:BITS];
    end
  endgenerate

  // No reset: dtof_pool_parity_store takes no notice of accesses before the first one that the array's control has sent.
  always_ff @(posedge clk_i) begin
    written_q <= written_d;
    read_q <= read_d;
    read_t1_q <= read_i;
    read_t2_q <= read_t1_q;
    accessed_t1_q <= read_i || write_i;
    accessed_t2_q <= accessed_t1_q;
    accessed_q <= accessed_t2_q;
    written_parity_q <= ^written_q;
    parity_q <= read_t2_q ? ^read_q : written_parity_q;
  end

  assign accessed_o = accessed_q;
  assign parity_o = parity_q;

endmodule

`default_nettype wire
