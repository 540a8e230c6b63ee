// SPDX-License-Identifier: Apache-2.0
#include "subsystem/subsystem_bench.hpp"

#include <fmt/format.h>
#include <verilated.h>

#include <algorithm>

#include "dtof_registers.h"
#include "rtl/error.hpp"
#include "rtl/write_coverage.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kTransferClocks = 1000;

enum class Stream : std::uint32_t { kBus = 101, kSource = 102, kSink = 103 };

CounterRandom stream(std::uint64_t seed, Stream which) {
  return {seed, static_cast<std::uint32_t>(RandomPurpose::kTestControl), static_cast<std::uint32_t>(which),
          0};
}

}  // namespace

SubsystemBench::SubsystemBench(const CompiledSubsystem& subsystem, std::uint64_t seed)
    : configuration_(subsystem.configuration),
      context_(std::make_unique<VerilatedContext>()),
      model_([&] {
        Verilated::threadContextp(context_.get());
        context_->randReset(2);  // memories and uninitialised registers start random
        context_->randSeed(static_cast<int>(seed % 0x7FFFFFFFU) + 1);
        const char* program = "dtof";  // the RTL looks for +sram_report
        context_->commandArgs(1, &program);
        return subsystem.factory(*context_);
      }()),
      ports_(model_->ports()),
      bus_(ports_, stream(seed, Stream::kBus)),
      source_(ports_, configuration_.parameters.np, stream(seed, Stream::kSource)),
      sink_(ports_, stream(seed, Stream::kSink)),
      acquisition_lines_(static_cast<std::size_t>(configuration_.pixels_per_sram) *
                         static_cast<std::size_t>(configuration_.parameters.slots)),
      reference_(acquisition_lines_, static_cast<Timestamp>(configuration_.parameters.no_detection())) {
  reset();
  buffer_lines_ = (get(DTOF_LINES) & DTOF_LINES_BUFFER_MASK) >> DTOF_LINES_BUFFER_LSB;
  const std::uint32_t readout = get(DTOF_READOUT);
  clock_waits_ = (readout & DTOF_READOUT_CLOCK_WAITS_MASK) != 0;
  source_waits_ = (readout & DTOF_READOUT_SOURCE_WAITS_MASK) != 0;
  raster_order_ = (readout & DTOF_READOUT_RASTER_ORDER_MASK) != 0;
  reference_.set_build({.clock_waits = clock_waits_,
                        .source_waits = source_waits_,
                        .buffer_lines = buffer_lines_,
                        .slots = static_cast<std::size_t>(configuration_.parameters.slots)});
  written_.release = most_release();
  committed_ = written_;
}

SubsystemBench::~SubsystemBench() {
  Verilated::threadContextp(context_.get());
  write_coverage(*context_);
}

void SubsystemBench::reset(bool source_too, int clocks) {
  if (source_too) {
    source_.reset();
  }
  sink_.reset();
  bus_.reset();
  reference_.reset();
  shot_reference_.reset();
  shot_ = false;
  settle_left_ = 0;
  array_held_ = false;
  behind_reset_ = true;
  written_ = {.release = most_release()};
  committed_ = written_;
  *ports_.reset_n = 0;
  for (int i = 0; i < clocks; ++i) {
    source_.drive();
    bus_.drive();
    *ports_.clock = 0;
    model_->eval();
    if (i > 0 && *ports_.line_ready != 0) {  // from the first edge on, whatever stood there at power-up
      throw RtlError("a line is taken in reset");
    }
    *ports_.clock = 1;
    model_->eval();
  }
  *ports_.reset_n = 1;
}

void SubsystemBench::clock() {
  source_.drive();
  sink_.drive();
  bus_.drive();
  *ports_.clock = 0;
  context_->time(2 * cycle_);
  model_->eval();
  bus_.observe();
  observe_lines();
  sink_.observe();
  if (*ports_.abort != 0) {
    events().aborted = sink_.cut() || events().aborted;
  }
  *ports_.clock = 1;
  context_->time(2 * cycle_ + 1);
  model_->eval();
  ++cycle_;
}

void SubsystemBench::clocks(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    clock();
  }
}

void SubsystemBench::wait_for_frames(std::size_t frames, std::uint64_t limit) {
  const std::size_t goal = sink_.frames().size() + frames;
  for (std::uint64_t i = 0; sink_.frames().size() < goal; ++i) {
    if (i >= limit) {
      throw RtlError(fmt::format("{}: {} of {} frames within {} clocks, {} words of the next, {} lines wait",
                                 configuration_.to_string(), sink_.frames().size(), goal, limit,
                                 sink_.current().size(), source_.waiting()));
    }
    clock();
  }
}

void SubsystemBench::run_transfer() {
  for (std::uint64_t i = 0; bus_.busy(); ++i) {
    if (i >= kTransferClocks) {
      throw RtlError("a register's transfer does not end");
    }
    clock();
  }
}

BusResponse SubsystemBench::read(std::uint32_t offset) {
  run_transfer();  // of a begin_write
  bus_.read(offset);
  run_transfer();
  return bus_.response();
}

BusResponse SubsystemBench::write(std::uint32_t offset, std::uint32_t data, std::uint8_t strobe) {
  run_transfer();  // of a begin_write
  bus_.write(offset, data, strobe);
  if (offset == DTOF_SHOT_SEED) {
    shot_reference_.set_seed(data);  // valid in a clock of the transfer
  }
  run_transfer();
  if (offset == DTOF_RELEASE && strobe == RegisterBus::kAllBytes) {
    written_.release = data;
  }
  if (offset == DTOF_ACQUISITIONS && strobe == RegisterBus::kAllBytes) {
    written_.acquisitions = data;
  }
  if (offset == DTOF_SETTLE && strobe == RegisterBus::kAllBytes) {
    written_.settle = data;
  }
  if (offset == DTOF_SHOT && strobe == RegisterBus::kAllBytes) {
    written_.shot.bits = (data & DTOF_SHOT_BITS_MASK) >> DTOF_SHOT_BITS_LSB;
    written_.shot.unit = (data & DTOF_SHOT_UNIT_MASK) >> DTOF_SHOT_UNIT_LSB;
  }
  if (offset == DTOF_OUTPUT && strobe == RegisterBus::kAllBytes) {
    written_.second =
        configuration_.parameters.pool.second_target && (data & DTOF_OUTPUT_SECOND_TARGET_MASK) != 0;
    written_.raw = configuration_.raw_histogram && (data & DTOF_OUTPUT_RAW_MASK) != 0;
    written_.short_words = (data & DTOF_OUTPUT_SHORT_WORDS_MASK) != 0;
    written_.amplitude = configuration_.parameters.pool.amplitude && (data & DTOF_OUTPUT_AMPLITUDE_MASK) != 0;
  }
  if (offset == DTOF_RAW_ROWS && strobe == RegisterBus::kAllBytes) {
    written_.raw_rows = data;
  }
  return bus_.response();
}

std::uint32_t SubsystemBench::get(std::uint32_t offset) {
  const BusResponse response = read(offset);
  if (response.error) {
    throw RtlError(fmt::format("register 0x{:03x} does not read", offset));
  }
  return response.data;
}

void SubsystemBench::set(std::uint32_t offset, std::uint32_t data) {
  if (write(offset, data).error) {
    throw RtlError(fmt::format("register 0x{:03x} does not write", offset));
  }
}

Line SubsystemBench::array_line() const {
  const auto width = static_cast<std::size_t>(configuration_.parameters.np);
  Line line(static_cast<std::size_t>(configuration_.sram_num));
  for (std::size_t column = 0; column < line.size(); ++column) {
    const std::size_t bit = column * width;
    std::uint64_t bits = ports_.array_line[bit / 32];
    if (bit % 32 + width > 32) {
      bits |= std::uint64_t{ports_.array_line[bit / 32 + 1]} << 32U;
    }
    line[column] = static_cast<Timestamp>((bits >> (bit % 32)) & ((std::uint64_t{1} << width) - 1));
  }
  return line;
}

void SubsystemBench::check_array_offer(bool here) const {
  const bool offered = *ports_.array_valid != 0;
  if (*ports_.test_frame != 0) {
    if (offered != (!frames_.empty() && frames_.back().self_test && *ports_.running != 0)) {
      throw RtlError(
          fmt::format("a self-test offers the array {}", offered ? "a line behind its end" : "nothing"));
    }
    return;
  }
  if (offered != (here && settle_left_ == 0)) {
    throw RtlError(fmt::format("the array is offered {}, {} acquisitions are to be dropped",
                               offered ? "a line" : "nothing", settle_left_));
  }
}

void SubsystemBench::begin_frame() {
  frames_.emplace_back();
  frames_.back().self_test = *ports_.test_begin != 0;
  begin_cycle_ = cycle_;
  settle_left_ = committed_.acquisitions > 0 && !frames_.back().self_test ? committed_.settle : 0;
  reference_.set_release(committed_.release);
  reference_.begin();
  if (!frames_.back().self_test) {
    sink_.expect_frame(words(), committed_.short_words && !committed_.raw, committed_.amplitude);
  }
}

void SubsystemBench::observe_self_test() {
  if (*ports_.test_frame != 0 && *ports_.result_valid != 0) {
    throw RtlError("a word of a self-test leaves");
  }
  if (*ports_.test_take != 0) {
    if (*ports_.array_line_ready != 0) {
      throw RtlError("a self-test takes a line of the source");
    }
    frames_.back().lines.push_back(array_line());
  }
}

void SubsystemBench::take_array_line() {
  const Line line = array_line();
  reference_.take(line);
  if (settle_left_ == 0) {
    frames_.back().lines.push_back(line);
  } else if (!reference_.inside()) {
    --settle_left_;
  }
  frames_.back().lost = reference_.underruns();
}

std::size_t SubsystemBench::words() const {
  const auto columns = static_cast<std::size_t>(configuration_.sram_num);
  if (committed_.raw) {
    const std::size_t first = (committed_.raw_rows & DTOF_RAW_ROWS_FIRST_MASK) >> DTOF_RAW_ROWS_FIRST_LSB;
    const std::size_t last = (committed_.raw_rows & DTOF_RAW_ROWS_LAST_MASK) >> DTOF_RAW_ROWS_LAST_LSB;
    return (last - first + 1) * static_cast<std::size_t>(configuration_.parameters.raw_bins()) * columns;
  }
  return static_cast<std::size_t>(configuration_.pixels_per_sram) * columns * (committed_.second ? 2 : 1);
}

void SubsystemBench::observe_shot(ShotClock now) {
  now.begin = *ports_.begin != 0;
  now.done = *ports_.done != 0;
  now.abort = *ports_.abort != 0;
  now.flush = *ports_.flush != 0;
  now.reseed = *ports_.reseed != 0;
  now.gave_up = reference_.gave_up() && !now.abort;
  if (now.begin) {
    ShotReference::Settings settings = committed_.shot;
    settings.acquisitions = committed_.acquisitions > 0 && *ports_.test_begin == 0
                                ? committed_.acquisitions + committed_.settle
                                : 0;
    shot_reference_.set(settings);
  }
  shot_ = *ports_.shot != 0;
  if (shot_reference_.clock(now) != shot_) {
    throw RtlError(fmt::format("a shot is {}", shot_ ? "fired that nobody needs" : "missing"));
  }
  if (shot_) {
    if (frames_.empty()) {
      throw RtlError("a shot before the first frame");
    }
    frames_.back().shots.push_back(cycle_ - begin_cycle_);
  }
}

void SubsystemBench::observe_lines() {
  const bool commanded = *ports_.abort != 0 || *ports_.flush != 0 || reference_.expires() || behind_reset_;
  const bool offered = *ports_.array_line_valid != 0;
  const bool ready = *ports_.array_line_ready != 0;
  const bool rests = *ports_.line_waits != 0;
  rests_ += rests ? 1 : 0;
  if (!offered && (array_held_ || reference_.inside())) {
    throw RtlError("an acquisition was interrupted");
  }
  ShotClock now{.inside = reference_.hunting() || reference_.source_index() > 0,
                .taken = offered && ready && !rests && !reference_.inside()};
  check_array_offer(offered && !rests);
  if (offered && ready && !rests) {
    take_array_line();
  }
  observe_self_test();
  const bool refused = *ports_.line_valid != 0 && *ports_.line_ready == 0;
  const bool sink_refuses = *ports_.result_valid != 0 && *ports_.result_ready == 0;
  if (refused && !commanded && reference_.exact() && reference_.waiting() < buffer_lines_) {
    throw RtlError(fmt::format("a line is refused with {} of {} lines in the buffer", reference_.waiting(),
                               buffer_lines_));
  }
  if (refused && !source_waits_ && !behind_reset_) {
    throw RtlError("a line of a source that cannot wait is refused");
  }
  const bool dropped = *ports_.dropped != 0;
  dropped_ += dropped ? 1 : 0;
  events().overrun = events().overrun || ((refused || dropped) && sink_refuses);
  bool last = false;
  const Line* line = source_.observe(&last);
  const bool thrown = *ports_.abort != 0 || *ports_.flush != 0;
  reference_.set_watchdog(*ports_.watchdog);
  reference_.wait({.array_ready = ready,
                   .array_valid = offered,
                   .array_rests = rests,
                   .sink_refuses = sink_refuses,
                   .line_stored = line != nullptr && !dropped && !thrown,
                   .aborts = *ports_.abort != 0});
  now.early = reference_.early();
  if (reference_.gave_up()) {  // an acquisition that has begun to leave goes on
    settle_left_ = std::min(settle_left_, reference_.inside() ? 1U : 0U);
  }
  if (line != nullptr) {
    now.arrives = !reference_.hunting() && reference_.source_index() == 0;
    now.rest_ends = reference_.hunting() && last;
    now.inside = !last;
    now.dropped = dropped;
    if (dropped) {
      reference_.drop(last);
    } else {
      reference_.accept(*line, last, thrown);
    }
  } else if (dropped) {
    throw RtlError("an acquisition is dropped although no line comes");
  }
  observe_shot(now);
  if (*ports_.done != 0) {
    frames_.back().cycles = cycle_ + 1 - begin_cycle_;
    reference_.done();
  }
  if (*ports_.begin != 0) {
    begin_frame();
  }
  if (*ports_.abort != 0) {
    settle_left_ = 0;
    reference_.abort();
  }
  if (*ports_.flush != 0) {
    reference_.flush();
  }
  // A frame that begins may ask for more lines than the one before, and one that ends takes none any more.
  array_held_ = offered && !ready && !dropped && *ports_.begin == 0 && *ports_.done == 0 &&
                *ports_.abort == 0 && *ports_.flush == 0;
  if (*ports_.commit != 0) {
    committed_ = written_;
  }
  behind_reset_ = false;
}

}  // namespace dtof
