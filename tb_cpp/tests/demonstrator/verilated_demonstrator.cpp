// SPDX-License-Identifier: Apache-2.0
// Compiled together with what Verilator wrote (tests/demonstrator/CMakeLists.txt).
#include <Vdemonstrator.h>

#include "tests/demonstrator/demonstrator_model.hpp"

namespace dtof {
namespace {

class VerilatedDemonstrator : public DemonstratorModel {
 public:
  explicit VerilatedDemonstrator(VerilatedContext& context) : model_(&context, "demonstrator") {}

  bool clock(bool rx) override {
    model_.rx_i = rx ? 1 : 0;
    model_.clk_i = 0;
    model_.eval();
    model_.clk_i = 1;
    model_.eval();
    return model_.tx_o != 0;
  }
  [[nodiscard]] bool light() const override { return model_.frame_o != 0; }

 private:
  Vdemonstrator model_;
};

}  // namespace

std::unique_ptr<DemonstratorModel> make_demonstrator(VerilatedContext& context) {
  return std::make_unique<VerilatedDemonstrator>(context);
}

}  // namespace dtof
