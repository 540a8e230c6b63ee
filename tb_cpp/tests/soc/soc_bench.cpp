// SPDX-License-Identifier: Apache-2.0
#include "tests/soc/soc_bench.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "rtl/error.hpp"
#include "rtl/write_coverage.hpp"

namespace dtof {
namespace {

constexpr int kClocksPerBit = 4;
constexpr int kTransferClocks = 100;
constexpr int kFrameClocks = 500000;
// word_sender.sv
constexpr unsigned kWordBytes = 9;
constexpr std::uint8_t kFirstByte = 0x80;
constexpr std::uint64_t kFirstWord = std::uint64_t{1} << 61U;
constexpr std::uint64_t kLastWord = std::uint64_t{1} << 62U;

bool read_bus(void* context, std::uint32_t address, std::uint32_t* value) {
  const SocBench::Response response = static_cast<SocBench*>(context)->read(address);
  *value = response.data;
  return !response.error;
}

bool write_bus(void* context, std::uint32_t address, std::uint32_t value) {
  return !static_cast<SocBench*>(context)->write(address, value).error;
}

bool wait_in_bench(void* context) { return static_cast<SocBench*>(context)->wait_for_interrupt(); }

}  // namespace

SocBench::SocBench(std::uint64_t seed) : receiver_(kClocksPerBit) {
  Verilated::threadContextp(&context_);
  context_.randReset(2);  // memories and registers without a reset start random
  context_.randSeed(static_cast<int>(seed % 0x7FFFFFFFU) + 1);
  const char* program = "soc";  // the RTL looks for +sram_report
  context_.commandArgs(1, &program);
  model_ = make_soc(context_);
  reset();
}

SocBench::~SocBench() {
  Verilated::threadContextp(&context_);
  write_coverage(context_);
}

soc_platform SocBench::platform() { return {this, read_bus, write_bus, wait_in_bench}; }

void SocBench::reset() {
  reset_n_ = false;
  clock(2);
  receiver_ = SerialReceiver(kClocksPerBit);
  word_ = 0;
  bytes_ = 0;
  words_.clear();
  frame_here_ = false;
  reset_n_ = true;
  clock(3);  // dtof_reset_synchroniser
}

void SocBench::clock(int count) {
  for (int i = 0; i < count; ++i) {
    clock(SocRequest{});
  }
}

void SocBench::clock(const SocRequest& request) {
  outputs_ = model_->clock(reset_n_, request);
  if (!reset_n_) {
    return;
  }
  if (const std::optional<std::uint8_t> byte = receiver_.clock(outputs_.tx)) {
    receive(*byte);
  }
}

SocBench::Response SocBench::transfer(SocRequest request) {
  for (int clocks = 1; clocks <= kTransferClocks; ++clocks) {
    clock(request);
    if (request.valid) {
      request.valid = !outputs_.request_ready;
    } else if (outputs_.response_valid) {
      return {outputs_.response_data, outputs_.response_error, static_cast<std::uint32_t>(clocks)};
    }
  }
  throw RtlError(fmt::format("the bus does not answer at address 0x{:08x}", request.address));
}

bool SocBench::wait_for_interrupt() {
  for (int i = 0; i < kFrameClocks; ++i) {
    if (outputs_.irq) {
      return true;
    }
    clock(1);
  }
  return false;
}

void SocBench::receive(std::uint8_t byte) {
  if (((byte & kFirstByte) != 0) != (bytes_ == 0)) {
    throw RtlError(fmt::format("serial line: byte {} of a word is {:#04x}", bytes_, byte));
  }
  word_ |= std::uint64_t{byte & 0x7FU} << (7U * bytes_);
  if (++bytes_ < kWordBytes) {
    return;
  }
  if (frame_here_ || ((word_ & kFirstWord) != 0) != words_.empty()) {
    throw RtlError(fmt::format("serial line: a frame begins or goes on at word {}", words_.size()));
  }
  words_.push_back(word_ & ~(kFirstWord | kLastWord));
  frame_here_ = (word_ & kLastWord) != 0;
  word_ = 0;
  bytes_ = 0;
}

std::vector<std::uint64_t> SocBench::receive_frame() {
  for (int i = 0; i < kFrameClocks && !frame_here_; ++i) {
    clock(1);
  }
  if (!frame_here_) {
    throw RtlError(fmt::format("no frame on the serial line in {} clocks", kFrameClocks));
  }
  frame_here_ = false;
  return std::exchange(words_, {});
}

}  // namespace dtof
