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

/// State of the array in one clock, for tests that follow a frame.
struct RtlCycle {
  std::uint64_t cycle;  ///< clock since the start of the frame
  RtlState state;
  bool acquisition_start;  ///< valid and ready: pixel 0, slot 0 of an acquisition is on the port
  bool result_beat;        ///< a result is transferred in this clock
  /// Column 0's histogram or pointer SRAM is written in this clock (configurations built with PROBE).
  bool sram_write;
  std::uint16_t sram_address;
  std::uint16_t sram_data;
};

/// Rows whose histograms a raw frame sends, first and last included.
struct RawRows {
  int first = 0;
  int last = 0;
};

/// Options of a frame's source and sink. The defaults are an ideal source and sink.
struct RtlRunOptions {
  std::uint64_t seed = 1;  ///< seed of everything random below
  /// Probability that the source pauses (1 to 8 clocks) before an acquisition.
  double pause_probability = 0.0;
  /// Probability that a pixel with fewer than SLOTS detections in an acquisition leaves its first slots empty
  /// instead of its last ones.
  double empty_slot_probability = 0.0;
  double stall_probability = 0.0;  ///< probability per clock that tready is low
  /// Clocks that tready stays low at each row's first result. 2 c such clocks simulate c more columns. In a
  /// pool read-out, rows begin in each of an engine's turns, and c clocks simulate c more engines.
  std::uint64_t row_stall = 0;
  double start_probability = 0.0;  ///< probability per clock, while busy, of start_i with another acq_num_i
  std::optional<std::uint64_t> reset_at;  ///< reset in this clock after the start; a whole frame follows
  std::optional<RawRows> raw;             ///< rows of a raw frame (RAW_HISTOGRAM); none: an ordinary frame
  bool prior = false;  ///< value of prior_i (PRIOR): the array starts from the candidates of its last frame
  bool reset_first = true;  ///< false: start in the state after the last frame (if there was one)
  /// Clocks after which a frame is aborted with an error; 0: several times what its size needs. Clocks in
  /// which source or sink stall the array do not count.
  std::uint64_t cycle_limit = 0;
  std::filesystem::path trace;                    ///< FST waveform of the run; clock n begins at 10 n ns
  std::function<void(const RtlCycle&)> observer;  ///< called in every clock of the frame
};

struct RtlStatistics {
  std::uint64_t cycles = 0;  ///< start to done
  std::array<std::uint64_t, kRtlStateCount> state_cycles{};
  std::uint64_t column_cycles = 0;  ///< simulated clocks, resets included, times SRAM_NUM
  double seconds = 0.0;             ///< wall time of the simulation

  /// Adds another run. `cycles` and `state_cycles` become those of the longer run.
  void merge(const RtlStatistics& other);
};

struct RtlFrame {
  int columns = 0;
  /// Index = row * columns + column. In a raw frame: ((row - first) * bins + bin) * columns + column.
  std::vector<PixelResult> results;
  std::vector<std::uint64_t> result_cycles;  ///< clock of each result, since start; same index
  std::uint64_t counter_full_clocks = 0;     ///< clocks in which counter_full_o was high
  RtlStatistics statistics;
};

/// A Verilated array with its source and sink. Not thread-safe: use one instance per thread.
class RtlReadout {
 public:
  /// `sram_report`: every SRAM prints its size and organisation on standard output. Throws InputError that
  /// lists what is compiled if `configuration` is not.
  explicit RtlReadout(const RtlConfiguration& configuration, bool sram_report = false);
  RtlReadout(const RtlReadout&) = delete;
  RtlReadout& operator=(const RtlReadout&) = delete;
  RtlReadout(RtlReadout&&) = delete;
  RtlReadout& operator=(RtlReadout&&) = delete;
  ~RtlReadout();

  [[nodiscard]] const RtlConfiguration& configuration() const;

  /// Sets the gate of the following frames. Throws InputError for a configuration without TIME_GATE, or a
  /// gate out of range.
  void set_time_gate(CodeGate gate);

  /// Runs one frame of `acquisitions` (0 to 65,535). `columns` holds up to SRAM_NUM columns of equally many
  /// rows, at most PIXELS_PER_SRAM. Other columns and rows of the array get no detections and are not in the
  /// result; but the rows of a pool read-out depend on them. A pool read-out's schedule is that of
  /// PoolSchedule. Throws InputError for a stream or a raw frame that does not suit the configuration,
  /// RtlError for a fault of the RTL.
  RtlFrame run(std::span<const ColumnStream> columns, std::uint32_t acquisitions,
               const RtlRunOptions& options = {});

  /// SRAMs of the array. An observer may change their contents in any clock, before its edge. Empty unless
  /// built with WRITABLE_SRAMS. Valid until `run` throws.
  [[nodiscard]] std::vector<RtlSram> srams() const;

 private:
  class Simulation;
  RtlConfiguration configuration_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace dtof
