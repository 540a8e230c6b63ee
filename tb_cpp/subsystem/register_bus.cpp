// SPDX-License-Identifier: Apache-2.0
#include "subsystem/register_bus.hpp"

#include <fmt/format.h>

#include "rtl/error.hpp"

namespace dtof {
namespace {

constexpr std::uint8_t kSlaveError = 2;

}  // namespace

void RegisterBus::begin(bool write, std::uint32_t offset, std::uint32_t data, std::uint8_t strobe) {
  busy_ = true;
  write_ = write;
  offset_ = static_cast<std::uint16_t>(offset);
  data_ = data;
  strobe_ = strobe;
  access_ = false;
  address_taken_ = false;
  data_taken_ = !write;
  address_offered_ = false;
  data_offered_ = false;
}

void RegisterBus::end(std::uint32_t data, bool error) {
  response_ = {data, error};
  busy_ = false;
}

void RegisterBus::drive() { *ports_.axi_lite != 0 ? drive_axi() : drive_apb(); }

void RegisterBus::observe() {
  if (busy_) {
    *ports_.axi_lite != 0 ? observe_axi() : observe_apb();
  } else if (*ports_.bvalid != 0 || *ports_.rvalid != 0) {
    throw RtlError("AXI4-Lite: a response without a request");
  }
}

void RegisterBus::drive_apb() {
  *ports_.psel = busy_ ? 1 : 0;
  *ports_.penable = busy_ && access_ ? 1 : 0;
  *ports_.pwrite = write_ ? 1 : 0;
  *ports_.paddr = offset_;
  *ports_.pwdata = data_;
  *ports_.pstrb = strobe_;
}

void RegisterBus::observe_apb() {
  if (!access_) {
    access_ = true;
  } else if (*ports_.pready != 0) {
    end(*ports_.prdata, *ports_.pslverr != 0);
  }
}

void RegisterBus::drive_axi() {
  // What was offered stays; the rest comes when it likes.
  address_offered_ = busy_ && !address_taken_ && (address_offered_ || random_() % 2 == 0);
  data_offered_ = busy_ && !data_taken_ && (data_offered_ || random_() % 2 == 0);
  *ports_.awvalid = write_ && address_offered_ ? 1 : 0;
  *ports_.arvalid = !write_ && address_offered_ ? 1 : 0;
  *ports_.wvalid = write_ && data_offered_ ? 1 : 0;
  *ports_.awaddr = offset_;
  *ports_.araddr = offset_;
  // What is not offered says nothing.
  *ports_.wdata = data_offered_ ? data_ : ~data_;
  *ports_.wstrb = data_offered_ ? strobe_ : static_cast<std::uint8_t>(strobe_ ^ kAllBytes);
  *ports_.bready = random_() % 2 == 0 ? 1 : 0;
  *ports_.rready = random_() % 2 == 0 ? 1 : 0;
}

void RegisterBus::observe_axi() {
  const bool address_ready = (write_ ? *ports_.awready : *ports_.arready) != 0;
  const bool responds = (write_ ? *ports_.bvalid : *ports_.rvalid) != 0;
  if ((write_ ? *ports_.rvalid : *ports_.bvalid) != 0 || (responds && (!address_taken_ || !data_taken_))) {
    throw RtlError(
        fmt::format("AXI4-Lite: a response before the request was complete, register 0x{:03x}", offset_));
  }
  address_taken_ = address_taken_ || (address_offered_ && address_ready);
  data_taken_ = data_taken_ || (data_offered_ && *ports_.wready != 0);
  if (responds && (write_ ? *ports_.bready : *ports_.rready) != 0) {
    end(*ports_.rdata, (write_ ? *ports_.bresp : *ports_.rresp) == kSlaveError);
  }
}

}  // namespace dtof
