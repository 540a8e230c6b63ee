// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>

namespace dtof {

/// Decodes bytes from the levels of a serial line: a start bit (0), eight bits from the lowest to the
/// highest, a stop bit (1).
class SerialReceiver {
 public:
  explicit SerialReceiver(int clocks_per_bit) : clocks_per_bit_(clocks_per_bit) {}

  /// Processes the level of the next clock. Returns a byte in the middle of its stop bit. Throws
  /// std::runtime_error if the stop bit is 0.
  std::optional<std::uint8_t> clock(bool level);

 private:
  int clocks_per_bit_;
  int clock_ = 0;  // since the start bit began; 0: the line is idle
  unsigned shift_ = 0;
};

/// Produces the levels of a serial line that sends bytes.
class SerialSender {
 public:
  explicit SerialSender(int clocks_per_bit) : clocks_per_bit_(clocks_per_bit) {}

  void push(std::span<const std::uint8_t> bytes);
  [[nodiscard]] bool idle() const { return levels_.empty(); }
  /// Returns the level of the next clock.
  bool clock();

 private:
  int clocks_per_bit_;
  int clock_ = 0;  // clock within the bit
  std::deque<bool> levels_;
};

}  // namespace dtof
