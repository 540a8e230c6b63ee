// SPDX-License-Identifier: Apache-2.0
#include "tests/demonstrator/serial_line.hpp"

#include <stdexcept>

namespace dtof {
namespace {

constexpr int kDataBits = 8;

}  // namespace

std::optional<std::uint8_t> SerialReceiver::clock(bool level) {
  if (clock_ == 0 && level) {
    return std::nullopt;
  }
  const int bit = clock_ / clocks_per_bit_;  // 0: the start bit
  const bool middle = clock_ % clocks_per_bit_ == clocks_per_bit_ / 2;
  ++clock_;
  if (!middle) {
    return std::nullopt;
  }
  if (bit == 0) {
    shift_ = 0;
    clock_ = level ? 0 : clock_;
    return std::nullopt;
  }
  if (bit <= kDataBits) {
    shift_ |= (level ? 1U : 0U) << static_cast<unsigned>(bit - 1);
    return std::nullopt;
  }
  clock_ = 0;
  if (!level) {
    throw std::runtime_error("the serial line has no stop bit");
  }
  return static_cast<std::uint8_t>(shift_);
}

void SerialSender::push(std::span<const std::uint8_t> bytes) {
  for (const unsigned byte : bytes) {
    levels_.push_back(false);
    for (unsigned bit = 0; bit < kDataBits; ++bit) {
      levels_.push_back(((byte >> bit) & 1U) != 0);
    }
    levels_.push_back(true);
  }
}

bool SerialSender::clock() {
  if (levels_.empty()) {
    return true;
  }
  const bool level = levels_.front();
  if (++clock_ == clocks_per_bit_) {
    clock_ = 0;
    levels_.pop_front();
  }
  return level;
}

}  // namespace dtof
