// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <verilated.h>

#include <cstdint>

#include "subsystem/subsystem_model.hpp"

namespace dtof {

/// SubsystemModel over the class that Verilator generated for one configuration.
template <typename Model>
class VerilatedSubsystem : public SubsystemModel {
 public:
  explicit VerilatedSubsystem(VerilatedContext& context) : model_(&context, "subsystem") {}

  [[nodiscard]] Ports ports() override {
    return {.clock = &model_.clk_i,
            .reset_n = &model_.rst_ni,
            .axi_lite = &model_.axi_lite_o,
            .psel = &model_.psel_i,
            .penable = &model_.penable_i,
            .pwrite = &model_.pwrite_i,
            .paddr = &model_.paddr_i,
            .pwdata = &model_.pwdata_i,
            .pstrb = &model_.pstrb_i,
            .pready = &model_.pready_o,
            .prdata = &model_.prdata_o,
            .pslverr = &model_.pslverr_o,
            .awvalid = &model_.s_axi_awvalid_i,
            .awready = &model_.s_axi_awready_o,
            .awaddr = &model_.s_axi_awaddr_i,
            .wvalid = &model_.s_axi_wvalid_i,
            .wready = &model_.s_axi_wready_o,
            .wdata = &model_.s_axi_wdata_i,
            .wstrb = &model_.s_axi_wstrb_i,
            .bvalid = &model_.s_axi_bvalid_o,
            .bready = &model_.s_axi_bready_i,
            .bresp = &model_.s_axi_bresp_o,
            .arvalid = &model_.s_axi_arvalid_i,
            .arready = &model_.s_axi_arready_o,
            .araddr = &model_.s_axi_araddr_i,
            .rvalid = &model_.s_axi_rvalid_o,
            .rready = &model_.s_axi_rready_i,
            .rdata = &model_.s_axi_rdata_o,
            .rresp = &model_.s_axi_rresp_o,
            .irq = &model_.irq_o,
            .shot = &model_.shot_o,
            .line_valid = &model_.s_axis_tvalid_i,
            .line_ready = &model_.s_axis_tready_o,
            .line_data = model_.s_axis_tdata_i.data(),
            .line_words = sizeof(model_.s_axis_tdata_i) / sizeof(std::uint32_t),
            .line_last = &model_.s_axis_tlast_i,
            .result_valid = &model_.m_axis_tvalid_o,
            .result_ready = &model_.m_axis_tready_i,
            .result_data = &model_.m_axis_tdata_o,
            .result_first = &model_.m_axis_tuser_o,
            .result_last = &model_.m_axis_tlast_o,
            .begin = &model_.probe_begin_o,
            .done = &model_.probe_done_o,
            .abort = &model_.probe_abort_o,
            .flush = &model_.probe_flush_o,
            .watchdog = &model_.probe_watchdog_o,
            .commit = &model_.probe_commit_o,
            .reseed = &model_.probe_reseed_o,
            .line_waits = &model_.probe_waits_o,
            .array_valid = &model_.probe_array_valid_o,
            .dropped = &model_.probe_dropped_o,
            .array_line_valid = &model_.probe_line_valid_o,
            .array_line_ready = &model_.probe_line_ready_o,
            .test_begin = &model_.probe_test_begin_o,
            .test_frame = &model_.probe_test_frame_o,
            .test_take = &model_.probe_test_take_o,
            .running = &model_.probe_running_o,
            .array_line = model_.probe_line_o.data()};
  }

  void eval() override { model_.eval(); }

 private:
  Model model_;
};

}  // namespace dtof
