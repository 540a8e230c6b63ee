// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <verilated.h>

#include <cstdint>

#include "rtl/array_model.hpp"

namespace dtof {

/// ArrayModel for the class that Verilator generated for one configuration, without waveforms (with
/// waveforms: waveform_array.hpp).
template <typename Model>
class VerilatedArray : public ArrayModel {
 public:
  explicit VerilatedArray(VerilatedContext& context) : model_(&context, "array") {}
  ~VerilatedArray() override = default;
  VerilatedArray(const VerilatedArray&) = delete;
  VerilatedArray& operator=(const VerilatedArray&) = delete;
  VerilatedArray(VerilatedArray&&) = delete;
  VerilatedArray& operator=(VerilatedArray&&) = delete;

  [[nodiscard]] Ports ports() override {
    Registers registers;
    const std::uint16_t* second = nullptr;
    const std::uint16_t* amplitude = nullptr;
    const std::uint16_t* ambient = nullptr;
    if constexpr (requires { model_.result_second_o; }) {
      second = &model_.result_second_o;
      amplitude = &model_.result_amplitude_o;
      ambient = &model_.result_ambient_o;
    }
    const std::uint8_t* counter_full = nullptr;
    if constexpr (requires { model_.counter_full_o; }) {
      counter_full = &model_.counter_full_o;
    }
    if constexpr (requires { model_.coarse_end_i; }) {
      registers = {.coarse_end = &model_.coarse_end_i,
                   .track_end = &model_.track_end_i,
                   .smooth = &model_.smooth_i,
                   .prior = &model_.prior_i,
                   .coarse_template = model_.template_i.data()};
    } else {
      registers = {.raw = &model_.raw_i,
                   .raw_first_row = &model_.raw_first_row_i,
                   .raw_last_row = &model_.raw_last_row_i};
    }
    return {.clock = &model_.clk_i,
            .reset_n = &model_.rst_ni,
            .start = &model_.start_i,
            .acquisitions = &model_.acq_num_i,
            .gate_begin = &model_.gate_begin_i,
            .gate_end = &model_.gate_end_i,
            .raw = registers.raw,
            .raw_first_row = registers.raw_first_row,
            .raw_last_row = registers.raw_last_row,
            .coarse_end = registers.coarse_end,
            .track_end = registers.track_end,
            .smooth = registers.smooth,
            .prior = registers.prior,
            .coarse_template = registers.coarse_template,
            .tdc_valid = &model_.tdc_valid_i,
            .timestamps = model_.tdc_timestamp_i.data(),
            .timestamp_words = sizeof(model_.tdc_timestamp_i) / sizeof(std::uint32_t),
            .result_ready = &model_.result_tready_i,
            .busy = &model_.busy_o,
            .done = &model_.done_o,
            .state = &model_.state_o,
            .error = &model_.error_o,
            .counter_full = counter_full,
            .parity_error = &model_.parity_error_o,
            .tdc_ready = &model_.tdc_ready_o,
            .result_valid = &model_.result_tvalid_o,
            .result_last = &model_.result_tlast_o,
            .result_column = &model_.result_column_o,
            .result_row = &model_.result_row_o,
            .result_code = &model_.result_code_o,
            .result_fraction = &model_.result_fraction_o,
            .result_confidence = &model_.result_confidence_o,
            .result_second = second,
            .result_amplitude = amplitude,
            .result_ambient = ambient,
            .probe_write = &model_.probe_write_o,
            .probe_address = &model_.probe_address_o,
            .probe_data = &model_.probe_data_o};
  }

  void eval() override { model_.eval(); }

 protected:
  [[nodiscard]] Model& model() { return model_; }

 private:
  // Registers that only some arrays have.
  struct Registers {
    std::uint8_t* raw = nullptr;
    std::uint16_t* raw_first_row = nullptr;
    std::uint16_t* raw_last_row = nullptr;
    std::uint16_t* coarse_end = nullptr;
    std::uint16_t* track_end = nullptr;
    std::uint8_t* smooth = nullptr;
    std::uint8_t* prior = nullptr;
    std::uint32_t* coarse_template = nullptr;
  };

  Model model_;
};

}  // namespace dtof
