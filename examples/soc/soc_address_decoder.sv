// SPDX-License-Identifier: Apache-2.0
// The address map of the SoC: selects the slave whose 4 KiB an APB address lies in, and leads the slave's answer back.
//
// | addresses | slave |
// | READOUT_PAGE 000 to FFF | dtof_subsystem |
// | SCENE_PAGE 000 to FFF | soc_scene_registers |
// | all others | none: the transfer ends at once, with an error |
//
// Latency: none; everything is combinational.
// Cost: two comparisons of 20 bits, a multiplexer.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module soc_address_decoder #(
    parameter logic [19:0] READOUT_PAGE = 20'h40000,
    parameter logic [19:0] SCENE_PAGE = 20'h40001
) (
    input  logic        psel_i,
    input  logic [19:0] page_i,            // PADDR[31:12]
    output logic        pready_o,
    output logic [31:0] prdata_o,
    output logic        pslverr_o,
    output logic        readout_psel_o,
    input  logic        readout_pready_i,
    input  logic [31:0] readout_prdata_i,
    input  logic        readout_pslverr_i,
    output logic        scene_psel_o,
    input  logic        scene_pready_i,
    input  logic        scene_pslverr_i
);

  logic is_readout, is_scene;

  assign is_readout = (page_i == READOUT_PAGE);
  assign is_scene = (page_i == SCENE_PAGE);
  assign readout_psel_o = psel_i && is_readout;
  assign scene_psel_o = psel_i && is_scene;
  assign pready_o = is_readout ? readout_pready_i : (!is_scene || scene_pready_i);
  assign prdata_o = is_readout ? readout_prdata_i : '0;
  assign pslverr_o = is_readout ? readout_pslverr_i : (!is_scene || scene_pslverr_i);

endmodule

`default_nettype wire
