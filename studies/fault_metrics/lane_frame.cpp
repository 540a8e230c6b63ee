// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/lane_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "fault_metrics/result_word.hpp"

namespace dtof {
namespace {

constexpr int kResetClocks = 2;
constexpr double kTolerance = 0.03;  // of the position
constexpr std::uint64_t kLongestReference = 1U << 26U;
constexpr std::uint64_t kInterruptionInterval = 1U << 14U;
constexpr std::uint64_t kRoom = 64;

/// The TDCs of all lanes. A line is taken when tdc_ready_o is high; a lane whose array takes too few or too
/// many lines lags behind lane 0, or is ahead of it.
class LaneSource {
 public:
  LaneSource(const GateNetlist& netlist, const FrameInput& input)
      : input_(input), timestamps_(netlist.port("tdc_timestamp_i")), valid_(netlist.port("tdc_valid_i")[0]) {
    np_ = timestamps_.size() / static_cast<std::size_t>(netlist.columns);
  }

  void drive(LaneCircuit& circuit) const {
    const std::size_t line = position(0);
    Lanes valid = Lanes::all(line < input_.lines.size());
    apart_.for_each([&](std::size_t lane) { valid.set(lane, position(lane) < input_.lines.size()); });
    circuit.drive(valid_, valid);
    for (std::size_t i = 0; i < timestamps_.size(); ++i) {
      Lanes bit = Lanes::all(bit_of(line, i));
      apart_.for_each([&](std::size_t lane) { bit.set(lane, bit_of(position(lane), i)); });
      circuit.drive(timestamps_[i], bit);
    }
  }

  /// `taken`: lanes whose array takes a line in this clock.
  void advance(const Lanes& taken) {
    const bool reference = taken.get(0);
    position_ += reference ? 1 : 0;
    (taken ^ Lanes::all(reference)).for_each([&](std::size_t lane) {
      lead_[lane] += reference ? -1 : 1;
      apart_.set(lane, lead_[lane] != 0);
    });
  }

 private:
  [[nodiscard]] std::size_t position(std::size_t lane) const {
    return static_cast<std::size_t>(static_cast<std::int64_t>(position_) + lead_[lane]);
  }
  [[nodiscard]] bool bit_of(std::size_t line, std::size_t bit) const {
    return line >= input_.lines.size() || (input_.lines[line][bit / np_] >> (bit % np_) & 1U) != 0;
  }

  const FrameInput& input_;
  const std::vector<Net>& timestamps_;
  Net valid_;
  std::size_t np_ = 1;
  std::size_t position_ = 0;
  std::array<std::int64_t, kLanes> lead_{};
  Lanes apart_;
};

/// Drives a frame into all lanes, and calls an observer in each of its clocks.
class FrameRun {
 public:
  FrameRun(const GateNetlist& netlist, const FrameInput& input, std::uint64_t seed)
      : netlist_(netlist),
        input_(input),
        circuit_(netlist, seed),
        source_(netlist, input),
        valid_(netlist.port("tdc_valid_i")[0]),
        ready_(netlist.port("tdc_ready_o")[0]) {}

  LaneCircuit& circuit() { return circuit_; }

  /// `observe(clock)` returns true to end the run after this clock. Clock 0 is that of the start pulse.
  template <typename Observe>
  void run(const Observe& observe) {
    drive_settings();
    drive("rst_ni", 0);
    for (int i = 0; i < kResetClocks; ++i) {
      circuit_.settle();
      circuit_.clock();
    }
    drive("rst_ni", 1);
    for (std::uint64_t clock = 0;; ++clock) {
      drive("start_i", clock == 0 ? 1 : 0);
      source_.drive(circuit_);
      circuit_.settle();
      if (observe(clock)) {
        return;
      }
      source_.advance(circuit_.value(valid_) & circuit_.value(ready_));
      circuit_.clock();
      if (clock % kInterruptionInterval == 0) {
        check_interruption();
      }
    }
  }

 private:
  void drive(const std::string& port, std::uint64_t value) {
    const std::vector<Net>& nets = netlist_.port(port);
    for (std::size_t i = 0; i < nets.size(); ++i) {
      circuit_.drive(nets[i], Lanes::all(i < 64 && (value >> i & 1U) != 0));
    }
  }

  void drive_settings() {
    const RtlConfiguration configuration = netlist_configuration(netlist_);
    drive("start_i", 0);
    drive("tdc_valid_i", 0);
    drive("result_tready_i", 1);
    drive("acq_num_i", input_.acquisitions);
    if (is_pool_readout(configuration.parameters.readout)) {
      const PoolSchedule schedule(input_.acquisitions, configuration.parameters.pool);
      drive("coarse_end_i", schedule.coarse_end);
      drive("track_end_i", schedule.track_end);
      drive("smooth_i", configuration.parameters.pool.smooth ? 1 : 0);
    }
  }

  const GateNetlist& netlist_;
  const FrameInput& input_;
  LaneCircuit circuit_;
  LaneSource source_;
  Net valid_;
  Net ready_;
};

/// Looks at the outputs of all lanes, clock by clock.
class LaneObserver {
 public:
  LaneObserver(const GateNetlist& netlist, const FrameReference& reference, LaneCircuit& circuit)
      : netlist_(netlist),
        word_(netlist),
        reference_(reference),
        circuit_(circuit),
        valid_(netlist.port("result_tvalid_o")[0]),
        last_(netlist.port("result_tlast_o")[0]),
        done_(netlist.port("done_o")[0]),
        busy_(netlist.port("busy_o")[0]),
        parity_error_(netlist.port("parity_error_o")[0]),
        data_(netlist.port("result_tdata_o")),
        outcomes_(kLanes) {
    running_ = Lanes::all(true);
    limit_ = reference.clocks + reference.clocks / 8 + kRoom;
  }

  bool operator()(std::uint64_t clock) {
    (circuit_.value(busy_) & ended_).for_each([&](std::size_t lane) { outcomes_[lane].endless = true; });
    ended_ = Lanes();
    (circuit_.value(valid_) & running_).for_each([&](std::size_t lane) { take_result(lane); });
    (circuit_.value(parity_error_) & running_).for_each([&](std::size_t lane) {
      outcomes_[lane].parity_error = true;
    });
    for (const Net error : netlist_.port("error_o")) {
      (circuit_.value(error) & running_).for_each([&](std::size_t lane) {
        outcomes_[lane].protocol_error = true;
      });
    }
    const Lanes done = circuit_.value(done_) & running_;
    if (clock > 0 && done.any()) {
      ended_ = done;
      running_ = running_ & ~done;
    }
    return (!running_.any() && !ended_.any()) || clock > limit_;
  }

  std::vector<FrameOutcome> finish() {
    running_.for_each([&](std::size_t lane) { outcomes_[lane].endless = true; });
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      FrameOutcome& outcome = outcomes_[lane];
      outcome.wrong_count = outcome.wrong_count || counts_[lane] != reference_.results.size();
      outcome.beyond = outcome.beyond || outcome.frame_check();
    }
    return std::move(outcomes_);
  }

 private:
  void take_result(std::size_t lane) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < data_.size(); ++i) {
      word |= std::uint64_t{circuit_.value(data_[i]).get(lane)} << i;
    }
    FrameOutcome& outcome = outcomes_[lane];
    const std::size_t index = counts_[lane]++;
    if (index >= reference_.results.size()) {
      outcome.wrong_count = true;
      return;
    }
    const std::uint64_t expected = reference_.results[index];
    const bool is_last = index + 1 == reference_.results.size();
    outcome.wrong_count = outcome.wrong_count || circuit_.value(last_).get(lane) != is_last;
    outcome.wrong_result = outcome.wrong_result || word != expected;
    outcome.wrong_order = outcome.wrong_order || word_.address(word) != word_.address(expected);
    const auto right = static_cast<double>(word_.position(expected));
    const double moved = std::abs(static_cast<double>(word_.position(word)) - right);
    outcome.beyond = outcome.beyond || moved > kTolerance * right;
  }

  const GateNetlist& netlist_;
  ResultWord word_;
  const FrameReference& reference_;
  LaneCircuit& circuit_;
  Net valid_, last_, done_, busy_, parity_error_;
  const std::vector<Net>& data_;
  Lanes running_;
  Lanes ended_;  // in the clock before
  std::uint64_t limit_ = 0;
  std::array<std::size_t, kLanes> counts_{};
  std::vector<FrameOutcome> outcomes_;
};

std::uint64_t word_of(const LaneCircuit& circuit, const std::vector<Net>& nets) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < nets.size(); ++i) {
    word |= std::uint64_t{circuit.value(nets[i]).get(0)} << i;
  }
  return word;
}

}  // namespace

FrameInput frame_input(const RtlConfiguration& configuration, std::span<const ColumnStream> columns,
                       std::uint32_t acquisitions) {
  const auto slots = static_cast<std::size_t>(configuration.parameters.slots);
  const auto rows = static_cast<std::size_t>(configuration.pixels_per_sram);
  const auto none = static_cast<Timestamp>(configuration.parameters.no_detection());
  FrameInput input{.acquisitions = acquisitions, .lines = {}};
  input.lines.assign(acquisitions * rows * slots, std::vector<Timestamp>(columns.size(), none));
  for (std::size_t column = 0; column < columns.size(); ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      std::optional<std::uint32_t> acquisition;
      std::size_t slot = 0;
      for (const Detection& detection : columns[column].row(static_cast<int>(row))) {
        slot = acquisition == detection.acquisition ? slot + 1 : 0;
        acquisition = detection.acquisition;
        input.lines[(detection.acquisition * rows + row) * slots + slot][column] = detection.timestamp;
      }
    }
  }
  return input;
}

RtlConfiguration netlist_configuration(const GateNetlist& netlist) {
  RtlConfiguration configuration;
  configuration.parameters = ReadoutParameters::defaults(parse_readout(netlist.readout));
  configuration.parameters.pool.engine_columns = netlist.columns;
  configuration.pixels_per_sram = netlist.rows;
  configuration.sram_num = netlist.columns;
  configuration.parity = netlist.parity;
  return configuration;
}

FrameReference run_reference(const GateNetlist& netlist, const FrameInput& input, std::uint64_t seed) {
  FrameReference reference;
  FrameRun frame(netlist, input, seed);
  const LaneCircuit& circuit = frame.circuit();
  frame.run([&](std::uint64_t clock) {
    if (word_of(circuit, netlist.port("result_tvalid_o")) != 0) {
      reference.results.push_back(word_of(circuit, netlist.port("result_tdata_o")));
    }
    if (word_of(circuit, netlist.port("parity_error_o")) != 0 ||
        word_of(circuit, netlist.port("error_o")) != 0) {
      throw InputError(fmt::format("{}: an error without a fault in clock {}", netlist.readout, clock));
    }
    reference.clocks = clock;
    if (clock > kLongestReference) {
      throw InputError(fmt::format("{}: the frame without a fault does not end", netlist.readout));
    }
    return clock > 0 && word_of(circuit, netlist.port("done_o")) != 0;
  });
  return reference;
}

std::vector<FrameOutcome> run_lanes(const GateNetlist& netlist, const FrameInput& input,
                                    const FrameReference& reference, std::span<const LaneFault> faults,
                                    std::uint64_t seed) {
  FrameRun frame(netlist, input, seed);
  for (LaneFault lane_fault : faults) {
    lane_fault.fault.clock += kResetClocks;
    frame.circuit().add(lane_fault.fault, lane_fault.lane);
  }
  LaneObserver observer(netlist, reference, frame.circuit());
  frame.run([&](std::uint64_t clock) { return observer(clock); });
  std::vector<FrameOutcome> outcomes = observer.finish();
  if (outcomes[0] != FrameOutcome()) {
    throw InputError(fmt::format("{}: the array without a fault differs from itself", netlist.readout));
  }
  return outcomes;
}

std::vector<PixelResult> reference_results(const GateNetlist& netlist, const FrameReference& reference) {
  const ResultWord word(netlist);
  std::vector<PixelResult> results(static_cast<std::size_t>(netlist.rows * netlist.columns));
  for (const std::uint64_t one : reference.results) {
    const std::size_t index = word.row(one) * static_cast<std::size_t>(netlist.columns) + word.column(one);
    if (index >= results.size()) {
      throw InputError(fmt::format("{}: a result of no pixel", netlist.readout));
    }
    const std::uint64_t position = word.position(one);
    results[index].code = static_cast<std::uint16_t>(position >> word.fraction_width);
    results[index].fraction =
        static_cast<std::uint16_t>(position & ((std::uint64_t{1} << word.fraction_width) - 1U));
    results[index].confidence = static_cast<std::uint16_t>(word.confidence(one));
  }
  return results;
}

}  // namespace dtof
