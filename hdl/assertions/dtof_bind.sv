// SPDX-License-Identifier: Apache-2.0
// Binds the assertions and covers of the protocols to every array, subsystem and two-clock FIFO of a simulation. dtof_assertions.f comes after dtof.f.

// verilator lint_off TIMESCALEMOD
`default_nettype none

bind dtof_subsystem dtof_stream_protocol #(.WIDTH(S_TDATA_WIDTH), .WHOSE("the source of lines")) u_line_protocol (
    .clk_i, .rst_ni, .tvalid_i(s_axis_tvalid_i), .tready_i(s_axis_tready_o), .tdata_i(s_axis_tdata_i), .tlast_i(s_axis_tlast_i)
);

bind dtof_subsystem dtof_stream_protocol #(.WIDTH(M_TDATA_WIDTH), .WHOSE("the subsystem")) u_result_protocol (
    .clk_i, .rst_ni, .tvalid_i(m_axis_tvalid_o), .tready_i(m_axis_tready_i), .tdata_i(m_axis_tdata_o), .tlast_i(m_axis_tlast_o)
);

bind dtof_subsystem dtof_apb_protocol u_register_protocol (
    .clk_i, .rst_ni, .psel_i, .penable_i, .pwrite_i, .paddr_i, .pwdata_i, .pstrb_i, .pready_i(pready_o), .pslverr_i(pslverr_o)
);

bind dtof_array dtof_array_protocol #(.LINES(PIXELS_PER_SRAM * SLOTS), .CFG_WIDTH(dtof_pkg::SRAM_CFG_WIDTH)) u_array_protocol (
    .clk_i, .rst_ni, .sram_cfg_i, .start_i, .busy_i(busy_o), .done_i(done_o), .tdc_valid_i, .tdc_ready_i(tdc_ready_o)
);

bind dtof_array dtof_stream_protocol #(.WIDTH(TDATA_WIDTH), .WHOSE("the array")) u_result_protocol (
    .clk_i, .rst_ni, .tvalid_i(result_tvalid_o), .tready_i(result_tready_i), .tdata_i(result_tdata_o), .tlast_i(result_tlast_o)
);

bind dtof_pool_pointer_array dtof_array_protocol #(.LINES(PIXELS_PER_SRAM * SLOTS), .CFG_WIDTH(dtof_pkg::SRAM_CFG_WIDTH)) u_array_protocol (
    .clk_i, .rst_ni, .sram_cfg_i, .start_i, .busy_i(busy_o), .done_i(done_o), .tdc_valid_i, .tdc_ready_i(tdc_ready_o)
);

bind dtof_pool_pointer_array dtof_stream_protocol #(.WIDTH(TDATA_WIDTH), .WHOSE("the array")) u_result_protocol (
    .clk_i, .rst_ni, .tvalid_i(result_tvalid_o), .tready_i(result_tready_i), .tdata_i(result_tdata_o), .tlast_i(result_tlast_o)
);

bind dtof_async_line_fifo dtof_reset_length #(.WHOSE("the TDC side")) u_tdc_reset (
    .clk_other_i(clk_i), .rst_ni(rst_tdc_ni)
);

bind dtof_async_line_fifo dtof_reset_length #(.WHOSE("the read-out side")) u_readout_reset (
    .clk_other_i(clk_tdc_i), .rst_ni
);

`default_nettype wire
