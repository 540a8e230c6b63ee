// SPDX-License-Identifier: Apache-2.0
#include "rtl/tdc_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "dtof/core/error.hpp"
#include "rtl/error.hpp"

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "timestamps are copied to the bus as they lie");

constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kLongestPause = 8;
// Detections ahead in each pixel's list: too many lists in turn for the processor to guess.
constexpr std::ptrdiff_t kPrefetchDistance = 8;
// Columns compared in one go: one byte each says whether the column has a detection.
constexpr std::size_t kBlock = 8;
constexpr int kNoDetectionByte = 0xFF;
constexpr std::uint16_t kNoDetection = 0xFFFF;
constexpr int kDetectionOfCode0Byte = 0x00;

void check_row(std::span<const Detection> row, std::size_t column, std::size_t index,
               const ReadoutParameters& parameters, std::uint32_t acquisitions) {
  const auto refuse = [&](const std::string& what) {
    return InputError(fmt::format("column {} row {}: {}", column, index, what));
  };
  int in_acquisition = 0;
  std::uint32_t previous = kNever;
  for (const Detection& detection : row) {
    if (detection.timestamp > parameters.no_detection()) {
      throw refuse(fmt::format("timestamp {} does not fit NP = {}", detection.timestamp, parameters.np));
    }
    if (detection.acquisition >= acquisitions) {
      throw refuse(
          fmt::format("acquisition {} in a frame of {} acquisitions", detection.acquisition, acquisitions));
    }
    if (previous != kNever && detection.acquisition < previous) {
      throw refuse(fmt::format("acquisition {} after {}", detection.acquisition, previous));
    }
    in_acquisition = detection.acquisition == previous ? in_acquisition + 1 : 1;
    if (in_acquisition > parameters.slots) {
      throw refuse(fmt::format("more than SLOTS = {} detections in acquisition {}", parameters.slots,
                               detection.acquisition));
    }
    previous = detection.acquisition;
  }
}

}  // namespace

TdcDriver::TdcDriver(const RtlConfiguration& configuration, const ArrayModel::Ports& ports,
                     std::span<const ColumnStream> columns, std::uint32_t acquisitions)
    : ports_(ports),
      columns_(columns),
      acquisitions_(acquisitions),
      rows_(columns.empty() ? 0 : static_cast<std::size_t>(columns.front().rows())),
      slots_(static_cast<std::size_t>(configuration.parameters.slots)),
      pixels_per_sram_(static_cast<std::size_t>(configuration.pixels_per_sram)),
      line_(ports.timestamp_words * 2) {
  if (columns.size() > static_cast<std::size_t>(configuration.sram_num)) {
    throw InputError(
        fmt::format("{} columns for an array of SRAM_NUM = {}", columns.size(), configuration.sram_num));
  }
  if (acquisitions > std::numeric_limits<std::uint16_t>::max()) {
    throw InputError(fmt::format("{} acquisitions; the RTL takes 0 to 65535", acquisitions));
  }
  for (std::size_t column = 0; column < columns.size(); ++column) {
    const auto rows = static_cast<std::size_t>(columns[column].rows());
    if (rows > pixels_per_sram_ || rows != rows_) {
      throw InputError(fmt::format("column {} has {} rows, column 0 {}, the array PIXELS_PER_SRAM = {}",
                                   column, rows, rows_, pixels_per_sram_));
    }
    for (std::size_t row = 0; row < rows_; ++row) {
      check_row(columns[column].row(static_cast<int>(row)), column, row, configuration.parameters,
                acquisitions);
    }
  }
  lines_.resize(slots_ * line_);
  stride_ = (columns.size() + kBlock - 1) / kBlock * kBlock;
}

void TdcDriver::rewind(double pause_probability, double empty_slot_probability, CounterRandom random) {
  pause_probability_ = pause_probability;
  empty_slot_probability_ = empty_slot_probability;
  random_ = random;
  cursors_.resize(rows_ * stride_);
  next_acquisition_.assign(pixels_per_sram_ * stride_, kNever);
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      const std::span<const Detection> detections = columns_[column].row(static_cast<int>(row));
      if (!detections.empty()) {
        cursors_[row * stride_ + column] = {detections.data(), detections.data() + detections.size()};
        next_acquisition_[row * stride_ + column] = detections.front().acquisition;
      }
    }
  }
  pause_left_ = 0;
  begun_ = 0;
  acquisition_ = 0;
  row_ = 0;
  slot_ = 0;
  inside_ = false;
  bus_idle_ = false;
  load_pixel();
  maybe_pause();
}

void TdcDriver::maybe_pause() {
  if (pause_probability_ > 0.0 && random_.uniform() < pause_probability_) {
    pause_left_ = 1 + random_() % kLongestPause;
  }
}

void TdcDriver::load_pixel() {
  empty_pixel_ = true;
  for (std::size_t first = 0; first < stride_; first += kBlock) {
    // Which columns have a detection is random: a loop over those that have is guessed wrong less often than
    // a question to each.
    std::uint32_t* next = &next_acquisition_[row_ * stride_ + first];
    std::array<std::uint8_t, kBlock> detects{};
    for (std::size_t i = 0; i < kBlock; ++i) {
      detects[i] = next[i] == acquisition_ ? 1 : 0;
    }
    for (auto left = std::bit_cast<std::uint64_t>(detects); left != 0; left &= left - 1) {
      if (empty_pixel_) {
        std::memset(lines_.data(), kNoDetectionByte, lines_.size() * sizeof(std::uint16_t));
        empty_pixel_ = false;
      }
      const std::size_t i = static_cast<std::size_t>(std::countr_zero(left)) / 8;
      Cursor& cursor = cursors_[row_ * stride_ + first + i];
      std::uint16_t* slot = &lines_[first + i];
      do {
        *slot = cursor.next->timestamp;
        slot += line_;
        ++cursor.next;
      } while (cursor.next != cursor.end && cursor.next->acquisition == acquisition_);
      if (empty_slot_probability_ > 0.0 && random_.uniform() < empty_slot_probability_) {
        move_to_last_slots(first + i, static_cast<std::size_t>(slot - &lines_[first + i]) / line_);
      }
      next[i] = cursor.next != cursor.end ? cursor.next->acquisition : kNever;
      __builtin_prefetch(cursor.next + kPrefetchDistance);
    }
  }
}

void TdcDriver::move_to_last_slots(std::size_t column, std::size_t detections) {
  if (detections == slots_) {
    return;
  }
  for (std::size_t slot = detections; slot-- > 0;) {
    std::uint16_t& first = lines_[slot * line_ + column];
    lines_[(slots_ - detections + slot) * line_ + column] = first;
    first = kNoDetection;
  }
}

void TdcDriver::fill_bus(int byte) { std::memset(ports_.timestamps, byte, line_ * sizeof(std::uint16_t)); }

void TdcDriver::drive() {
  if (pause_left_ > 0) {
    *ports_.tdc_valid = 0;
    fill_bus(kDetectionOfCode0Byte);
    bus_idle_ = false;
    return;
  }
  *ports_.tdc_valid = 1;
  if (acquisition_ >= acquisitions_) {
    fill_bus(kDetectionOfCode0Byte);
    return;
  }
  if (!empty_pixel_) {
    std::memcpy(ports_.timestamps, &lines_[slot_ * line_], line_ * sizeof(std::uint16_t));
    bus_idle_ = false;
  } else if (!bus_idle_) {
    fill_bus(kNoDetectionByte);
    bus_idle_ = true;
  }
}

void TdcDriver::finish_clock() {
  if (pause_left_ > 0) {
    --pause_left_;
    return;
  }
  if (!inside_) {
    if (*ports_.tdc_ready == 0) {
      return;
    }
    if (acquisition_ >= acquisitions_) {
      throw RtlError(fmt::format("tdc_ready_o is high after all {} acquisitions", acquisitions_));
    }
    ++begun_;
  }
  inside_ = true;
  if (++slot_ == slots_) {
    slot_ = 0;
    if (++row_ == pixels_per_sram_) {
      row_ = 0;
      ++acquisition_;
      inside_ = false;
      maybe_pause();
    }
    load_pixel();
  }
}

}  // namespace dtof
