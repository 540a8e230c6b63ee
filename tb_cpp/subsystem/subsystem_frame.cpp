// SPDX-License-Identifier: Apache-2.0
#include "subsystem/subsystem_frame.hpp"

#include <fmt/format.h>
#include <verilated.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "dtof.h"
#include "dtof/core/progress.hpp"
#include "dtof/core/random.hpp"
#include "dtof/core/select_columns.hpp"
#include "rtl/error.hpp"
#include "rtl/tdc_driver.hpp"
#include "rtl/write_coverage.hpp"
#include "subsystem/register_bus.hpp"
#include "subsystem/registry.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kInterruptionInterval = 1U << 20U;
constexpr std::uint64_t kMostClocksOfAPixel = 20000;  // beside its lines: clearing, scanning, engines

/// One subsystem, its clock, and a frame's source and sink.
class SubsystemFrame {
 public:
  explicit SubsystemFrame(const CompiledSubsystem& subsystem)
      : configuration_(subsystem.configuration), context_(std::make_unique<VerilatedContext>()) {
    Verilated::threadContextp(context_.get());
    context_->randReset(2);  // memories and uninitialised registers start random
    context_->randSeed(1);
    const char* program = "dtof";  // the RTL looks for +sram_report
    context_->commandArgs(1, &program);
    model_ = subsystem.factory(*context_);
    ports_ = model_->ports();
    bus_ = std::make_unique<RegisterBus>(
        ports_, CounterRandom(1, static_cast<std::uint32_t>(RandomPurpose::kTestControl), 0, 0));
    *ports_.line_valid = 0;
    *ports_.result_ready = 1;
    *ports_.reset_n = 0;
    clock();
    clock();
    *ports_.reset_n = 1;
  }
  ~SubsystemFrame() {
    Verilated::threadContextp(context_.get());
    write_coverage(*context_);
  }
  SubsystemFrame(const SubsystemFrame&) = delete;
  SubsystemFrame& operator=(const SubsystemFrame&) = delete;
  SubsystemFrame(SubsystemFrame&&) = delete;
  SubsystemFrame& operator=(SubsystemFrame&&) = delete;

  RtlFrame run(std::span<const ColumnStream> columns, std::uint32_t acquisitions) {
    dtof_device device{};
    check(dtof_probe(&device, {this, read, write}), "probe");
    check(dtof_configure(&device, &settings(device, acquisitions)), "configure");
    if (device.has_schedule) {
      check(dtof_set_template(&device, configuration_.parameters.pool.coarse_template.data()),
            "set the template");
    }
    check(dtof_enable_interrupts(&device, true, false), "enable the interrupt");

    timestamps_.assign(static_cast<std::size_t>(configuration_.sram_num + 1) / 2, 0);
    std::uint8_t tdc_valid = 0;
    ArrayModel::Ports tdc{};  // the source's side of the line: one timestamp in 16 bits
    tdc.tdc_valid = &tdc_valid;
    tdc.tdc_ready = ports_.line_ready;
    tdc.timestamps = timestamps_.data();
    tdc.timestamp_words = timestamps_.size();
    TdcDriver driver(configuration_, tdc, columns, acquisitions);
    driver.rewind(0.0, 0.0, CounterRandom(1, static_cast<std::uint32_t>(RandomPurpose::kTestControl), 0, 1));
    driver_ = &driver;
    acquisition_lines_ = device.acquisition_lines;
    lines_left_ = std::uint64_t{acquisitions} * acquisition_lines_;
    line_ = 0;
    const std::uint64_t limit = 2 * lines_left_ + kMostClocksOfAPixel *
                                                      static_cast<std::uint64_t>(device.rows) *
                                                      static_cast<std::uint64_t>(device.columns);

    words_.clear();
    check(dtof_start(&device, false), "start");
    for (std::uint64_t i = 0; *ports_.irq == 0; ++i) {
      if (i >= limit) {
        throw RtlError(fmt::format("{}: the subsystem's frame did not end within {} clocks",
                                   configuration_.to_string(), limit));
      }
      if (i % kInterruptionInterval == 0) {
        check_interruption();
      }
      clock();
    }
    driver_ = nullptr;
    return unpacked(device, columns);
  }

 private:
  const dtof_settings& settings(const dtof_device& device, std::uint32_t acquisitions) {
    const ReadoutParameters& parameters = configuration_.parameters;
    settings_ = dtof_default_settings(&device, acquisitions);
    settings_.coarse_share = static_cast<std::uint8_t>(parameters.pool.coarse_share);
    settings_.track_share = static_cast<std::uint8_t>(parameters.pool.track_share);
    settings_.smooth = parameters.pool.smooth;
    if (parameters.time_gate) {
      settings_.gate_begin = static_cast<std::uint16_t>(parameters.time_gate->begin);
      settings_.gate_end = static_cast<std::uint16_t>(parameters.time_gate->end);
    }
    return settings_;
  }

  RtlFrame unpacked(const dtof_device& device, std::span<const ColumnStream> columns) {
    std::uint32_t errors = 0;
    std::uint32_t frames = 0;
    std::uint32_t cycles = 0;
    check(dtof_take_errors(&device, &errors), "read the errors");
    check(dtof_frames(&device, &frames, &cycles), "read the frame's clocks");
    if (errors != 0) {
      throw RtlError(
          fmt::format("{}: the subsystem tells errors 0x{:02x}", configuration_.to_string(), errors));
    }
    std::vector<dtof_result> results(static_cast<std::size_t>(device.rows) * device.columns);
    check(dtof_unpack_frame(&device, words_.data(), words_.size(), results.data()), "unpack the results");

    RtlFrame frame;
    frame.columns = static_cast<int>(columns.size());
    const std::size_t rows = columns.empty() ? 0 : static_cast<std::size_t>(columns.front().rows());
    const auto fraction_mask = static_cast<std::uint16_t>((1U << device.fraction_bits) - 1U);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns.size(); ++column) {
        const dtof_result& result = results[row * device.columns + column];
        frame.results.push_back({.code = static_cast<std::uint16_t>(result.position >> device.fraction_bits),
                                 .fraction = static_cast<std::uint16_t>(result.position & fraction_mask),
                                 .confidence = result.confidence});
      }
    }
    frame.result_cycles.resize(frame.results.size());
    frame.statistics.cycles = cycles;
    return frame;
  }

  void clock() {
    drive_line();
    bus_->drive();
    *ports_.clock = 0;
    model_->eval();
    bus_->observe();
    if (*ports_.line_valid != 0 && *ports_.line_ready != 0) {
      driver_->finish_clock();
      --lines_left_;
      line_ = line_ + 1 == acquisition_lines_ ? 0 : line_ + 1;
    }
    if (*ports_.result_valid != 0) {
      words_.push_back(*ports_.result_data);
    }
    *ports_.clock = 1;
    model_->eval();
  }

  void drive_line() {
    const bool offers = driver_ != nullptr && lines_left_ > 0;
    *ports_.line_valid = offers ? 1 : 0;
    if (!offers) {
      return;
    }
    driver_->drive();
    *ports_.line_last = line_ + 1 == acquisition_lines_ ? 1 : 0;
    const auto width = static_cast<unsigned>(configuration_.parameters.np);
    const std::uint64_t mask = (std::uint64_t{1} << width) - 1;  // "no detection" has 16 ones
    std::uint64_t bits = 0;
    unsigned filled = 0;
    std::size_t word = 0;
    for (std::size_t column = 0; column < static_cast<std::size_t>(configuration_.sram_num); ++column) {
      const std::uint64_t pair = timestamps_[column / 2];
      bits |= ((pair >> (column % 2 * 16)) & mask) << filled;
      filled += width;
      if (filled >= 32) {
        ports_.line_data[word++] = static_cast<std::uint32_t>(bits);
        bits >>= 32U;
        filled -= 32;
      }
    }
    ports_.line_data[word] = static_cast<std::uint32_t>(bits);
  }

  BusResponse transfer() {
    while (bus_->busy()) {
      clock();
    }
    return bus_->response();
  }

  static bool read(void* context, std::uint32_t offset, std::uint32_t* value) {
    auto& frame = *static_cast<SubsystemFrame*>(context);
    frame.bus_->read(offset);
    const BusResponse response = frame.transfer();
    *value = response.data;
    return !response.error;
  }

  static bool write(void* context, std::uint32_t offset, std::uint32_t value) {
    auto& frame = *static_cast<SubsystemFrame*>(context);
    frame.bus_->write(offset, value, RegisterBus::kAllBytes);
    return !frame.transfer().error;
  }

  void check(dtof_status status, const char* what) const {
    if (status != DTOF_OK) {
      throw RtlError(fmt::format("{}: the driver could not {}: {}", configuration_.to_string(), what,
                                 static_cast<int>(status)));
    }
  }

  RtlConfiguration configuration_;
  std::unique_ptr<VerilatedContext> context_;
  std::unique_ptr<SubsystemModel> model_;
  SubsystemModel::Ports ports_{};
  std::unique_ptr<RegisterBus> bus_;
  dtof_settings settings_{};
  TdcDriver* driver_ = nullptr;
  std::vector<std::uint32_t> timestamps_;  // 16 bits a column
  std::uint64_t lines_left_ = 0;
  std::uint32_t acquisition_lines_ = 0;
  std::uint32_t line_ = 0;  // of the acquisition
  std::vector<std::uint64_t> words_;
};

}  // namespace

RtlSourceFrame run_frame_subsystem(const StreamSource& source, const ReadoutParameters& parameters,
                                   int threads, std::span<const int> columns, Progress* progress) {
  parameters.validate();
  const std::vector<int> selected = select_columns(source, columns);
  const std::vector<CompiledSubsystem> subsystems =
      find_subsystems(parameters, source.rows(), source.columns(), selected);
  if (parameters.columns_together() > 1) {
    return run_frame_by_engines(
        source, selected, column_groups(selected, parameters.columns_together(), source.columns()), threads,
        [&](std::size_t engine, std::span<const ColumnStream> streams, std::uint32_t acquisitions) {
          return SubsystemFrame(subsystems[engine]).run(streams, acquisitions);
        },
        progress);
  }
  return run_frame_in_groups(
      source, subsystems.front().configuration, threads, selected, true,
      [&](std::span<const ColumnStream> streams, std::uint32_t acquisitions) {
        return SubsystemFrame(subsystems.front()).run(streams, acquisitions);
      },
      progress);
}

}  // namespace dtof
