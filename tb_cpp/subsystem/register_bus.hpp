// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/core/random.hpp"
#include "subsystem/subsystem_model.hpp"

namespace dtof {

/// What a transfer came back with.
struct BusResponse {
  std::uint32_t data = 0;  ///< of a read
  bool error = false;      ///< PSLVERR or SLVERR
};

/// Master of the registers' port, clock by clock: APB4, or AXI4-Lite whose address, data and ready come in
/// any order.
class RegisterBus {
 public:
  static constexpr std::uint8_t kAllBytes = 0xF;

  RegisterBus(const SubsystemModel::Ports& ports, CounterRandom random) : ports_(ports), random_(random) {}

  /// Begins a transfer; one at a time.
  void read(std::uint32_t offset) { begin(false, offset, 0, 0); }
  void write(std::uint32_t offset, std::uint32_t data, std::uint8_t strobe) {
    begin(true, offset, data, strobe);
  }
  /// Forgets a transfer that a reset cut off.
  void reset() { busy_ = false; }
  [[nodiscard]] bool busy() const { return busy_; }
  [[nodiscard]] const BusResponse& response() const { return response_; }

  /// Inputs of this clock; then, with the outputs settled, what they say. Throws RtlError if the port breaks
  /// its protocol.
  void drive();
  void observe();

 private:
  void begin(bool write, std::uint32_t offset, std::uint32_t data, std::uint8_t strobe);
  void drive_apb();
  void drive_axi();
  void observe_apb();
  void observe_axi();
  void end(std::uint32_t data, bool error);

  SubsystemModel::Ports ports_;
  CounterRandom random_;
  bool busy_ = false;
  bool write_ = false;
  std::uint16_t offset_ = 0;
  std::uint32_t data_ = 0;
  std::uint8_t strobe_ = 0;
  BusResponse response_;
  bool access_ = false;         // APB's second clock
  bool address_taken_ = false;  // AXI
  bool data_taken_ = false;
  bool address_offered_ = false;
  bool data_offered_ = false;
};

}  // namespace dtof
