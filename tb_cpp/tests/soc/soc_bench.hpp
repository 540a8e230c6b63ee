// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <verilated.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "software.h"
#include "tests/demonstrator/serial_line.hpp"
#include "tests/soc/soc_model.hpp"

namespace dtof {

/// Environment of the SoC: clock, the processor's bus and interrupt, and the receiver of the serial line.
/// Every access of the software takes its clocks, and the receiver samples the line in each of them. Throws
/// RtlError if the SoC does not answer.
class SocBench {
 public:
  struct Response {
    std::uint32_t data = 0;
    bool error = false;
    std::uint32_t clocks = 0;  ///< clocks since the request
  };

  explicit SocBench(std::uint64_t seed);
  ~SocBench();
  SocBench(const SocBench&) = delete;
  SocBench& operator=(const SocBench&) = delete;
  SocBench(SocBench&&) = delete;
  SocBench& operator=(SocBench&&) = delete;

  /// Functions for the software; valid as long as the bench.
  [[nodiscard]] soc_platform platform();

  Response read(std::uint32_t address) { return transfer({.valid = true, .address = address}); }
  Response write(std::uint32_t address, std::uint32_t data, std::uint8_t strobe = 0xF) {
    return transfer({.valid = true, .write = true, .address = address, .data = data, .strobe = strobe});
  }
  [[nodiscard]] bool irq() const { return outputs_.irq; }
  bool wait_for_interrupt();
  void reset();
  void clock(int count);

  /// Words of the oldest frame received on the serial line and not yet returned.
  std::vector<std::uint64_t> receive_frame();

 private:
  Response transfer(SocRequest request);
  void clock(const SocRequest& request);
  void receive(std::uint8_t byte);

  VerilatedContext context_;
  std::unique_ptr<SocModel> model_;
  SocOutputs outputs_;
  bool reset_n_ = true;
  SerialReceiver receiver_;
  std::uint64_t word_ = 0;
  unsigned bytes_ = 0;  // bytes received of the current word
  std::vector<std::uint64_t> words_;
  bool frame_here_ = false;
};

}  // namespace dtof
