// SPDX-License-Identifier: Apache-2.0
// APB4 transfers to registers: samples what a read returns, decides in the setup whether a transfer is refused, and gives accepted writes
// to the registers as one pulse with an offset and the bits of each byte.
//
// A transfer takes two clocks; a read may have up to three wait states, and every transfer waits while starting_i is high. pslverr_o reports
// an access to an offset without a register, a write to a register without a writable bit in this configuration, and a write of 1 to a bit
// of a setting or command that this configuration does not have. Such an access writes nothing. pstrb_i selects bytes; there is no pprot.
// Schedule: clock 0 is APB's setup, in which a read samples; clock 1 is its access, with prdata_o from flip-flops. A write takes effect at the end
// of clock 1. A read has a wait state, and samples in its last one, if its setup directly follows a write's access, so that it sees what the write
// has done, and while pending_i is high. An access without a setup is refused.
// Latency: as in the schedule.
// Cost: 32 flip-flops for the data of a read, five for the state of the transfer.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module dtof_apb_port (
    input  logic        clk_i,
    input  logic        rst_ni,
    // APB4
    input  logic        psel_i,
    input  logic        penable_i,
    input  logic        pwrite_i,
    input  logic [11:0] paddr_i,
    input  logic [31:0] pwdata_i,
    input  logic [ 3:0] pstrb_i,
    output logic        pready_o,
    output logic [31:0] prdata_o,
    output logic        pslverr_o,
    // registers
    input  logic        starting_i,  // every transfer waits
    input  logic        pending_i,   // reads wait: what they return follows at once
    output logic [11:0] offset_o,
    output logic        write_o,     // an accepted write ends in this clock
    output logic [31:0] mask_o,      // bits that pstrb_i selects
    output logic [31:0] written_o,   // selected bits that are written as 1
    input  logic [31:0] there_i,     // bits of the register at offset_o that a write of 1 may set
    input  logic [31:0] data_i       // value of the register at offset_o
);

  // What a transfer may do is decided in its setup, in which all its signals are valid.

  logic setup, access, armed_q, waits_q, wrote_q, writable_q, refused_q, known, writable;
  logic [31:0] data_q;

  assign offset_o = {paddr_i[11:2], 2'b00};
  assign setup = psel_i && (!penable_i || waits_q);  // also in a wait state, in which a read samples again
  assign access = psel_i && penable_i && armed_q && !waits_q;
  assign known = dtof_registers_pkg::is_register(offset_o);
  assign writable = dtof_registers_pkg::is_writable(offset_o) && (there_i != '0) && ((written_o & ~there_i) == '0);
  assign write_o = access && pwrite_i && writable_q;
  assign mask_o = {{8{pstrb_i[3]}}, {8{pstrb_i[2]}}, {8{pstrb_i[1]}}, {8{pstrb_i[0]}}};
  assign written_o = pwdata_i & mask_o;

  logic unused_address;
  assign unused_address = ^paddr_i[1:0];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      armed_q <= 1'b0;
      waits_q <= 1'b0;
      wrote_q <= 1'b0;
    end else begin
      armed_q <= setup;
      waits_q <= setup && (starting_i || (!pwrite_i && (pending_i || (!penable_i && wrote_q))));
      wrote_q <= write_o;
    end
  end

  always_ff @(posedge clk_i) begin
    if (setup) begin
      data_q <= data_i;
      writable_q <= writable;
      refused_q <= pwrite_i ? !writable : !known;
    end
  end

  assign pready_o = !waits_q;
  assign pslverr_o = psel_i && penable_i && !waits_q && (refused_q || !armed_q);
  assign prdata_o = data_q;

endmodule

`default_nettype wire
