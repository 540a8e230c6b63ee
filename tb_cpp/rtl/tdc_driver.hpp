// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/random.hpp"
#include "rtl/array_model.hpp"
#include "rtl/configuration.hpp"

namespace dtof {

/// Models the TDCs of an array: drives one timestamp per clock and column from sparse columns.
///
/// Offers the next acquisition at once, except for random pauses. During pauses and after the last
/// acquisition the bus carries detections that the array must ignore.
class TdcDriver {
 public:
  /// `columns` must outlive the driver. Throws InputError for a stream that the configuration cannot take.
  TdcDriver(const RtlConfiguration& configuration, const ArrayModel::Ports& ports,
            std::span<const ColumnStream> columns, std::uint32_t acquisitions);

  /// Returns to the frame's first timestamp. The probabilities are those of RtlRunOptions.
  void rewind(double pause_probability, double empty_slot_probability, CounterRandom random);
  /// Drives this clock's timestamps.
  void drive();
  /// Ends the clock. Throws RtlError if the array takes more acquisitions than exist.
  void finish_clock();

  /// True if the source pauses in this clock.
  [[nodiscard]] bool pauses() const { return pause_left_ > 0; }
  /// Number of acquisitions that have begun.
  [[nodiscard]] std::uint32_t acquisitions_begun() const { return begun_; }
  /// True if an acquisition begins in this clock. Call it after the array's outputs have settled.
  [[nodiscard]] bool begins() const { return !inside_ && *ports_.tdc_valid != 0 && *ports_.tdc_ready != 0; }

 private:
  struct Cursor {
    const Detection* next;
    const Detection* end;
  };

  void load_pixel();
  /// Moves the pixel's detections in this column from the first slots to the last ones.
  void move_to_last_slots(std::size_t column, std::size_t detections);
  void fill_bus(int byte);
  void maybe_pause();

  ArrayModel::Ports ports_;
  std::span<const ColumnStream> columns_;
  std::uint32_t acquisitions_;
  std::size_t rows_;
  std::size_t slots_;
  std::size_t pixels_per_sram_;

  std::vector<Cursor> cursors_;                  // [row * stride + column]
  std::vector<std::uint32_t> next_acquisition_;  // [row * stride + column]: that of the next detection
  std::size_t stride_;                           // columns, rounded up to whole blocks
  std::vector<std::uint16_t> lines_;             // [slot * line + column], the bus contents of a pixel
  std::size_t line_;                             // 16-bit words on the bus

  double pause_probability_ = 0.0;
  double empty_slot_probability_ = 0.0;
  CounterRandom random_{0, 0, 0, 0};
  std::uint32_t pause_left_ = 0;
  std::uint32_t begun_ = 0;
  std::uint32_t acquisition_ = 0;
  std::size_t row_ = 0;
  std::size_t slot_ = 0;
  bool inside_ = false;      // between the first and the last timestamp of an acquisition
  bool empty_pixel_ = true;  // no detection in any column
  bool bus_idle_ = false;    // the bus carries only "no detection"
};

}  // namespace dtof
