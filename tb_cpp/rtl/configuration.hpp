// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// A pixel's place in an array, and in the result stream.
struct ResultAddress {
  int row = 0;
  int column = 0;
  bool begins_row = false;  ///< the first result of a row (in an engine's turn)
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
  bool raw_histogram = false;        ///< RAW_HISTOGRAM: a frame may send histograms instead of results
  bool records_waveform = true;      ///< not a parameter: whether a waveform of the model can be written

  /// E.g. "ezpointer NP=10 SLOTS=2 ... PIXELS_PER_SRAM=160 SRAM_NUM=8".
  [[nodiscard]] std::string to_string() const;
  /// All pixels in the order of the result stream: row by row; with engines their columns in turn, each from
  /// the first row to the last, the engines interleaved.
  [[nodiscard]] std::vector<ResultAddress> result_order() const;
};

/// FSM state as `state_o` codes it (docs/reference/architecture.md, "States").
enum class RtlState : int { kIdle = 0, kReset = 1, kM0 = 2, kM1 = 3, kM2 = 4, kM3 = 5, kM4 = 6, kM5 = 7 };

inline constexpr std::size_t kRtlStateCount = 8;

/// Bits of error_o (hdl/common/dtof_array_errors.sv).
inline constexpr std::uint8_t kRtlUnderrun = 1;
inline constexpr std::uint8_t kRtlStartIgnored = 2;
inline constexpr std::uint8_t kRtlIllegalSchedule = 4;

/// IDLE, RESET, M0 .. M5.
std::string_view rtl_state_name(RtlState state);

}  // namespace dtof
