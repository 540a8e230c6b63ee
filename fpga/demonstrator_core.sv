// SPDX-License-Identifier: Apache-2.0
// dtof_subsystem without a sensor, for the demonstrators on an FPGA (demonstrator.sv) and in open silicon (shuttle/dtof_shuttle.sv): a
// generator makes photons on the chip, ezPointer, hisPointer or poolPointer lean reads them out, and results leave through a serial line,
// which also receives commands that change the targets.
//
//   rx_i -> uart_receiver -> target_command -> photon_generator -> dtof_subsystem -> word_sender -> uart_transmitter -> tx_o
//                                              register_writer ------^
//
// Frames follow each other continuously. The serial line is slower than the array; the array stops while the line is busy.
// Clock: any; at 12 MHz and 12 CLOCKS_PER_BIT the line has 1 Mbaud.
// Latency: that of dtof_subsystem. Cost: the sum of the modules above.

// verilator lint_off TIMESCALEMOD
`default_nettype none

module demonstrator_core #(
    parameter int READOUT = dtof_pkg::READOUT_HISPOINTER,  // or READOUT_EZPOINTER, or READOUT_POOLPOINTER: lean
    parameter int NP = 10,
    parameter int COLUMNS = 8,
    parameter int ROWS = 8,
    parameter int ACQUISITIONS = 1000,
    parameter int CLOCKS_PER_BIT = 12,
    parameter int CLOCK_WAITS = 0,  // 1: the array's clock waits for late lines, which needs a clock gate and a smaller line buffer
    // The pool read-out's parameters are those of lean. Shares are in 64ths of a frame.
    parameter int GROUP_SIZE = 8,
    parameter int LABELS = 4,
    parameter int SCORE_BITS = 4,
    parameter int OFFSET_BITS = 0,
    parameter int ADVANTAGE_WIDTH = 4,
    parameter int POINTER_SHIFT = 4,
    parameter int RIVAL_MOVES = 0,
    parameter int COARSE_SHARE = 14,
    parameter int TRACK_SHARE = 20
) (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic rx_i,
    output logic tx_o,
    output logic frame_o  // toggles with every frame: for a light
);

  localparam int PIXELS = ROWS * COLUMNS;
  localparam int PIXEL_WIDTH = dtof_pkg::index_width(PIXELS);
  localparam int LINE_WIDTH = 8 * ((COLUMNS * NP + 7) / 8);

  // Targets from the serial line.

  logic received, target_write;
  logic [7:0] received_byte;
  logic [PIXEL_WIDTH-1:0] target_pixel;
  logic [NP-1:0] target_code;

  uart_receiver #(
      .CLOCKS_PER_BIT(CLOCKS_PER_BIT)
  ) u_receiver (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .rx_i   (rx_i),
      .valid_o(received),
      .data_o (received_byte)
  );

  target_command #(
      .NP    (NP),
      .PIXELS(PIXELS)
  ) u_command (
      .clk_i  (clk_i),
      .rst_ni (rst_ni),
      .valid_i(received),
      .data_i (received_byte),
      .write_o(target_write),
      .pixel_o(target_pixel),
      .code_o (target_code)
  );

  // Photons, registers, read-out.

  logic line_tvalid, line_tready, line_tlast, psel, penable, pready;
  logic [LINE_WIDTH-1:0] line_tdata;
  logic [11:0] paddr;
  logic [31:0] pwdata;

  photon_generator #(
      .NP     (NP),
      .COLUMNS(COLUMNS),
      .ROWS   (ROWS)
  ) u_photons (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .target_write_i (target_write),
      .target_pixel_i (target_pixel),
      .target_code_i  (target_code),
      .m_axis_tvalid_o(line_tvalid),
      .m_axis_tready_i(line_tready),
      .m_axis_tdata_o (line_tdata),
      .m_axis_tlast_o (line_tlast)
  );

  register_writer #(
      .HAS_SCHEDULE((READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 1 : 0),
      .ACQUISITIONS(ACQUISITIONS),
      .COARSE_SHARE(COARSE_SHARE),
      .TRACK_SHARE (TRACK_SHARE)
  ) u_software (
      .clk_i    (clk_i),
      .rst_ni   (rst_ni),
      .psel_o   (psel),
      .penable_o(penable),
      .paddr_o  (paddr),
      .pwdata_o (pwdata),
      .pready_i (pready)
  );

  logic result_tvalid, result_tready, result_tuser, result_tlast, pslverr, irq;
  logic [63:0] result_tdata;
  logic [31:0] prdata;
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] unused_sram_cfg;
  logic unused_shot;

  dtof_subsystem #(
      .READOUT        (READOUT),
      .NP             (NP),
      .SRAM_NUM       (COLUMNS),
      .PIXELS_PER_SRAM(ROWS),
      .SLOTS          (2),
      .GROUP_SIZE     (GROUP_SIZE),
      .LABELS         (LABELS),
      .SCORE_BITS     (SCORE_BITS),
      .OFFSET_BITS    (OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT  (POINTER_SHIFT),
      .RIVAL_MOVES    (RIVAL_MOVES),
      .COARSE_SHARE   (COARSE_SHARE),
      .TRACK_SHARE    (TRACK_SHARE),
      .CLOCK_WAITS    (CLOCK_WAITS)
  ) u_subsystem (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
      .scan_mode_i    (1'b0),
      .sram_cfg_i     ('0),
      .sram_cfg_o     (unused_sram_cfg),
      .psel_i         (psel),
      .penable_i      (penable),
      .pwrite_i       (1'b1),
      .paddr_i        (paddr),
      .pwdata_i       (pwdata),
      .pstrb_i        (4'hF),
      .pready_o       (pready),
      .prdata_o       (prdata),
      .pslverr_o      (pslverr),
      .irq_o          (irq),
      .shot_o         (unused_shot),  // the source does not need a shot
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

  logic unused_registers;
  assign unused_registers = ^{prdata, pslverr, irq};

  // Results to the serial line.

  logic byte_valid, byte_ready, frame_q;
  logic [7:0] byte_data;

  word_sender u_sender (
      .clk_i          (clk_i),
      .rst_ni         (rst_ni),
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
      .rst_ni (rst_ni),
      .valid_i(byte_valid),
      .ready_o(byte_ready),
      .data_i (byte_data),
      .tx_o   (tx_o)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      frame_q <= 1'b0;
    end else if (result_tvalid && result_tready && result_tlast) begin
      frame_q <= !frame_q;
    end
  end

  assign frame_o = frame_q;

endmodule

`default_nettype wire
