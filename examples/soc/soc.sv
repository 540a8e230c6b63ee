// SPDX-License-Identifier: Apache-2.0
// A small SoC around dtof_subsystem, to begin one's own with (docs/user/soc_example.md). The processor is outside: a bus model in
// the testbench (tb_cpp/tests/soc), or a core of one's own at req_* and rsp_*.
//
//   req_*, rsp_* -> soc_apb_master -> soc_address_decoder -+-> dtof_subsystem -> word_sender -> uart_transmitter -> tx_o
//                                                          |      |     ^
//                                             irq_o <------|------+     | lines
//                                                          +-> soc_scene_registers -> photon_generator
//
// Frames begin when software asks for one. The serial line is slower than the array, which waits for the line.
// Clock: one, of any frequency. rst_ni may be released at any time.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module soc #(
    parameter int READOUT = dtof_pkg::READOUT_HISPOINTER,
    parameter int NP = 10,
    parameter int COLUMNS = 4,
    parameter int ROWS = 8,
    parameter int CLOCKS_PER_BIT = 4
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    // the processor's bus
    input  logic        req_valid_i,
    output logic        req_ready_o,
    input  logic        req_write_i,
    input  logic [31:0] req_addr_i,
    input  logic [31:0] req_wdata_i,
    input  logic [ 3:0] req_strb_i,
    output logic        rsp_valid_o,
    output logic [31:0] rsp_rdata_o,
    output logic        rsp_error_o,
    output logic        irq_o,
    // serial line, results
    output logic        tx_o
);

  localparam int PIXEL_WIDTH = dtof_pkg::index_width(ROWS * COLUMNS);
  localparam int LINE_WIDTH = 8 * ((COLUMNS * NP + 7) / 8);

  logic rst_n;

  dtof_reset_synchroniser u_reset (
      .clk_i      (clk_i),
      .rst_ni     (rst_ni),
      .scan_mode_i(1'b0),
      .rst_no     (rst_n)
  );

  // The bus.

  logic psel, penable, pwrite, pready, pslverr;
  logic readout_psel, readout_pready, readout_pslverr, scene_psel, scene_pready, scene_pslverr;
  logic [31:0] paddr, pwdata, prdata, readout_prdata;
  logic [3:0] pstrb;

  soc_apb_master u_master (
      .clk_i      (clk_i),
      .rst_ni     (rst_n),
      .req_valid_i(req_valid_i),
      .req_ready_o(req_ready_o),
      .req_write_i(req_write_i),
      .req_addr_i (req_addr_i),
      .req_wdata_i(req_wdata_i),
      .req_strb_i (req_strb_i),
      .rsp_valid_o(rsp_valid_o),
      .rsp_rdata_o(rsp_rdata_o),
      .rsp_error_o(rsp_error_o),
      .psel_o     (psel),
      .penable_o  (penable),
      .pwrite_o   (pwrite),
      .paddr_o    (paddr),
      .pwdata_o   (pwdata),
      .pstrb_o    (pstrb),
      .pready_i   (pready),
      .prdata_i   (prdata),
      .pslverr_i  (pslverr)
  );

  soc_address_decoder u_decoder (
      .psel_i           (psel),
      .page_i           (paddr[31:12]),
      .pready_o         (pready),
      .prdata_o         (prdata),
      .pslverr_o        (pslverr),
      .readout_psel_o   (readout_psel),
      .readout_pready_i (readout_pready),
      .readout_prdata_i (readout_prdata),
      .readout_pslverr_i(readout_pslverr),
      .scene_psel_o     (scene_psel),
      .scene_pready_i   (scene_pready),
      .scene_pslverr_i  (scene_pslverr)
  );

  // The source of lines: in a product the TDCs.

  logic target_write, line_tvalid, line_tready, line_tlast;
  logic [PIXEL_WIDTH-1:0] target_pixel;
  logic [NP-1:0] target_code;
  logic [LINE_WIDTH-1:0] line_tdata;

  soc_scene_registers #(
      .NP     (NP),
      .COLUMNS(COLUMNS),
      .ROWS   (ROWS)
  ) u_scene (
      .clk_i         (clk_i),
      .rst_ni        (rst_n),
      .psel_i        (scene_psel),
      .penable_i     (penable),
      .pwrite_i      (pwrite),
      .paddr_i       (paddr[11:0]),
      .pwdata_i      (pwdata),
      .pstrb_i       (pstrb),
      .pready_o      (scene_pready),
      .pslverr_o     (scene_pslverr),
      .target_write_o(target_write),
      .target_pixel_o(target_pixel),
      .target_code_o (target_code)
  );

  photon_generator #(
      .NP     (NP),
      .COLUMNS(COLUMNS),
      .ROWS   (ROWS)
  ) u_photons (
      .clk_i          (clk_i),
      .rst_ni         (rst_n),
      .target_write_i (target_write),
      .target_pixel_i (target_pixel),
      .target_code_i  (target_code),
      .m_axis_tvalid_o(line_tvalid),
      .m_axis_tready_i(line_tready),
      .m_axis_tdata_o (line_tdata),
      .m_axis_tlast_o (line_tlast)
  );

  // The read-out.

  logic result_tvalid, result_tready, result_tuser, result_tlast, unused_shot;
  logic [63:0] result_tdata;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] unused_sram_cfg;

  dtof_subsystem #(
      .READOUT        (READOUT),
      .NP             (NP),
      .SRAM_NUM       (COLUMNS),
      .PIXELS_PER_SRAM(ROWS),
      .SLOTS          (2)
  ) u_subsystem (
      .clk_i          (clk_i),
      .rst_ni         (rst_n),
      .scan_mode_i    (1'b0),
      .sram_cfg_i     ('0),
      .sram_cfg_o     (unused_sram_cfg),
      .psel_i         (readout_psel),
      .penable_i      (penable),
      .pwrite_i       (pwrite),
      .paddr_i        (paddr[11:0]),
      .pwdata_i       (pwdata),
      .pstrb_i        (pstrb),
      .pready_o       (readout_pready),
      .prdata_o       (readout_prdata),
      .pslverr_o      (readout_pslverr),
      .irq_o          (irq_o),
      .shot_o         (unused_shot),  // the source fires by itself
      .s_axis_tvalid_i(line_tvalid),
      .s_axis_tready_o(line_tready),
      .s_axis_tdata_i (line_tdata),
      .s_axis_tlast_i (line_tlast),
      .m_axis_tvalid_o(result_tvalid),
      .m_axis_tready_i(result_tready),
      .m_axis_tdata_o (result_tdata),
      .m_axis_tuser_o (result_tuser),
      .m_axis_tlast_o (result_tlast)
  );

  // The sink of results: in a product a DMA.

  logic byte_valid, byte_ready;
  logic [7:0] byte_data;

  word_sender u_sender (
      .clk_i          (clk_i),
      .rst_ni         (rst_n),
      .s_axis_tvalid_i(result_tvalid),
      .s_axis_tready_o(result_tready),
      .s_axis_tdata_i (result_tdata),
      .s_axis_tuser_i (result_tuser),
      .s_axis_tlast_i (result_tlast),
      .valid_o        (byte_valid),
      .ready_i        (byte_ready),
      .data_o         (byte_data)
  );

  uart_transmitter #(
      .CLOCKS_PER_BIT(CLOCKS_PER_BIT)
  ) u_transmitter (
      .clk_i  (clk_i),
      .rst_ni (rst_n),
      .valid_i(byte_valid),
      .ready_o(byte_ready),
      .data_i (byte_data),
      .tx_o   (tx_o)
  );

endmodule

`default_nettype wire
