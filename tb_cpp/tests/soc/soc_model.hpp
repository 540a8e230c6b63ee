// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

class VerilatedContext;

namespace dtof {

/// A bus request of the processor.
struct SocRequest {
  bool valid = false;
  bool write = false;
  std::uint32_t address = 0;
  std::uint32_t data = 0;
  std::uint8_t strobe = 0;
};

/// Outputs of the SoC, as the next rising edge samples them.
struct SocOutputs {
  bool request_ready = false;
  bool response_valid = false;
  bool response_error = false;
  std::uint32_t response_data = 0;
  bool irq = false;
  bool tx = true;
};

/// The Verilated SoC.
class SocModel {
 public:
  SocModel() = default;
  SocModel(const SocModel&) = delete;
  SocModel& operator=(const SocModel&) = delete;
  SocModel(SocModel&&) = delete;
  SocModel& operator=(SocModel&&) = delete;
  virtual ~SocModel() = default;

  /// Runs one clock.
  [[nodiscard]] virtual SocOutputs clock(bool reset_n, const SocRequest& request) = 0;
};

std::unique_ptr<SocModel> make_soc(VerilatedContext& context);

}  // namespace dtof
