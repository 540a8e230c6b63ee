// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/result.hpp"
#include "rtl/configuration.hpp"
#include "rtl/sram.hpp"

namespace dtof {

/// What the array showed in one clock, for tests that follow a frame state by state.
struct RtlCycle {
  std::uint64_t cycle;  ///< since the start clock of the frame
  RtlState state;
  bool acquisition_start;  ///< valid and ready: pixel 0, slot 0 of an acquisition is on the port
  bool result_beat;        ///< a result is transferred
  /// Column 0's histogram or pointer SRAM is written (configurations built with PROBE).
  bool sram_write;
  std::uint16_t sram_address;
  std::uint16_t sram_data;
};

/// Rows whose histograms a raw frame sends, both included.
struct RawRows {
  int first = 0;
  int last = 0;
};

/// How a frame is driven. The defaults are an ideal source and sink.
struct RtlRunOptions {
  std::uint64_t seed = 1;          ///< of everything random below
  double pause_probability = 0.0;  ///< the source pauses before an acquisition (1 to 8 clocks)
  double stall_probability = 0.0;  ///< per clock: tready is low
  /// Clocks that tready stays low for each row's first result; 2 c stand for c more columns. A pool
  /// read-out's engines have rows in each of their turns; c stand for c more engines.
  std::uint64_t row_stall = 0;
  double start_probability = 0.0;         ///< per clock while busy: start_i with another acq_num_i
  std::optional<std::uint64_t> reset_at;  ///< reset in this clock after start, then a whole frame
  std::optional<RawRows> raw;             ///< a raw frame (RAW_HISTOGRAM)
  bool prior = false;                     ///< prior_i (PRIOR): the array begins from its last frame
  bool reset_first = true;  ///< false: start as the frame before left the array (if there was one)
  /// Clocks after which a frame is given up; 0: several times what its size needs. Clocks in which source or
  /// sink hold the array up do not count.
  std::uint64_t cycle_limit = 0;
  std::filesystem::path trace;                    ///< FST waveform of the run; clock n begins at 10 n ns
  std::function<void(const RtlCycle&)> observer;  ///< called in every clock of the frame
};

struct RtlStatistics {
  std::uint64_t cycles = 0;  ///< start to done
  std::array<std::uint64_t, kRtlStateCount> state_cycles{};
  std::uint64_t column_cycles = 0;  ///< clocks simulated, resets included, times SRAM_NUM
  double seconds = 0.0;             ///< wall time of the simulation

  /// Sum of two runs; `cycles` and `state_cycles` become those of the longer one.
  void merge(const RtlStatistics& other);
};

struct RtlFrame {
  int columns = 0;
  /// Index = row * columns + column; of a raw frame ((row - first) * bins + bin) * columns + column.
  std::vector<PixelResult> results;
  std::vector<std::uint64_t> result_cycles;  ///< clock of each result, since start; same index
  std::uint64_t counter_full_clocks = 0;     ///< clocks in which counter_full_o was high
  RtlStatistics statistics;
};

/// A Verilated array with source and sink. Not thread-safe: one instance per thread.
class RtlReadout {
 public:
  /// `sram_report` makes every SRAM print its size and organisation on standard output. Throws InputError
  /// listing what is compiled if `configuration` is not.
  explicit RtlReadout(const RtlConfiguration& configuration, bool sram_report = false);
  RtlReadout(const RtlReadout&) = delete;
  RtlReadout& operator=(const RtlReadout&) = delete;
  RtlReadout(RtlReadout&&) = delete;
  RtlReadout& operator=(RtlReadout&&) = delete;
  ~RtlReadout();

  [[nodiscard]] const RtlConfiguration& configuration() const;

  /// The gate of the frames to come. Throws InputError for a configuration without TIME_GATE, or a gate out
  /// of range.
  void set_time_gate(CodeGate gate);

  /// Runs one frame of `acquisitions` (0 to 65,535) on up to SRAM_NUM columns of equally many rows, at most
  /// PIXELS_PER_SRAM; columns and rows beyond the given ones see no detection and are not in the result (the
  /// rows of a pool read-out see them, too). A pool read-out's schedule is that of PoolSchedule.
  /// Throws InputError for a stream or a raw frame that the configuration cannot take, RtlError for
  /// misbehaving RTL.
  RtlFrame run(std::span<const ColumnStream> columns, std::uint32_t acquisitions,
               const RtlRunOptions& options = {});

  /// Its SRAMs, which an observer may change in any clock before its edge; none unless built with
  /// WRITABLE_SRAMS. Valid until `run` throws.
  [[nodiscard]] std::vector<RtlSram> srams() const;

 private:
  class Simulation;
  RtlConfiguration configuration_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace dtof
