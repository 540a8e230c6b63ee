// SPDX-License-Identifier: Apache-2.0
// poolPointer: errors of damaged words, once per array. With PARITY = 1 dtof_pool_parity_store compares the parities of the SRAMs' words, and
// error_o is high for a clock for each error of the store or of the engines' chain. With PARITY = 0 error_o stays low.
//
// accessed_i and parity_i come from dtof_pool_word_parity. In a wide array they pass STAGES registers on their way to the store.
// Latency: from engine_error_i to error_o a clock; from parity_i STAGES clocks and a clock more than dtof_pool_parity_store alone.
// Cost: with PARITY = 1 dtof_pool_parity_store, 2 x STAGES flip-flops for each SRAM, and a flip-flop.
`include "dtof_macros.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_pool_parity #(
    parameter int PARITY = 1,
    parameter int SRAMS = 50,
    parameter int DEPTH = 100,  // words of an SRAM
    parameter int STAGES = 0,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input  logic                                clk_i,
    input  logic                                rst_ni,
    input  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_i,
    output logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg_o,
    input  logic                                read_i,  // commands of the SRAMs
    input  logic                                write_i,
    input  logic [              ADDR_WIDTH-1:0] address_i,
    input  logic [                   SRAMS-1:0] accessed_i,
    input  logic [                   SRAMS-1:0] parity_i,
    input  logic                                engine_error_i,  // of the engines' chain
    output logic                                error_o
);

  logic sram_error;

  generate
    if (PARITY != 0) begin : g_parity
      logic [2*SRAMS-1:0] parities_there;

      if (STAGES > 0) begin : g_stages
        dtof_broadcast #(
            .WIDTH (2 * SRAMS),
            .STAGES(STAGES)
        ) u_parity_stages (
            .clk_i (clk_i),
            .rst_ni(rst_ni),
            .from_i({accessed_i, parity_i}),
            .to_o  (parities_there)
        );
      end else begin : g_no_stages
        assign parities_there = {accessed_i, parity_i};
      end

      dtof_pool_parity_store #(
          .SRAMS     (SRAMS),
          .DEPTH     (DEPTH),
          .WAY_CLOCKS(STAGES)
      ) u_parity_store (
          .clk_i     (clk_i),
          .rst_ni    (rst_ni),
          .sram_cfg_i(sram_cfg_i),
          .sram_cfg_o(sram_cfg_o),
          .read_i    (read_i),
          .write_i   (write_i),
          .address_i (address_i),
          .accessed_i(parities_there[2*SRAMS-1:SRAMS]),
          .parity_i  (parities_there[SRAMS-1:0]),
          .error_o   (sram_error)
      );
    end else begin : g_no_parity
      assign sram_cfg_o = '1;
      assign sram_error = 1'b0;
      logic unused_parities;
      assign unused_parities = ^{sram_cfg_i, read_i, write_i, address_i, accessed_i, parity_i};
    end
  endgenerate

  dtof_event_link #(
      .PRESENT(PARITY)
  ) u_parity_head (
      .clk_i        (clk_i),
      .rst_ni       (rst_ni),
      .event_i      (sram_error),
      .next_column_i(engine_error_i),
      .event_o      (error_o)
  );

endmodule

`default_nettype wire
