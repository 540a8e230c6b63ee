// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "dtof/core/readout.hpp"

class VerilatedContext;

namespace dtof {

/// The Verilated demonstrator of the FPGA or of the shuttle chip, from RTL or from a netlist.
class DemonstratorModel {
 public:
  DemonstratorModel() = default;
  DemonstratorModel(const DemonstratorModel&) = delete;
  DemonstratorModel& operator=(const DemonstratorModel&) = delete;
  DemonstratorModel(DemonstratorModel&&) = delete;
  DemonstratorModel& operator=(DemonstratorModel&&) = delete;
  virtual ~DemonstratorModel() = default;

  [[nodiscard]] virtual Readout readout() const = 0;
  [[nodiscard]] virtual int columns() const = 0;
  [[nodiscard]] virtual int rows() const = 0;
  [[nodiscard]] virtual int clocks_per_bit() const = 0;
  /// Runs one clock with level `rx` at the serial input; returns the level of the serial output.
  [[nodiscard]] virtual bool clock(bool rx) = 0;
  /// Level of the light output, which changes with every frame.
  [[nodiscard]] virtual bool light() const = 0;
};

std::unique_ptr<DemonstratorModel> make_demonstrator(VerilatedContext& context);

}  // namespace dtof
