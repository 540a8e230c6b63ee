// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace dtof {

/// A Verilated subsystem_testbench behind a common interface: pointers to its ports, and eval().
class SubsystemModel {
 public:
  /// Pointers to the model's ports. Write inputs before eval() and read outputs after it.
  struct Ports {
    std::uint8_t* clock;
    std::uint8_t* reset_n;
    const std::uint8_t* axi_lite;  ///< the registers are behind AXI4-Lite instead of APB4

    std::uint8_t* psel;
    std::uint8_t* penable;
    std::uint8_t* pwrite;
    std::uint16_t* paddr;
    std::uint32_t* pwdata;
    std::uint8_t* pstrb;
    const std::uint8_t* pready;
    const std::uint32_t* prdata;
    const std::uint8_t* pslverr;

    std::uint8_t* awvalid;
    const std::uint8_t* awready;
    std::uint16_t* awaddr;
    std::uint8_t* wvalid;
    const std::uint8_t* wready;
    std::uint32_t* wdata;
    std::uint8_t* wstrb;
    const std::uint8_t* bvalid;
    std::uint8_t* bready;
    const std::uint8_t* bresp;
    std::uint8_t* arvalid;
    const std::uint8_t* arready;
    std::uint16_t* araddr;
    const std::uint8_t* rvalid;
    std::uint8_t* rready;
    const std::uint32_t* rdata;
    const std::uint8_t* rresp;

    const std::uint8_t* irq;
    const std::uint8_t* shot;

    std::uint8_t* line_valid;
    const std::uint8_t* line_ready;
    std::uint32_t* line_data;  ///< NP bits per column, column 0 lowest
    std::size_t line_words;
    std::uint8_t* line_last;

    const std::uint8_t* result_valid;
    std::uint8_t* result_ready;
    const std::uint64_t* result_data;
    const std::uint8_t* result_first;
    const std::uint8_t* result_last;

    const std::uint8_t* begin;             ///< the array's frame begins
    const std::uint8_t* done;              ///< the array's frame ends
    const std::uint8_t* abort;             ///< CONTROL.ABORT is written in this clock
    const std::uint8_t* flush;             ///< CONTROL.FLUSH takes effect in this clock
    const std::uint32_t* watchdog;         ///< present value of WATCHDOG
    const std::uint8_t* commit;            ///< settings become valid after this clock
    const std::uint8_t* reseed;            ///< SHOT_SEED is written in this clock
    const std::uint8_t* line_waits;        ///< a line is late inside an acquisition: the array's clock stops
    const std::uint8_t* array_valid;       ///< the line is offered to the array
    const std::uint8_t* dropped;           ///< an acquisition was dropped for lack of room
    const std::uint8_t* array_line_valid;  ///< at the array's port
    const std::uint8_t* array_line_ready;
    const std::uint8_t* test_begin;   ///< with `begin`: the frame is a self-test
    const std::uint8_t* test_frame;   ///< the frame that began last is a self-test
    const std::uint8_t* test_take;    ///< the array takes a line of the self-test
    const std::uint8_t* running;      ///< a frame is under way
    const std::uint32_t* array_line;  ///< lines before mask and gate, in the format of line_data
  };

  SubsystemModel() = default;
  SubsystemModel(const SubsystemModel&) = delete;
  SubsystemModel& operator=(const SubsystemModel&) = delete;
  SubsystemModel(SubsystemModel&&) = delete;
  SubsystemModel& operator=(SubsystemModel&&) = delete;
  virtual ~SubsystemModel() = default;

  [[nodiscard]] virtual Ports ports() = 0;
  virtual void eval() = 0;
};

}  // namespace dtof
