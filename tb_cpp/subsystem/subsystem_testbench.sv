// SPDX-License-Identifier: Apache-2.0

`include "dtof_macros.svh"

/// dtof_subsystem behind ports whose C++ types are the same for every configuration: at least 512 bits of lines, APB4 or, with
/// AXI_LITE = 1, AXI4-Lite. The probes show what the array takes, and when its frames begin and end.
module subsystem_testbench #(
    parameter READOUT = 0,
    parameter AXI_LITE = 0,
    // parameters of the arrays: written by scripts/generate.py from readouts.toml
    // verilator lint_off UNUSEDPARAM
    parameter int NP = 10,                        // bits of a TDC timestamp
    // bits of the coarse histogram index
    parameter int NB = (READOUT == dtof_pkg::READOUT_SIFH) ? (NP / 2) + 1
        : (READOUT == dtof_pkg::READOUT_PIFH) ? dtof_pkg::min_of(NP, 6)
        : (READOUT == dtof_pkg::READOUT_HISTOGRAM) ? NP
        : (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(NP, 5)
        : NP / 2,
    parameter int PIXELS_PER_SRAM = 160,          // pixels a column serves
    parameter int SRAM_NUM = 200,                 // columns working in parallel
    parameter int SLOTS = 2,                      // timestamps per pixel and acquisition
    // bits of a histogram bin's counter, which never wraps
    parameter int COUNT_WIDTH = (READOUT == dtof_pkg::READOUT_POOLPOINTER) ? 7
        : 10,
    parameter int POINTER_STEP = 1,               // bins a pointer moves per timestamp
    // fractional bits of the pointer
    parameter int FRACTION_BITS = (READOUT == dtof_pkg::READOUT_COARSEHISTOGRAM) ? dtof_pkg::min_of(2, (16 - NP))
        : 0,
    parameter int CONFIDENCE_WIDTH = 4,           // bits of a pointer's confidence, 0 for none
    parameter int GUARD = ((2 << NP) + 44) / 45,  // hisPointer: codes by which the window is wider than half a coarse bin on either side; default: a FWHM of 2 ns in a range of 45 ns
    parameter int WINDOW_CENTRED = 0,             // SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5
    parameter int POINTER_PORTS = 2,              // ports of the pointer SRAM; with 1 its cells have half the area
    parameter int SIGNALLED_CLEAR = 0,            // 1: one status bit for each address instead of clearing the SRAM
    parameter int PARITY = 0,                     // 1: each word of the SRAMs has a parity bit, which is checked at each read
    parameter int TIME_GATE = 0,                  // 1: only timestamps from `gate_begin_i` to below `gate_end_i` count
    parameter int RAW_HISTOGRAM = 0,              // 1: a frame may send histograms instead of results (`raw_i`)
    parameter int ACQ_WIDTH = 16,                 // bits of the run-time number of acquisitions
    parameter int BROADCAST_STAGES = 2,           // registers between the control and the columns; they add delay and change no result
    parameter int GROUP_SIZE = 4,                 // rows of a group, which shares a coarse histogram
    parameter int LABELS = 5,                     // candidates of a group
    parameter int SCORE_BITS = 4,                 // bits of a candidate's score
    parameter int OFFSET_BITS = 6,                // bits of a leader's offset in the track phase, 0 for none
    parameter int ADVANTAGE_WIDTH = 7,            // bits of the leader's advantage
    parameter int POINTER_SHIFT = 1,              // a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins
    parameter int RIVAL_MOVES = 1,                // 1: the rival has a pointer of its own
    parameter int CELL_SHIFT = 9,                 // windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25
    parameter int SECOND_TARGET = 0,              // 1: a result has the position of the label that lost, too
    parameter int AMPLITUDE = 0,                  // 1: a result has amplitude and ambient, too
    parameter int PRIOR = 0,                      // 1: candidates may begin from those that were used in the last frame (`prior_i`)
    parameter int ENGINE_COLUMNS = 34,            // columns that share an engine
    parameter int COARSE_SHARE = 14,              // 64ths of a frame that the coarse phase is recommended to take
    parameter int TRACK_SHARE = 30,               // 64ths of a frame that the track phase is recommended to take
    // verilator lint_on UNUSEDPARAM
    // end of parameters of the arrays
    parameter CLOCK_WAITS = 1,
    parameter SOURCE_WAITS = 1,
    parameter BUFFER_LINES = 0,  // 0: the subsystem's default
    parameter RASTER_ORDER = 0,
    parameter SELF_TEST = 0,
    localparam BUS_WIDTH = SRAM_NUM * NP > 512 ? SRAM_NUM * NP : 512
) (
    input  logic         clk_i,
    input  logic         rst_ni,
    output logic         axi_lite_o,
    input  logic         psel_i,
    input  logic         penable_i,
    input  logic         pwrite_i,
    input  logic [ 15:0] paddr_i,
    input  logic [ 31:0] pwdata_i,
    input  logic [  7:0] pstrb_i,
    output logic         pready_o,
    output logic [ 31:0] prdata_o,
    output logic         pslverr_o,
    input  logic         s_axi_awvalid_i,
    output logic         s_axi_awready_o,
    input  logic [ 15:0] s_axi_awaddr_i,
    input  logic         s_axi_wvalid_i,
    output logic         s_axi_wready_o,
    input  logic [ 31:0] s_axi_wdata_i,
    input  logic [  7:0] s_axi_wstrb_i,
    output logic         s_axi_bvalid_o,
    input  logic         s_axi_bready_i,
    output logic [  1:0] s_axi_bresp_o,
    input  logic         s_axi_arvalid_i,
    output logic         s_axi_arready_o,
    input  logic [ 15:0] s_axi_araddr_i,
    output logic         s_axi_rvalid_o,
    input  logic         s_axi_rready_i,
    output logic [ 31:0] s_axi_rdata_o,
    output logic [  1:0] s_axi_rresp_o,
    output logic         irq_o,
    output logic         shot_o,
    input  logic         s_axis_tvalid_i,
    output logic         s_axis_tready_o,
    input  logic [BUS_WIDTH-1:0] s_axis_tdata_i,
    input  logic         s_axis_tlast_i,
    output logic         m_axis_tvalid_o,
    input  logic         m_axis_tready_i,
    output logic [ 63:0] m_axis_tdata_o,
    output logic         m_axis_tuser_o,
    output logic         m_axis_tlast_o,
    output logic         probe_begin_o,
    output logic         probe_done_o,
    output logic         probe_abort_o,
    output logic         probe_flush_o,
    output logic [ 31:0] probe_watchdog_o,
    output logic         probe_commit_o,
    output logic         probe_reseed_o,
    output logic         probe_waits_o,
    output logic         probe_array_valid_o,
    output logic         probe_dropped_o,
    output logic         probe_line_valid_o,
    output logic         probe_line_ready_o,
    output logic         probe_test_begin_o,
    output logic         probe_test_frame_o,
    output logic         probe_test_take_o,
    output logic         probe_running_o,
    output logic [BUS_WIDTH-1:0] probe_line_o
);

  localparam LINES = BUFFER_LINES != 0 ? BUFFER_LINES : CLOCK_WAITS == 0 ? PIXELS_PER_SRAM * SLOTS + 4
      : dtof_pkg::max_of(SLOTS, 2);
  localparam S_TDATA_WIDTH = 8 * ((SRAM_NUM * NP + 7) / 8);

  logic psel, penable, pwrite, pready, pslverr;
  logic [11:0] paddr;
  logic [31:0] pwdata, prdata;
  logic [3:0] pstrb;

  if (AXI_LITE != 0) begin : gen_axi_lite
    dtof_axi_lite_to_apb u_axi_lite_to_apb (
        .clk_i,
        .rst_ni,
        .s_axi_awvalid_i,
        .s_axi_awready_o,
        .s_axi_awaddr_i(s_axi_awaddr_i[11:0]),
        .s_axi_wvalid_i,
        .s_axi_wready_o,
        .s_axi_wdata_i,
        .s_axi_wstrb_i(s_axi_wstrb_i[3:0]),
        .s_axi_bvalid_o,
        .s_axi_bready_i,
        .s_axi_bresp_o,
        .s_axi_arvalid_i,
        .s_axi_arready_o,
        .s_axi_araddr_i(s_axi_araddr_i[11:0]),
        .s_axi_rvalid_o,
        .s_axi_rready_i,
        .s_axi_rdata_o,
        .s_axi_rresp_o,
        .psel_o(psel),
        .penable_o(penable),
        .pwrite_o(pwrite),
        .paddr_o(paddr),
        .pwdata_o(pwdata),
        .pstrb_o(pstrb),
        .pready_i(pready),
        .prdata_i(prdata),
        .pslverr_i(pslverr)
    );
    assign {pready_o, prdata_o, pslverr_o} = '0;
  end else begin : gen_apb
    assign {psel, penable, pwrite} = {psel_i, penable_i, pwrite_i};
    assign {paddr, pwdata, pstrb} = {paddr_i[11:0], pwdata_i, pstrb_i[3:0]};
    assign {pready_o, prdata_o, pslverr_o} = {pready, prdata, pslverr};
    assign {s_axi_awready_o, s_axi_wready_o, s_axi_bvalid_o, s_axi_bresp_o} = '0;
    assign {s_axi_arready_o, s_axi_rvalid_o, s_axi_rdata_o, s_axi_rresp_o} = '0;
  end

  // The port that is not used, and the upper bits of the one that is.
  logic unused;
  assign unused = &{1'b0, psel_i, penable_i, pwrite_i, paddr_i, pwdata_i, pstrb_i, s_axi_awvalid_i, s_axi_awaddr_i,
                    s_axi_wvalid_i, s_axi_wdata_i, s_axi_wstrb_i, s_axi_bready_i, s_axi_arvalid_i, s_axi_araddr_i,
                    s_axi_rready_i, s_axis_tdata_i};
  logic [dtof_pkg::SRAM_CFG_WIDTH-1:0] sram_cfg, sram_cfg_answer;

  dtof_subsystem #(
      .READOUT(READOUT),
      .CLOCK_WAITS(CLOCK_WAITS),
      .SOURCE_WAITS(SOURCE_WAITS),
      .BUFFER_LINES(LINES),
      .RASTER_ORDER(RASTER_ORDER),
      .SELF_TEST(SELF_TEST),
      // parameters of dtof_subsystem: written by scripts/generate.py from readouts.toml
      .NP(NP),
      .NB(NB),
      .PIXELS_PER_SRAM(PIXELS_PER_SRAM),
      .SRAM_NUM(SRAM_NUM),
      .SLOTS(SLOTS),
      .COUNT_WIDTH(COUNT_WIDTH),
      .POINTER_STEP(POINTER_STEP),
      .FRACTION_BITS(FRACTION_BITS),
      .CONFIDENCE_WIDTH(CONFIDENCE_WIDTH),
      .GUARD(GUARD),
      .WINDOW_CENTRED(WINDOW_CENTRED),
      .POINTER_PORTS(POINTER_PORTS),
      .SIGNALLED_CLEAR(SIGNALLED_CLEAR),
      .PARITY(PARITY),
      .TIME_GATE(TIME_GATE),
      .RAW_HISTOGRAM(RAW_HISTOGRAM),
      .ACQ_WIDTH(ACQ_WIDTH),
      .BROADCAST_STAGES(BROADCAST_STAGES),
      .GROUP_SIZE(GROUP_SIZE),
      .LABELS(LABELS),
      .SCORE_BITS(SCORE_BITS),
      .OFFSET_BITS(OFFSET_BITS),
      .ADVANTAGE_WIDTH(ADVANTAGE_WIDTH),
      .POINTER_SHIFT(POINTER_SHIFT),
      .RIVAL_MOVES(RIVAL_MOVES),
      .CELL_SHIFT(CELL_SHIFT),
      .SECOND_TARGET(SECOND_TARGET),
      .AMPLITUDE(AMPLITUDE),
      .PRIOR(PRIOR),
      .ENGINE_COLUMNS(ENGINE_COLUMNS),
      .COARSE_SHARE(COARSE_SHARE),
      .TRACK_SHARE(TRACK_SHARE)
      // end of parameters of dtof_subsystem
  ) u_subsystem (
      .clk_i,
      .rst_ni,
      .scan_mode_i(1'b0),
      .sram_cfg_i(sram_cfg),
      .sram_cfg_o(sram_cfg_answer),
      .psel_i(psel),
      .penable_i(penable),
      .pwrite_i(pwrite),
      .paddr_i(paddr),
      .pwdata_i(pwdata),
      .pstrb_i(pstrb),
      .pready_o(pready),
      .prdata_o(prdata),
      .pslverr_o(pslverr),
      .irq_o,
      .shot_o,
      .s_axis_tvalid_i,
      .s_axis_tready_o,
      .s_axis_tdata_i(s_axis_tdata_i[S_TDATA_WIDTH-1:0]),
      .s_axis_tlast_i,
      .m_axis_tvalid_o,
      .m_axis_tready_i,
      .m_axis_tdata_o,
      .m_axis_tuser_o,
      .m_axis_tlast_o
  );

  assign axi_lite_o = (AXI_LITE != 0);
  assign probe_begin_o = u_subsystem.begin_frame;
  assign probe_done_o = u_subsystem.done;
  assign probe_abort_o = u_subsystem.abort;
  assign probe_flush_o = u_subsystem.flushes;
  assign probe_watchdog_o = 32'(u_subsystem.watchdog);
  assign probe_commit_o = u_subsystem.u_registers.commit;
  assign probe_reseed_o = u_subsystem.shot_reseed;
  assign probe_waits_o = u_subsystem.u_line_path.line_waits;
  assign probe_array_valid_o = u_subsystem.array_valid;
  assign probe_dropped_o = u_subsystem.dropped;
  assign probe_line_valid_o = u_subsystem.u_line_path.buffer_valid;
  assign probe_line_ready_o = u_subsystem.u_line_path.buffer_ready;
  assign probe_test_begin_o = u_subsystem.begin_frame && u_subsystem.test_chosen;
  assign probe_test_frame_o = u_subsystem.test_frame;
  assign probe_running_o = u_subsystem.running;
  assign probe_test_take_o = u_subsystem.test_frame && u_subsystem.array_valid && u_subsystem.array_ready;
  assign probe_line_o = BUS_WIDTH'(u_subsystem.u_line_path.array_line);

  // Every SRAM's side band: the stand-ins answer what they are told, which is another value in every frame.
  always_ff @(posedge clk_i) begin
    if (probe_begin_o) begin
      sram_cfg <= ~sram_cfg;
    end
  end
  `DTOF_ASSERT(a_side_band, sram_cfg_answer == sram_cfg, "an SRAM does not hear its side band")

  // After rst_ni the array's clock has eight edges, in which data from before leave pipelines that have no reset, and then three edges fewer than
  // clk_i: so the release of the array's reset has four periods (constraints/subsystem/dtof_subsystem.sdc). Without a gate it has all edges.
  logic [3:0] clocks, array_clocks;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      clocks <= '0;
    end else if (clocks != '1) begin
      clocks <= clocks + 1'b1;
    end
  end
  always_ff @(posedge u_subsystem.u_gated_array.array_clk or negedge rst_ni) begin
    if (!rst_ni) begin
      array_clocks <= '0;
    end else if (array_clocks != '1) begin
      array_clocks <= array_clocks + 1'b1;
    end
  end
  `DTOF_ASSERT(a_eight_edges_in_reset, clocks != 4'd8 || array_clocks == 4'd8, "the array's clock stands still in a reset")
  `DTOF_ASSERT(a_release_has_four_periods, CLOCK_WAITS == 0 || clocks != 4'd11 || array_clocks == 4'd8,
               "the array's clock has an edge in the three clocks after the release of its reset")

endmodule
