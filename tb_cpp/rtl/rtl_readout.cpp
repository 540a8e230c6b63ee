// SPDX-License-Identifier: Apache-2.0
#include "rtl/rtl_readout.hpp"

#include <fmt/format.h>
#include <verilated.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/random.hpp"
#include "rtl/array_model.hpp"
#include "rtl/error.hpp"
#include "rtl/registry.hpp"
#include "rtl/tdc_driver.hpp"
#include "rtl/write_coverage.hpp"

namespace dtof {
namespace {

// Streams of CounterRandom below one seed.
enum class ControlStream : std::uint32_t { kPause = 1, kClock = 2, kReset = 3 };

CounterRandom control_random(std::uint64_t seed, ControlStream stream) {
  return {seed, static_cast<std::uint32_t>(RandomPurpose::kTestControl), static_cast<std::uint32_t>(stream),
          0};
}

constexpr std::uint64_t kTracePeriod = 10;  // ns
constexpr int kResetClocks = 2;
constexpr std::uint64_t kFirstContentsSeed = 1;
constexpr std::uint32_t kOtherFrame = 1001;  // acquisitions more than those of the frame that runs

}  // namespace

void RtlStatistics::merge(const RtlStatistics& other) {
  if (other.cycles > cycles) {
    cycles = other.cycles;
    state_cycles = other.state_cycles;
  }
  column_cycles += other.column_cycles;
  seconds += other.seconds;
}

/// The model, its context, and the clock.
class RtlReadout::Simulation {
 public:
  Simulation(const RtlConfiguration& configuration, std::uint64_t seed, bool sram_report)
      : configuration_(configuration),
        result_order_(configuration.result_order()),
        context_(std::make_unique<VerilatedContext>()) {
    Verilated::threadContextp(context_.get());
    context_->randReset(2);  // memories and uninitialised registers start random
    context_->randSeed(static_cast<int>(seed % 0x7FFFFFFFU) + 1);
    context_->traceEverOn(true);
    std::array<const char*, 2> arguments = {"dtof", "+sram_report"};
    context_->commandArgs(sram_report ? 2 : 1, arguments.data());
    model_ = make_array_model(configuration, *context_);
    ports_ = model_->ports();
    *ports_.clock = 0;
    *ports_.reset_n = 0;
    *ports_.start = 0;
    *ports_.tdc_valid = 0;
    *ports_.result_ready = 0;
    model_->eval();
  }

  // The model takes itself out of the thread's context, which may be another instance's.
  ~Simulation() {
    Verilated::threadContextp(context_.get());
    write_coverage(*context_);
  }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  Simulation(Simulation&&) = delete;
  Simulation& operator=(Simulation&&) = delete;

  [[nodiscard]] bool broken() const { return broken_; }
  [[nodiscard]] std::vector<RtlSram> srams() const { return find_srams(*context_); }

  RtlFrame run(std::span<const ColumnStream> columns, std::uint32_t acquisitions, CodeGate gate,
               const RtlRunOptions& options) {
    Verilated::threadContextp(context_.get());  // the instance may have moved to another thread
    const auto begin = std::chrono::steady_clock::now();
    TdcDriver driver(configuration_, ports_, columns, acquisitions);
    driver_ = &driver;
    options_ = &options;
    acquisitions_ = acquisitions;
    gate_ = gate;
    order_ = options.raw ? raw_order(*options.raw) : result_order_;
    expected_beats_ = order_.size();
    total_cycles_ = 0;
    broken_ = true;  // until the frame ends without an exception
    if (!options.trace.empty()) {
      model_->open_trace(options.trace);
    }
    tracing_ = !options.trace.empty();

    frame_ = RtlFrame{};
    frame_.columns = static_cast<int>(columns.size());
    const std::size_t rows = columns.empty() ? 0 : static_cast<std::size_t>(columns.front().rows());
    frame_.results.resize((options.raw ? raw_lines(*options.raw) : rows) * columns.size());
    frame_.result_cycles.resize(frame_.results.size());

    if (options.reset_first || !was_reset_) {
      reset();
    }
    if (!run_frame(options.reset_at)) {
      reset();
      run_frame(std::nullopt);
    }
    if (tracing_) {
      model_->close_trace();
    }
    broken_ = false;
    frame_.statistics.column_cycles = total_cycles_ * static_cast<std::uint64_t>(configuration_.sram_num);
    frame_.statistics.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(frame_);
  }

 private:
  /// Rows times bins.
  [[nodiscard]] std::size_t raw_lines(RawRows rows) const {
    return static_cast<std::size_t>(rows.last - rows.first + 1) *
           static_cast<std::size_t>(configuration_.parameters.raw_bins());
  }
  /// Row by row, bin by bin, column by column.
  [[nodiscard]] std::vector<ResultAddress> raw_order(RawRows rows) const {
    std::vector<ResultAddress> order;
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int bin = 0; bin < configuration_.parameters.raw_bins(); ++bin) {
        for (int column = 0; column < configuration_.sram_num; ++column) {
          order.push_back({row, column, column == 0});
        }
      }
    }
    return order;
  }

  // Inputs are set; settles the outputs of this clock.
  void settle() {
    *ports_.clock = 0;
    eval(0);
  }
  void rising_edge() {
    *ports_.clock = 1;
    eval(kTracePeriod / 2);
    ++total_cycles_;
    time_ += kTracePeriod;
  }
  void eval(std::uint64_t offset) {
    context_->time(time_ + offset);
    model_->eval();
    if (tracing_) {
      model_->dump_trace(time_ + offset);
    }
  }

  void reset() {
    *ports_.reset_n = 0;
    *ports_.start = 0;
    *ports_.tdc_valid = 0;
    *ports_.result_ready = 0;
    for (int i = 0; i < kResetClocks; ++i) {
      settle();
      rising_edge();
    }
    *ports_.reset_n = 1;
    was_reset_ = true;
  }

  [[nodiscard]] std::uint64_t cycle_limit() const {
    if (options_->cycle_limit > 0) {
      return options_->cycle_limit;
    }
    const auto pixels = static_cast<std::uint64_t>(configuration_.pixels_per_sram);
    const auto codes = static_cast<std::uint64_t>(configuration_.parameters.code_count());
    const std::uint64_t stream =
        acquisitions_ * pixels * static_cast<std::uint64_t>(configuration_.parameters.slots);
    // An engine takes its columns one after the other: decoding a group takes longest.
    const std::uint64_t engine =
        is_pool_readout(configuration_.parameters.readout)
            ? 1000 * pixels * static_cast<std::uint64_t>(configuration_.parameters.pool.engine_columns)
            : 0;
    // Every code of every pixel cleared and scanned, and the results, with room for latencies.
    const std::uint64_t raw = options_->raw ? 16 * expected_beats_ : 0;
    return 2 * stream + 8 * pixels * codes + 8 * expected_beats_ + 100 * codes + engine + raw + 10000;
  }

  void drive_registers(std::uint32_t acquisitions, CodeGate gate) {
    *ports_.acquisitions = static_cast<std::uint16_t>(acquisitions);
    *ports_.gate_begin = static_cast<std::uint16_t>(gate.begin);
    *ports_.gate_end = static_cast<std::uint16_t>(gate.end);
    if (ports_.raw != nullptr) {
      const bool own = acquisitions == acquisitions_;
      *ports_.raw = options_->raw.has_value() == own ? 1 : 0;
      *ports_.raw_first_row = static_cast<std::uint16_t>(own && options_->raw ? options_->raw->first : 0);
      *ports_.raw_last_row = static_cast<std::uint16_t>(own && options_->raw ? options_->raw->last : 0);
    }
    if (ports_.coarse_end != nullptr) {
      const PoolSchedule schedule(acquisitions, configuration_.parameters.pool);
      *ports_.coarse_end = static_cast<std::uint16_t>(schedule.coarse_end);
      *ports_.track_end = static_cast<std::uint16_t>(schedule.track_end);
      const bool own = acquisitions == acquisitions_;
      *ports_.smooth = configuration_.parameters.pool.smooth == own ? 1 : 0;
      *ports_.prior = options_->prior == own ? 1 : 0;
      const PoolTemplate& taken = configuration_.parameters.pool.coarse_template;
      for (std::size_t i = 0; i < taken.size(); ++i) {  // held in the frame
        std::uint32_t& word = ports_.coarse_template[i / 4];
        const auto shift = static_cast<unsigned>(8 * (i % 4));
        word = (word & ~(0xFFU << shift)) | (std::uint32_t{taken[i]} << shift);
      }
    }
  }

  // False if the frame was cut off by the reset.
  bool run_frame(std::optional<std::uint64_t> reset_at) {
    driver_->rewind(options_->pause_probability, options_->empty_slot_probability,
                    control_random(options_->seed, ControlStream::kPause));
    CounterRandom random = control_random(options_->seed, ControlStream::kClock);
    beats_ = 0;
    held_clocks_ = 0;
    pending_beat_ = false;
    row_stall_left_ = options_->row_stall;
    expected_error_ = 0;
    frame_.statistics = RtlStatistics{};
    frame_.counter_full_clocks = 0;
    const std::uint64_t limit = cycle_limit();
    const bool disturb = options_->stall_probability > 0.0 || options_->start_probability > 0.0;
    constexpr std::uint64_t kInterruptionInterval = 1U << 20U;

    for (cycle_ = 0;; ++cycle_) {
      if (reset_at.has_value() && cycle_ >= *reset_at) {
        return false;
      }
      // The array reads its registers with start_i; in all other clocks they are another frame's.
      *ports_.start = cycle_ == 0 ? 1 : 0;
      drive_registers(cycle_ == 0 ? acquisitions_ : acquisitions_ + kOtherFrame, gate_);
      if (disturb) {
        *ports_.result_ready = random.uniform() < options_->stall_probability ? 0 : 1;
        if (cycle_ > 0 && random.uniform() < options_->start_probability) {
          *ports_.start = 1;
          drive_registers(random() % 65536U,
                          {static_cast<int>(random() % 65536U), static_cast<int>(random() % 65536U)});
        }
      }
      if (row_stall_left_ > 0 && beats_ < expected_beats_ && order_[beats_].begins_row) {
        *ports_.result_ready = 0;
      } else if (!disturb) {
        *ports_.result_ready = 1;
      }
      driver_->drive();
      settle();
      const bool done = observe();
      require(*ports_.error == expected_error_, "error_o is not what the clock before says");
      expected_error_ = *ports_.start != 0 && *ports_.busy != 0 ? kRtlStartIgnored : 0;
      held_clocks_ += driver_->pauses() || pending_beat_ ? 1 : 0;
      // A start pulse in the clock after done would begin another frame; the loop ends before it can.
      driver_->finish_clock();
      rising_edge();
      if (done) {
        break;
      }
      if (cycle_ + 1 - held_clocks_ > limit) {
        throw RtlError(fmt::format(
            "{}: the frame did not end within {} clocks; state {}, {} of {} acquisitions begun, {} of {} "
            "results sent",
            configuration_.to_string(), limit, rtl_state_name(static_cast<RtlState>(*ports_.state)),
            driver_->acquisitions_begun(), acquisitions_, beats_, expected_beats_));
      }
      if (cycle_ % kInterruptionInterval == 0) {
        check_interruption();
      }
    }
    frame_.statistics.cycles = cycle_;
    *ports_.start = 0;
    *ports_.tdc_valid = 0;
    settle();
    require(*ports_.busy == 0 && *ports_.state == 0, "busy after done");
    require(*ports_.done == 0, "done_o is longer than one clock");
    require(beats_ == expected_beats_, "done before the last result");
    rising_edge();
    return true;
  }

  void require(bool holds, const char* what) const {
    if (!holds) {
      throw RtlError(fmt::format("{}: {} (clock {}, state {})", configuration_.to_string(), what, cycle_,
                                 rtl_state_name(static_cast<RtlState>(*ports_.state))));
    }
  }

  // Looks at the settled outputs; true in the frame's last clock.
  bool observe() {
    const std::uint8_t state = *ports_.state;
    ++frame_.statistics.state_cycles[state];
    const bool busy = cycle_ > 0;
    require((*ports_.busy != 0) == busy, busy ? "busy_o fell before done" : "busy before start");
    require(busy || *ports_.tdc_ready == 0, "tdc_ready_o is high in IDLE");
    require(*ports_.parity_error == 0, "a word with a wrong parity was read");
    if (ports_.counter_full != nullptr && *ports_.counter_full != 0) {
      ++frame_.counter_full_clocks;
    }
    if (*ports_.result_valid != 0 || pending_beat_) {
      observe_result();
    }
    if (options_->observer) {
      options_->observer({.cycle = cycle_,
                          .state = static_cast<RtlState>(state),
                          .acquisition_start = driver_->begins(),
                          .result_beat = *ports_.result_valid != 0 && *ports_.result_ready != 0,
                          .sram_write = *ports_.probe_write != 0,
                          .sram_address = *ports_.probe_address,
                          .sram_data = *ports_.probe_data});
    }
    return *ports_.done != 0;
  }

  /// Value of a port that not every array has.
  static std::uint16_t value_of(const std::uint16_t* port) {
    return port != nullptr ? *port : std::uint16_t{0};
  }

  void observe_result() {
    require(*ports_.result_valid != 0, "result_tvalid_o fell before tready");
    const Beat beat = {.column = *ports_.result_column,
                       .row = *ports_.result_row,
                       .result = {.code = *ports_.result_code,
                                  .fraction = *ports_.result_fraction,
                                  .confidence = *ports_.result_confidence,
                                  .second = value_of(ports_.result_second),
                                  .amplitude = value_of(ports_.result_amplitude),
                                  .ambient = value_of(ports_.result_ambient)},
                       .last = *ports_.result_last != 0};
    require(!pending_beat_ || beat == last_beat_, "result_tdata_o changed before tready");
    last_beat_ = beat;
    pending_beat_ = *ports_.result_ready == 0;
    if (pending_beat_) {
      row_stall_left_ -= row_stall_left_ > 0 ? 1 : 0;
      return;
    }
    row_stall_left_ = options_->row_stall;
    require(beats_ < expected_beats_, "more results than pixels");
    const ResultAddress& pixel = order_[beats_];
    require(beat.row == pixel.row && beat.column == pixel.column, "result out of order");
    require(beat.last == (beats_ + 1 == expected_beats_), "result_tlast_o on the wrong result");
    // The line of a raw frame is a bin of a row.
    const std::size_t line =
        options_->raw ? beats_ / static_cast<std::size_t>(configuration_.sram_num) : beat.row;
    ++beats_;
    const auto columns = static_cast<std::size_t>(frame_.columns);
    const std::size_t index = line * columns + beat.column;
    if (beat.column < columns && index < frame_.results.size()) {
      frame_.results[index] = beat.result;
      frame_.result_cycles[index] = cycle_;
    }
  }

  struct Beat {
    std::uint16_t column = 0;
    std::uint16_t row = 0;
    PixelResult result;
    bool last = false;
    bool operator==(const Beat&) const = default;
  };

  RtlConfiguration configuration_;
  std::vector<ResultAddress> result_order_;
  std::vector<ResultAddress> order_;           // of this frame
  std::unique_ptr<VerilatedContext> context_;  // outlives the model
  std::unique_ptr<ArrayModel> model_;
  ArrayModel::Ports ports_{};
  bool broken_ = false;
  bool tracing_ = false;
  bool was_reset_ = false;
  std::uint64_t time_ = 0;

  // Belong to the current run.
  TdcDriver* driver_ = nullptr;
  const RtlRunOptions* options_ = nullptr;
  std::uint32_t acquisitions_ = 0;
  CodeGate gate_;
  std::uint64_t expected_beats_ = 0;
  std::uint64_t total_cycles_ = 0;
  std::uint64_t cycle_ = 0;
  std::uint64_t beats_ = 0;
  std::uint64_t held_clocks_ = 0;  // source pauses or sink stalls
  bool pending_beat_ = false;
  std::uint8_t expected_error_ = 0;  // of the clock before
  std::uint64_t row_stall_left_ = 0;
  Beat last_beat_;
  RtlFrame frame_;
};

RtlReadout::RtlReadout(const RtlConfiguration& configuration, bool sram_report)
    : configuration_(configuration),
      simulation_(std::make_unique<Simulation>(configuration, kFirstContentsSeed, sram_report)) {}

RtlReadout::~RtlReadout() = default;

const RtlConfiguration& RtlReadout::configuration() const { return configuration_; }

RtlFrame RtlReadout::run(std::span<const ColumnStream> columns, std::uint32_t acquisitions,
                         const RtlRunOptions& options) {
  if (options.raw &&
      (!configuration_.raw_histogram || options.raw->first < 0 || options.raw->first > options.raw->last ||
       options.raw->last >= configuration_.pixels_per_sram)) {
    throw InputError(fmt::format("{} sends no histograms of rows {} to {}", configuration_.to_string(),
                                 options.raw->first, options.raw->last));
  }
  if (simulation_->broken()) {  // an exception left the model inside an evaluation
    simulation_ = std::make_unique<Simulation>(configuration_, options.seed, false);
  }
  return simulation_->run(columns, acquisitions, configuration_.parameters.time_gate.value_or(CodeGate{}),
                          options);
}

std::vector<RtlSram> RtlReadout::srams() const { return simulation_->srams(); }

void RtlReadout::set_time_gate(CodeGate gate) {
  ReadoutParameters parameters = configuration_.parameters;
  if (!parameters.time_gate) {
    throw InputError(fmt::format("{} has no time gate", configuration_.to_string()));
  }
  parameters.time_gate = gate;
  parameters.validate();
  configuration_.parameters = parameters;
}

}  // namespace dtof
