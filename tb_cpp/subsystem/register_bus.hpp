// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/core/random.hpp"
#include "subsystem/subsystem_model.hpp"

namespace dtof {

/// Response of a transfer.
struct BusResponse {
  std::uint32_t data = 0;  ///< data of a read transfer
  bool error = false;      ///< PSLVERR or SLVERR
};

/// Bus master for the registers, clock by clock: APB4, or AXI4-Lite with address, data and ready in any
/// order.
class RegisterBus {
 public:
  static constexpr std::uint8_t kAllBytes = 0xF;

  RegisterBus(const SubsystemModel::Ports& ports, CounterRandom random) : ports_(ports), random_(random) {}

  /// Begins a transfer. Only one can be under way.
  void read(std::uint32_t offset) { begin(false, offset, 0, 0); }
  void write(std::uint32_t offset, std::uint32_t data, std::uint8_t strobe) {
    begin(true, offset, data, strobe);
  }
  /// Drops a transfer that a reset interrupted.
  void reset() { busy_ = false; }
  [[nodiscard]] bool busy() const { return busy_; }
  [[nodiscard]] const BusResponse& response() const { return response_; }

  /// drive() sets the inputs of this clock; observe() evaluates the settled outputs. Throws RtlError if the
  /// port violates its protocol.
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
