// SPDX-License-Identifier: Apache-2.0
// poolPointer with PARITY = 1: parity bits of all words of the SRAMs that hold pixels and groups, and their check.
//
// One memory for the array has a word for each address, and in it a bit for each SRAM, because all SRAMs use the same address in a clock.
// The parities of the words that are accessed in clock T arrive in clock T + POOL_PARITY_CLOCKS + WAY_CLOCKS (dtof_pool_word_parity). Registers
// store them, because the SRAMs are up to half of the array away, and this memory is accessed one clock later. A read of a word compares its parity
// with the stored bit.
//
// A write of an address concerns only the SRAMs that were written. The bits of all other SRAMs keep their values, which this module has from
// the last read of the same address: it keeps the last three reads of different addresses. A write for which no SRAM is missing, such as
// a clear, needs no read before it.
//   clock (T: access of the SRAMs)   T+3          T+4              T+5          T+6
//   read                             registered   memory read      compared     error_o; kept for writes
//   write                            registered   memory written
// With WAY_CLOCKS > 0 all of this comes as many clocks later.
// Latency: POOL_PARITY_CLOCKS + WAY_CLOCKS + 3 from an access to error_o.
// Cost: a single-port SRAM of DEPTH words and a bit for each SRAM; seven flip-flops for each SRAM, four comparators of addresses.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_parity_store #(
    parameter int SRAMS = 50,
    parameter int DEPTH = 100,     // words of an SRAM
    parameter int WAY_CLOCKS = 0,  // registers between the SRAMs and this module
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    // side band of the SRAM macro
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    // access of the SRAMs, as they receive it
    input  logic                  read_i,
    input  logic                  write_i,
    input  logic [ADDR_WIDTH-1:0] address_i,
    // POOL_PARITY_CLOCKS + WAY_CLOCKS later, a bit for each SRAM
    input  logic [     SRAMS-1:0] accessed_i,  // this SRAM was accessed
    input  logic [     SRAMS-1:0] parity_i,
    output logic                  error_o      // one clock: a word that was read is damaged
);

  localparam int DELAY = dtof_pkg::POOL_PARITY_CLOCKS + WAY_CLOCKS + 1;
  localparam int KEPT = 3;  // reads between which and the write of the same address others may come

  // The access, delayed until the parities are in the registers.

  logic [DELAY-1:0] reads_q, writes_q;
  logic [DELAY*ADDR_WIDTH-1:0] addresses_q;
  logic read, write;
  logic [ADDR_WIDTH-1:0] address;
  logic [SRAMS-1:0] accessed_q, parities_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      reads_q <= '0;
      writes_q <= '0;
    end else begin
      reads_q <= {reads_q[DELAY-2:0], read_i};
      writes_q <= {writes_q[DELAY-2:0], write_i};
    end
  end

  always_ff @(posedge clk_i) begin
    addresses_q <= {addresses_q[(DELAY-1)*ADDR_WIDTH-1:0], address_i};
    accessed_q <= accessed_i;
    parities_q <= parity_i;
  end

  assign read = reads_q[DELAY-1] && accessed_q != '0;
  assign write = writes_q[DELAY-1] && accessed_q != '0;
  assign address = addresses_q[DELAY*ADDR_WIDTH-1-:ADDR_WIDTH];

  // The last reads.

  logic [KEPT*ADDR_WIDTH-1:0] kept_addresses_q;
  logic [KEPT*SRAMS-1:0] kept_q;
  logic [KEPT-1:0] known_q, same;  // a kept read is known until a write of its address
  logic [ADDR_WIDTH-1:0] read_address_q;
  logic [SRAMS-1:0] stored, others, written;
  logic compares_q, keeps;
  integer k;

  always_comb begin
    others = '0;
    for (k = 0; k < KEPT; k = k + 1) begin
      same[k] = known_q[k] && kept_addresses_q[k*ADDR_WIDTH+:ADDR_WIDTH] == address;
      others = others | (kept_q[k*SRAMS+:SRAMS] & {SRAMS{same[k]}});
    end
  end

  assign written = (parities_q & accessed_q) | (others & ~accessed_q);

  // Some SRAMs read an address one clock later than the others (dtof_pair_sequencer).
  assign keeps = compares_q && !(known_q[0] && kept_addresses_q[ADDR_WIDTH-1:0] == read_address_q);

  logic [KEPT-1:0] still_known;
  assign still_known = known_q & ~(same & {KEPT{read || write}});

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      known_q <= '0;
    end else begin
      known_q <= keeps ? {still_known[KEPT-2:0], 1'b1} : still_known;
    end
  end

  always_ff @(posedge clk_i) begin
    if (read) begin
      read_address_q <= address;
    end
    if (keeps) begin
      kept_q <= {kept_q[(KEPT-1)*SRAMS-1:0], stored};
      kept_addresses_q <= {kept_addresses_q[(KEPT-1)*ADDR_WIDTH-1:0], read_address_q};
    end
  end

  dtof_sram #(
      .PORTS(1),
      .DEPTH(DEPTH),
      .WIDTH(SRAMS)
  ) u_parities (
      .clk_i       (clk_i),
      .rst_ni      (rst_ni),
      .cfg_i       (sram_cfg_i),
      .cfg_o       (sram_cfg_o),
      .read_en_i   (read),
      .read_addr_i (address),
      .read_data_o (stored),
      .write_en_i  (write),
      .write_addr_i(address),
      .write_parts_i(1'b1),
      .write_data_i(written)
  );

  // Check.

  logic [SRAMS-1:0] read_q, read_parities_q;
  logic error_q;

  always_ff @(posedge clk_i) begin
    if (read) begin
      read_q <= accessed_q;
      read_parities_q <= parities_q;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      compares_q <= 1'b0;
      error_q <= 1'b0;
    end else begin
      compares_q <= read;
      error_q <= compares_q && (read_q & (read_parities_q ^ stored)) != '0;
    end
  end

  assign error_o = error_q;

  `DTOF_ASSERT(a_others_known, !write || (&accessed_q) || same != '0,
               "a word's parities are written, and those of the SRAMs that were not written are not known")

endmodule

`default_nettype wire
