// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// Address of a pixel in the array, and its position in the result stream.
struct ResultAddress {
  int row = 0;
  int column = 0;
  bool begins_row = false;  ///< first result of a row (with engines: of a row in an engine's turn)
};

/// Parameters of one compiled array: dtof_pool_pointer_array for the pool read-outs, dtof_array for the
/// others.
struct RtlConfiguration {
  ReadoutParameters
      parameters;  ///< a pool read-out's shares and S1 are not compiled: the driver writes these registers
  int pixels_per_sram = kArrayRows;  ///< PIXELS_PER_SRAM, rows of a column
  int sram_num = 8;                  ///< SRAM_NUM, columns
  int pointer_ports = 2;             ///< POINTER_PORTS, 1 or 2 (pointer read-outs)
  bool signalled_clear = false;      ///< SIGNALLED_CLEAR (histogram read-outs)
  bool parity = false;               ///< PARITY: an array that finds a damaged word ends the simulation
  bool raw_histogram = false;        ///< RAW_HISTOGRAM: a frame may send histograms instead of results
  bool records_waveform = true;      ///< not a parameter: the model can write waveforms

  /// Text, e.g. "ezpointer NP=10 SLOTS=2 ... PIXELS_PER_SRAM=160 SRAM_NUM=8".
  [[nodiscard]] std::string to_string() const;
  /// All pixels in the order of the result stream. Without engines: row by row. With engines: an engine sends
  /// its columns in turn, each from the first row to the last; results of the engines are interleaved.
  [[nodiscard]] std::vector<ResultAddress> result_order() const;
};

/// State of the FSM as coded in `state_o` (docs/reference/architecture.md, "States").
enum class RtlState : int { kIdle = 0, kReset = 1, kM0 = 2, kM1 = 3, kM2 = 4, kM3 = 5, kM4 = 6, kM5 = 7 };

inline constexpr std::size_t kRtlStateCount = 8;

/// Bits of error_o (hdl/common/dtof_array_errors.sv).
inline constexpr std::uint8_t kRtlUnderrun = 1;
inline constexpr std::uint8_t kRtlStartIgnored = 2;
inline constexpr std::uint8_t kRtlIllegalSchedule = 4;

/// Name of a state: IDLE, RESET, M0 .. M5.
std::string_view rtl_state_name(RtlState state);

}  // namespace dtof
