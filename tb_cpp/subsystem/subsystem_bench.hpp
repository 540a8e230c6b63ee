// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "dtof/core/random.hpp"
#include "rtl/sram.hpp"
#include "subsystem/axi_stream.hpp"
#include "subsystem/register_bus.hpp"
#include "subsystem/registry.hpp"
#include "subsystem/shot_reference.hpp"

class VerilatedContext;

namespace dtof {

/// Lines and events of a frame at the array in the subsystem.
struct ArrayFrame {
  std::vector<Line>
      lines;  ///< those of all acquisitions in order, before mask and gate, without dropped ones
  std::uint64_t cycles = 0;  ///< clocks from start to done, both included; 0 while the frame is under way
  std::uint32_t lost = 0;    ///< acquisitions in which the line buffer ran empty
  bool self_test = false;    ///< lines come from the self-test's generator
  std::vector<std::uint64_t> shots;  ///< clocks in which shot_o was high, from the frame's start
};

/// A subsystem with a bus master, source and sink at its ports. It checks in every clock:
///  - The results keep the protocol of their stream (ResultSink).
///  - An acquisition begins only when it may, and is never interrupted.
///  - The array's clock stops exactly while a line is late inside an acquisition.
///  - Each line reaches the array in its place, or as no detection where StreamReference says so; except
///    lines of acquisitions that SETTLE drops at a frame's start.
///  - A line is refused only if the buffer is full or in the clock of a command, and never if the source
///    cannot wait. Only then an acquisition may be dropped, and only if the buffer is full.
///  - A shot is fired exactly when ShotReference says so.
///  - In a self-test no line of the source reaches the array, and no word leaves.
class SubsystemBench {
 public:
  /// `seed` determines everything random.
  SubsystemBench(const CompiledSubsystem& subsystem, std::uint64_t seed);
  ~SubsystemBench();
  SubsystemBench(const SubsystemBench&) = delete;
  SubsystemBench& operator=(const SubsystemBench&) = delete;
  SubsystemBench(SubsystemBench&&) = delete;
  SubsystemBench& operator=(SubsystemBench&&) = delete;

  [[nodiscard]] const RtlConfiguration& configuration() const { return configuration_; }
  [[nodiscard]] std::size_t acquisition_lines() const { return acquisition_lines_; }
  [[nodiscard]] LineSource& source() { return source_; }
  [[nodiscard]] ResultSink& sink() { return sink_; }
  [[nodiscard]] const ResultSink& sink() const { return sink_; }
  [[nodiscard]] const std::vector<ArrayFrame>& frames() const { return frames_; }
  [[nodiscard]] SubsystemEvents& events() { return reference_.events(); }
  [[nodiscard]] const StreamReference& reference() const { return reference_; }
  /// SRAMs of the subsystem; empty unless it was built with WRITABLE_SRAMS.
  [[nodiscard]] std::vector<RtlSram> srams() { return find_srams(*context_); }
  /// Value of shot_o in the last clock.
  [[nodiscard]] bool shot() const { return shot_; }
  [[nodiscard]] const ShotReference& shot_reference() const { return shot_reference_; }
  [[nodiscard]] bool interrupt() const { return *ports_.irq != 0; }
  /// Parameters of the build. clock_waits: the array waits for a late line inside an acquisition.
  /// source_waits: false if the source cannot wait and loses whole acquisitions.
  [[nodiscard]] bool clock_waits() const { return clock_waits_; }
  [[nodiscard]] bool source_waits() const { return source_waits_; }
  [[nodiscard]] bool raster_order() const { return raster_order_; }
  /// Clocks in which the array waited for a line inside an acquisition, and (below) number of dropped
  /// acquisitions.
  [[nodiscard]] std::uint64_t rests() const { return rests_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  [[nodiscard]] std::size_t buffer_lines() const { return buffer_lines_; }
  [[nodiscard]] bool axi_lite() const { return *ports_.axi_lite != 0; }

  /// A reset of so many clocks. The source drops its lines, or keeps them if it is in another reset domain
  /// (`source_too` false).
  void reset(bool source_too = true, int clocks = 2);
  /// Runs one clock. Throws RtlError if a check fails.
  void clock();
  void clocks(std::uint64_t count);
  /// Runs until `frames` more frames were received. Throws RtlError after `limit` clocks.
  void wait_for_frames(std::size_t frames, std::uint64_t limit = 1000000);

  BusResponse read(std::uint32_t offset);
  BusResponse write(std::uint32_t offset, std::uint32_t data, std::uint8_t strobe = RegisterBus::kAllBytes);
  /// Begins to read a register, or to write all its bytes; the following clocks complete the transfer.
  void begin_read(std::uint32_t offset) { bus_.read(offset); }
  void begin_write(std::uint32_t offset, std::uint32_t data) {
    bus_.write(offset, data, RegisterBus::kAllBytes);
  }
  /// As `read` and `write`, for a register that exists: throws RtlError for an error response.
  std::uint32_t get(std::uint32_t offset);
  void set(std::uint32_t offset, std::uint32_t data);

 private:
  void observe_self_test();
  void run_transfer();
  void observe_lines();
  void take_array_line();
  /// Checks what the array is offered. `here`: a line is available that nobody waits for. Acquisitions that
  /// SETTLE drops must not be offered.
  void check_array_offer(bool here) const;
  void begin_frame();
  void observe_shot(ShotClock now);
  [[nodiscard]] Line array_line() const;
  struct Settings {
    std::size_t release = 0;
    bool second = false;
    bool raw = false;
    bool short_words = false;
    bool amplitude = false;
    std::uint32_t raw_rows = 0;
    std::uint32_t acquisitions = 0;
    std::uint32_t settle = 0;
    ShotReference::Settings shot = {};
  };
  /// Number of words of the frame that begins.
  [[nodiscard]] std::size_t words() const;
  /// Reset value of RELEASE, which is its largest value.
  [[nodiscard]] std::size_t most_release() const {
    return clock_waits_ ? acquisition_lines_ : std::min(buffer_lines_, acquisition_lines_);
  }

  RtlConfiguration configuration_;
  std::unique_ptr<VerilatedContext> context_;
  std::unique_ptr<SubsystemModel> model_;
  SubsystemModel::Ports ports_;
  RegisterBus bus_;
  LineSource source_;
  ResultSink sink_;
  std::size_t acquisition_lines_;
  std::size_t buffer_lines_ = 0;
  bool clock_waits_ = false;
  bool source_waits_ = true;
  bool raster_order_ = false;
  std::uint64_t rests_ = 0;
  std::uint64_t dropped_ = 0;
  Settings written_;
  Settings committed_;
  StreamReference reference_;
  ShotReference shot_reference_;
  bool shot_ = false;
  std::vector<ArrayFrame> frames_;
  std::uint32_t settle_left_ = 0;  // acquisitions of the frame still to be dropped
  std::uint64_t cycle_ = 0;
  std::uint64_t begin_cycle_ = 0;
  bool array_held_ = false;   // a line was offered to the array and not taken
  bool behind_reset_ = true;  // no clock since the last reset
};

}  // namespace dtof
