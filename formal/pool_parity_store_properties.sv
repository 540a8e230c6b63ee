// SPDX-License-Identifier: Apache-2.0
// Proves of dtof_pool_parity_store with a dtof_pool_word_parity at each of two SRAMs: words that are as they were written raise no error; a
// word of which an odd number of bits has changed raises an error in the clock that the headers state. Accesses are any that keep the
// contract: some SRAMs of an address are written without the others only if the address is one of the last three addresses that were read, if its last
// read was two clocks ago or earlier, and if the address was not written since.
`include "properties.svh"

// verilator lint_off TIMESCALEMOD
`default_nettype none

module pool_parity_store_properties #(
    parameter int DEPTH = 4,
    parameter int PAIRS = 1,
    parameter int WORD_WIDTH = 6,
    parameter int LATE_WIDTH = 5,
    parameter int WAY_CLOCKS = 0,
    localparam int SRAMS = 2,
    localparam int WIDTH = PAIRS * WORD_WIDTH,
    localparam int KEPT = 3,
    localparam int ADDR_WIDTH = dtof_pkg::index_width(DEPTH)
) (
    input logic                   clk_i,
    input logic                   reset_i,
    input logic                   read_i,
    input logic                   write_i,
    input logic [ ADDR_WIDTH-1:0] address_i,
    input logic [      SRAMS-1:0] here_i,     // this SRAM takes part in the access
    input logic [SRAMS*WIDTH-1:0] data_i,     // of a write, and of the read of an address that is not observed
    input logic [SRAMS*WIDTH-1:0] changed_i   // bits that have changed since the observed word was written
);

  logic checking = 1'b0;
  logic rst_n;
  assign rst_n = checking && !reset_i;
  always_ff @(posedge clk_i) begin
    checking <= 1'b1;
  end

  // One address is observed: which SRAMs have a word there, and their words.
  (* anyconst *) logic [ADDR_WIDTH-1:0] watched;
  logic [SRAMS-1:0] known_q, read_known_q, read_here_q, odd;
  logic [SRAMS*WIDTH-1:0] words_q, read_data;
  logic read_q, read_watched_q;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      known_q <= '0;
    end else if (write_i && address_i == watched) begin
      known_q <= known_q | here_i;
    end
    read_watched_q <= rst_n && read_i && address_i == watched && here_i != '0;
    read_q <= rst_n && read_i && here_i != '0;
    read_known_q <= known_q;
    read_here_q <= here_i;
  end

  genvar s;
  generate
    for (s = 0; s < SRAMS; s = s + 1) begin : g_sram
      logic [WIDTH-1:0] at_read_q;
      always_ff @(posedge clk_i) begin
        if (write_i && address_i == watched && here_i[s]) begin
          words_q[s*WIDTH+:WIDTH] <= data_i[s*WIDTH+:WIDTH];
        end
        at_read_q <= words_q[s*WIDTH+:WIDTH];
      end
      assign odd[s] = ^changed_i[s*WIDTH+:WIDTH];
      assign read_data[s*WIDTH+:WIDTH] = read_watched_q ? at_read_q ^ changed_i[s*WIDTH+:WIDTH] : data_i[s*WIDTH+:WIDTH];
    end
  endgenerate

  // The last reads of different addresses, from two clocks after the read on, until the next access of the address.
  logic [KEPT*ADDR_WIDTH-1:0] kept_q;
  logic [KEPT-1:0] valid_q, is_address;
  logic [ADDR_WIDTH-1:0] before_q;
  logic before_valid_q, reads, keeps;
  integer k;

  assign reads = rst_n && read_i && here_i != '0;
  assign keeps = before_valid_q && !(valid_q[0] && kept_q[ADDR_WIDTH-1:0] == before_q);

  always_comb begin
    for (k = 0; k < KEPT; k = k + 1) begin
      is_address[k] = valid_q[k] && kept_q[k*ADDR_WIDTH+:ADDR_WIDTH] == address_i;
    end
  end

  always_ff @(posedge clk_i) begin
    before_q <= address_i;
    before_valid_q <= reads;
    if (!rst_n) begin
      valid_q <= '0;
    end else if (keeps) begin
      valid_q <= {valid_q[KEPT-2:0] & ~(is_address[KEPT-2:0] & {(KEPT-1){write_i || reads}}), !(write_i && address_i == before_q)};
      kept_q <= {kept_q[(KEPT-1)*ADDR_WIDTH-1:0], before_q};
    end else begin
      valid_q <= valid_q & ~(is_address & {KEPT{write_i || reads}});
    end
  end

  logic [SRAMS-1:0] accessed, parities;
  logic error;

  generate
    for (s = 0; s < SRAMS; s = s + 1) begin : g_word
      logic accessed_here, parity;
      dtof_pool_word_parity #(
          .PAIRS     (PAIRS),
          .WORD_WIDTH(WORD_WIDTH),
          .LATE_WIDTH(LATE_WIDTH)
      ) u_word_parity (
          .clk_i       (clk_i),
          .read_i      (read_i && here_i[s]),
          .read_data_i (read_data[s*WIDTH+:WIDTH]),
          .write_i     (write_i && here_i[s]),
          .write_data_i(data_i[s*WIDTH+:WIDTH]),
          .accessed_o  (accessed_here),
          .parity_o    (parity)
      );
      if (WAY_CLOCKS == 0) begin : g_beside
        assign accessed[s] = accessed_here;
        assign parities[s] = parity;
      end else begin : g_away
        logic [WAY_CLOCKS-1:0] accesses_q, parities_q;
        always_ff @(posedge clk_i) begin
          accesses_q <= WAY_CLOCKS'({accesses_q, accessed_here});
          parities_q <= WAY_CLOCKS'({parities_q, parity});
        end
        assign accessed[s] = accesses_q[WAY_CLOCKS-1];
        assign parities[s] = parities_q[WAY_CLOCKS-1];
      end
    end
  endgenerate

  dtof_pool_parity_store #(
      .SRAMS     (SRAMS),
      .DEPTH     (DEPTH),
      .WAY_CLOCKS(WAY_CLOCKS)
  ) u_dut (
      .clk_i     (clk_i),
      .rst_ni    (rst_n),
      .sram_cfg_i('0),
      .read_i    (read_i),
      .write_i   (write_i),
      .address_i (address_i),
      .accessed_i(accessed),
      .parity_i  (parities),
      .error_o   (error)
  );

  // Expected errors, from the clock of the data on.
  localparam int CLOCKS = dtof_pkg::POOL_PARITY_CLOCKS + WAY_CLOCKS + 2;
  logic [CLOCKS-1:0] damaged_q, good_q, reads_q;
  logic damaged, good;
  assign damaged = read_watched_q && (read_here_q & read_known_q & odd) != '0;
  assign good = read_watched_q && (read_here_q & (odd | ~read_known_q)) == '0;

  always_ff @(posedge clk_i) begin
    damaged_q <= {CLOCKS{rst_n}} & {damaged_q[CLOCKS-2:0], damaged};
    good_q <= {CLOCKS{rst_n}} & {good_q[CLOCKS-2:0], good};
    reads_q <= {CLOCKS{rst_n}} & {reads_q[CLOCKS-2:0], read_q};
  end

  `ASSUME(m_range, address_i < DEPTH)
  `ASSUME(m_one_port, !(read_i && write_i))
  `ASSUME(m_contract, !rst_n || !write_i || here_i == '0 || (&here_i) || is_address != '0)
  `PROVE(a_damaged, !rst_n || !damaged_q[CLOCKS-1] || error)
  `PROVE(a_no_false_alarm, !rst_n || !good_q[CLOCKS-1] || !error)
  `PROVE(a_only_behind_a_read, !rst_n || reads_q[CLOCKS-1] || !error)
  `GOAL(rst_n && damaged_q[CLOCKS-1] && error)

endmodule

`default_nettype wire
