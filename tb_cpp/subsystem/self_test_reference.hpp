// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"
#include "rtl/configuration.hpp"
#include "subsystem/stream_reference.hpp"

namespace dtof {

/// Lines of a self-test, one after the other (hdl/subsystem/dtof_self_test.sv).
class SelfTestLines {
 public:
  /// `seed`: value of SELF_TEST_SEED.
  SelfTestLines(const RtlConfiguration& configuration, std::uint32_t seed);

  /// The next line. The first line is that of acquisition 0, row 0, slot 0.
  Line next();

 private:
  int np_;
  std::size_t columns_;
  std::size_t rows_;
  std::size_t slots_;
  std::uint32_t state_;
  std::uint32_t row_code_ = 0;
  std::size_t row_ = 0;
  std::size_t slot_ = 0;
};

/// Streams of all columns in a self-test of `acquisitions`.
std::vector<ColumnStream> self_test_streams(const RtlConfiguration& configuration, std::uint32_t acquisitions,
                                            std::uint32_t seed);

/// CRC-32 of a self-test's words, for SELF_TEST_EXPECTED, with the settings of dtof_default_settings: all
/// columns are enabled, no result is weak, and TEMPLATE is 0. `raster_order`: the parameter RASTER_ORDER.
std::uint32_t self_test_signature(const RtlConfiguration& configuration, bool raster_order,
                                  std::uint32_t acquisitions, std::uint32_t seed);

}  // namespace dtof
