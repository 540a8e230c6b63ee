// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>

namespace dtof {

/// Bytes from the levels of a serial line: a start bit (0), eight bits from the lowest on, a stop bit (1).
class SerialReceiver {
 public:
  explicit SerialReceiver(int clocks_per_bit) : clocks_per_bit_(clocks_per_bit) {}

  /// The level of the next clock; a byte in the middle of its stop bit. Throws std::runtime_error if the line
  /// is 0 there.
  std::optional<std::uint8_t> clock(bool level);

 private:
  int clocks_per_bit_;
  int clock_ = 0;  // since the start bit began; 0: the line rests
  unsigned shift_ = 0;
};

/// Levels of a serial line that sends bytes.
class SerialSender {
 public:
  explicit SerialSender(int clocks_per_bit) : clocks_per_bit_(clocks_per_bit) {}

  void push(std::span<const std::uint8_t> bytes);
  [[nodiscard]] bool idle() const { return levels_.empty(); }
  /// The level of the next clock.
  bool clock();

 private:
  int clocks_per_bit_;
  int clock_ = 0;  // of the bit
  std::deque<bool> levels_;
};

}  // namespace dtof
