// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace dtof {

/// A Verilated testbench of an array, behind a common interface: pointers to its ports, and eval().
class ArrayModel {
 public:
  /// Pointers to the model's ports. Write inputs before eval() and read outputs after it.
  struct Ports {
    std::uint8_t* clock;
    std::uint8_t* reset_n;
    std::uint8_t* start;
    std::uint16_t* acquisitions;
    std::uint16_t* gate_begin;
    std::uint16_t* gate_end;
    std::uint8_t* raw;  ///< raw and the next two: dtof_array only
    std::uint16_t* raw_first_row;
    std::uint16_t* raw_last_row;
    std::uint16_t* coarse_end;  ///< schedule; this and the next are null in dtof_array
    std::uint16_t* track_end;
    std::uint8_t* smooth;
    std::uint8_t* prior;
    std::uint32_t* coarse_template;  ///< 8 words, entry 0 in the lowest byte of word 0
    std::uint8_t* tdc_valid;
    std::uint32_t* timestamps;  ///< 16 bits per column, column 0 in the low half of word 0
    std::size_t timestamp_words;
    std::uint8_t* result_ready;

    const std::uint8_t* busy;
    const std::uint8_t* done;
    const std::uint8_t* state;
    const std::uint8_t* error;         ///< kRtlUnderrun and so on
    const std::uint8_t* counter_full;  ///< dtof_array only, else null
    const std::uint8_t* parity_error;
    const std::uint8_t* tdc_ready;
    const std::uint8_t* result_valid;
    const std::uint8_t* result_last;
    const std::uint16_t* result_column;
    const std::uint16_t* result_row;
    const std::uint16_t* result_code;
    const std::uint16_t* result_fraction;
    const std::uint16_t* result_confidence;
    const std::uint16_t* result_second;  ///< this and the next two: dtof_pool_pointer_array only, else null
    const std::uint16_t* result_amplitude;
    const std::uint16_t* result_ambient;

    const std::uint8_t*
        probe_write;  ///< write enable of column 0's histogram or pointer SRAM; 0 unless built with PROBE
    const std::uint16_t* probe_address;
    const std::uint16_t* probe_data;
  };

  ArrayModel() = default;
  ArrayModel(const ArrayModel&) = delete;
  ArrayModel& operator=(const ArrayModel&) = delete;
  ArrayModel(ArrayModel&&) = delete;
  ArrayModel& operator=(ArrayModel&&) = delete;
  virtual ~ArrayModel() = default;

  [[nodiscard]] virtual Ports ports() = 0;
  virtual void eval() = 0;
  /// Begins a waveform (FST) of all signals. Throws InputError if the file cannot be written, or if the model
  /// was built without waveforms (the default of these three functions).
  virtual void open_trace(const std::filesystem::path& file);
  /// Writes the signals' values at `time` (ns).
  virtual void dump_trace(std::uint64_t time);
  virtual void close_trace();
};

}  // namespace dtof
