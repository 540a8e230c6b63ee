// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_study.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/random.hpp"
#include "faults/stream_faults.hpp"
#include "rtl/error.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {
namespace {

// Fewer faults of the other kinds than flipped bits; an array has few engines, one flip of whose scratch
// memory fits into a frame.
constexpr int kFlipsPerPixelFault = 3;
constexpr int kFlipsPerScratchFlip = 6;
constexpr int kFlipsPerColumnFault = 12;
constexpr int kResetsPerState = 3;
constexpr int kFramesPerJob = 6;
/// poolPointer's engines decode, choose and decide in these.
constexpr std::array kEngineStates = {RtlState::kM1, RtlState::kM3, RtlState::kM5};

int pick(CounterRandom& random, int count) {
  return static_cast<int>(random.bits64() % static_cast<std::uint64_t>(count));
}

/// Whether this column, or engine, has a fault in this frame: two of three have one, in turns.
bool has_fault(int place, int frame) { return (place + frame) % 3 != 0; }

/// A column with a fault, and the columns whose results depend on this column.
struct FaultPlace {
  int column;
  ColumnRange reach;
};

/// An SRAM with a fault, and the columns whose results depend on this SRAM.
struct FaultySram {
  RtlSram sram;
  ColumnRange reach;
};

bool overlap(ColumnRange left, ColumnRange right) {
  return left.first < right.first + right.count && right.first < left.first + left.count;
}

/// A frame's worth of faults: what it feeds the array with, and what happens in its clocks.
struct FaultyFrame {
  std::vector<FaultReach> reaches;                   ///< one per fault
  std::vector<ColumnStream> columns;                 ///< of the whole array, if the timestamps have faults
  std::function<void(const RtlCycle&)> disturbance;  ///< if the array has
};

/// Plans the faults of frame number `frame` of a case.
class FaultPlan {
 public:
  FaultPlan(const FaultSubject& subject, const FaultCase& fault, std::vector<ArraySram> srams, int frame,
            CounterRandom random)
      : subject_(subject), fault_(fault), srams_(std::move(srams)), frame_(frame), random_(random) {
    std::erase_if(srams_, [&](const ArraySram& sram) { return sram.kind != fault.sram; });
  }

  FaultyFrame make() {
    switch (fault_.kind) {
      case FaultKind::kFlippedBit:
      case FaultKind::kFlippedBitAtWork:
        return flipped_bits();
      case FaultKind::kStuckBit:
        return stuck_bits();
      default:
        return stream_faults();
    }
  }

 private:
  /// Returns one fault for each set of columns whose results depend on each other.
  std::vector<FaultPlace> places() {
    const int together = subject_.parameters().columns_together();
    std::vector<FaultPlace> found;
    for (int first = 0; first < kFaultColumns; first += together) {
      if (has_fault(first / together, frame_)) {
        found.push_back({together > 1 ? first + pick(random_, together) : first, {first, together}});
      }
    }
    return found;
  }

  /// No column depends on two of these SRAMs. The columns of two engines depend on an SRAM that lies across
  /// their border.
  [[nodiscard]] std::vector<FaultySram> faulty_srams() const {
    std::vector<FaultySram> found;
    for (std::size_t i = 0; i < srams_.size(); ++i) {
      const ColumnRange reach =
          affected_columns(srams_[i].columns, subject_.parameters().columns_together(), kFaultColumns);
      const bool is_free =
          std::ranges::none_of(found, [&](const FaultySram& other) { return overlap(other.reach, reach); });
      if (has_fault(static_cast<int>(i), frame_) && is_free) {
        found.push_back({srams_[i].sram, reach});
      }
    }
    return found;
  }

  struct Flip {
    RtlSram sram;
    std::uint64_t clock;
    int word;
    int bit;
  };

  std::uint64_t random_clock() {
    std::uint64_t clocks = 0;
    const auto counts = [&](std::size_t state) {
      return fault_.kind == FaultKind::kFlippedBit ||
             std::ranges::find(kEngineStates, static_cast<RtlState>(state)) != kEngineStates.end();
    };
    for (std::size_t state = 0; state < kRtlStateCount; ++state) {
      clocks += counts(state) ? subject_.clocks(static_cast<RtlState>(state)).size() : 0;
    }
    std::uint64_t index = random_.bits64() % clocks;
    for (std::size_t state = 0;; ++state) {
      const std::vector<std::uint64_t>& candidates = subject_.clocks(static_cast<RtlState>(state));
      if (!counts(state)) {
        continue;
      }
      if (index < candidates.size()) {
        return candidates[index];
      }
      index -= candidates.size();
    }
  }

  FaultyFrame flipped_bits() {
    FaultyFrame faulty;
    std::vector<Flip> flips;
    for (const auto& [sram, reach] : faulty_srams()) {
      flips.push_back({sram, random_clock(), pick(random_, sram.words()), pick(random_, sram.width())});
      faulty.reaches.push_back({reach, std::nullopt});
    }
    faulty.disturbance = [flips](const RtlCycle& clock) mutable {
      for (Flip& flip : flips) {
        if (flip.clock == clock.cycle) {
          flip.sram.set_bit(flip.word, flip.bit, !flip.sram.bit(flip.word, flip.bit));
        }
      }
    };
    return faulty;
  }

  FaultyFrame stuck_bits() {
    struct Stuck {
      RtlSram sram;
      int bit;
      bool value;
    };
    FaultyFrame faulty;
    std::vector<Stuck> stuck;
    for (const auto& [sram, reach] : faulty_srams()) {
      stuck.push_back({sram, pick(random_, sram.width()), pick(random_, 2) != 0});
      faulty.reaches.push_back({reach, std::nullopt});
    }
    // A bit that reads the same from every word: the word that is read in this clock has it.
    faulty.disturbance = [stuck](const RtlCycle&) mutable {
      for (Stuck& fault : stuck) {
        const int word = fault.sram.read_address();
        if (word < fault.sram.words()) {
          fault.sram.set_bit(word, fault.bit, fault.value);
        }
      }
    };
    return faulty;
  }

  FaultyFrame stream_faults() {
    FaultyFrame faulty;
    faulty.columns = subject_.scene().frame;
    for (const FaultPlace& place : places()) {
      const int row = pick(random_, kFaultRows);
      ColumnStream& stream = faulty.columns[static_cast<std::size_t>(place.column)];
      stream = faulty_stream(stream, row);
      FaultReach reach{place.reach, PixelPlace{place.column, row}};
      if (fault_.kind == FaultKind::kStuckTimestamps) {
        reach.faulty_pixel.reset();
      }
      faulty.reaches.push_back(reach);
    }
    return faulty;
  }

  ColumnStream faulty_stream(const ColumnStream& stream, int row) {
    const std::uint32_t acquisitions = subject_.scene().acquisitions;
    const int slots = subject_.parameters().slots;
    const auto random_code = [&] {
      return static_cast<Timestamp>(pick(random_, subject_.parameters().no_detection()));
    };
    const Timestamp code = random_code();
    switch (fault_.kind) {
      case FaultKind::kStuckTimestamps:
        return with_stuck_timestamps(stream, acquisitions, slots, code);
      case FaultKind::kHotPixelFixedCode:
        return with_hot_pixel(stream, row, acquisitions, slots, [code] { return code; });
      case FaultKind::kHotPixelRandomCode:
        return with_hot_pixel(stream, row, acquisitions, slots, random_code);
      default:
        return with_dead_pixel(stream, row);
    }
  }

  const FaultSubject& subject_;
  FaultCase fault_;
  std::vector<ArraySram> srams_;
  int frame_;
  CounterRandom random_;
};

/// Runs frames of one case on an array of its own.
class FaultRunner {
 public:
  FaultRunner(const FaultSubject& subject, const FaultCase& fault, std::uint64_t seed)
      : subject_(subject), seed_(seed), rtl_(subject.configuration()) {
    result_.fault = fault;
  }

  void run(int frame) {
    const FaultCase& fault = result_.fault;
    CounterRandom random(seed_, static_cast<std::uint32_t>(RandomPurpose::kFaults), stream_number(),
                         static_cast<std::uint32_t>(frame));
    ++result_.frames;
    try {
      if (fault.kind == FaultKind::kReset) {
        run_reset(*fault.state, random);
      } else {
        run_faulty(FaultPlan(subject_, fault, array_srams(rtl_), frame, random).make());
        run_next();
      }
    } catch (const RtlError&) {
      ++result_.broken_frames;  // the next frame gets a new array
    }
  }

  [[nodiscard]] const FaultCaseResult& result() const { return result_; }

 private:
  /// Number of this case's random stream. A case draws the same numbers whatever other cases run.
  [[nodiscard]] std::uint32_t stream_number() const {
    constexpr int kCasesPerPart = 10;
    const FaultCase& fault = result_.fault;
    int number = static_cast<int>(fault.readout);
    number = number * kCasesPerPart + static_cast<int>(fault.kind);
    number = number * kCasesPerPart + (fault.sram ? static_cast<int>(*fault.sram) : 0);
    number = number * kCasesPerPart + (fault.state ? static_cast<int>(*fault.state) : 0);
    return static_cast<std::uint32_t>(number);
  }

  void run_faulty(const FaultyFrame& faulty) {
    const FaultScene& scene = subject_.scene();
    const bool stream_fault = !faulty.columns.empty();
    RtlRunOptions options;
    options.reset_first = false;
    options.observer = faulty.disturbance;
    const std::vector<PixelResult> actual =
        rtl_.run(stream_fault ? faulty.columns : scene.frame, scene.acquisitions, options).results;
    if (stream_fault && actual != subject_.model(faulty.columns, scene.acquisitions)) {
      ++result_.model_mismatches;
    }
    for (const FaultReach& reach : faulty.reaches) {
      result_.effects.push_back(fault_effect(subject_, actual, reach));
    }
    result_.changed_elsewhere += changed_elsewhere(subject_, actual, faulty.reaches);
  }

  void run_next() {
    RtlRunOptions options;
    options.reset_first = false;
    const FaultScene& scene = subject_.scene();
    const RtlFrame next = rtl_.run(scene.next, scene.next_acquisitions, options);
    check_next(next.results == subject_.expected_next());
  }

  void run_reset(RtlState state, CounterRandom& random) {
    const std::vector<std::uint64_t>& clocks = subject_.clocks(state);
    RtlRunOptions options;
    options.reset_first = false;
    options.reset_at = clocks[random.bits64() % clocks.size()];
    const FaultScene& scene = subject_.scene();
    const RtlFrame whole = rtl_.run(scene.frame, scene.acquisitions, options);
    check_next(whole.results == subject_.expected());
  }

  void check_next(bool right) {
    ++result_.next_frames;
    result_.wrong_next_frames += right ? 0 : 1;
  }

  const FaultSubject& subject_;
  std::uint64_t seed_;
  RtlReadout rtl_;
  FaultCaseResult result_;
};

/// A case and how many frames of it are run.
struct PlannedCase {
  const FaultSubject* subject;
  FaultCase fault;
  int frames;
};

void plan_cases(const FaultSubject& subject, const FaultStudyOptions& options,
                std::vector<PlannedCase>& cases) {
  const Readout readout = subject.parameters().readout;
  const std::vector<ArraySram> srams = array_srams(RtlReadout(subject.configuration()));
  const int engines_apart = kFaultColumns / subject.parameters().columns_together();
  // Frames for `faults` faults on two thirds of `places` in each.
  const auto add = [&](const FaultCase& fault, int faults, int places) {
    cases.push_back({&subject, fault, std::max((3 * faults + 2 * places - 1) / (2 * places), 1)});
  };
  for (const SramKind kind : sram_kinds(srams)) {
    const auto places =
        std::min(static_cast<int>(std::ranges::count(srams, kind, &ArraySram::kind)), engines_apart);
    const bool scratch = kind == SramKind::kEngineScratch;
    const int flips = scratch ? options.flips / kFlipsPerScratchFlip : options.flips;
    add({readout, FaultKind::kFlippedBit, kind, std::nullopt}, flips, places);
    if (scratch) {
      add({readout, FaultKind::kFlippedBitAtWork, kind, std::nullopt}, flips, places);
    }
    add({readout, FaultKind::kStuckBit, kind, std::nullopt}, options.flips / kFlipsPerColumnFault, places);
  }
  add({readout, FaultKind::kStuckTimestamps, std::nullopt, std::nullopt},
      options.flips / kFlipsPerColumnFault, kFaultColumns);
  for (const FaultKind kind :
       {FaultKind::kHotPixelFixedCode, FaultKind::kHotPixelRandomCode, FaultKind::kDeadPixel}) {
    add({readout, kind, std::nullopt, std::nullopt}, options.flips / kFlipsPerPixelFault, kFaultColumns);
  }
  for (std::size_t state = 0; state < kRtlStateCount; ++state) {
    if (!subject.clocks(static_cast<RtlState>(state)).empty()) {
      cases.push_back({&subject,
                       {readout, FaultKind::kReset, std::nullopt, static_cast<RtlState>(state)},
                       kResetsPerState});
    }
  }
}

}  // namespace

void FaultCaseResult::merge(const FaultCaseResult& other) {
  effects.insert(effects.end(), other.effects.begin(), other.effects.end());
  frames += other.frames;
  broken_frames += other.broken_frames;
  model_mismatches += other.model_mismatches;
  changed_elsewhere += other.changed_elsewhere;
  next_frames += other.next_frames;
  wrong_next_frames += other.wrong_next_frames;
}

std::vector<FaultCaseResult> study_faults(const FaultStudyOptions& options) {
  if (options.flips < 1) {
    throw InputError("the study needs at least one flip per kind of SRAM");
  }
  const FaultScene scene = make_fault_scene(options.acquisitions, options.seed);
  std::vector<std::unique_ptr<FaultSubject>> subjects(options.readouts.size());
  parallel_for(subjects.size(), options.threads, [&](std::size_t i) {
    subjects[i] = std::make_unique<FaultSubject>(options.readouts[i], scene);
  });
  std::vector<PlannedCase> cases;
  for (const auto& subject : subjects) {
    plan_cases(*subject, options, cases);
  }

  struct Job {
    std::size_t fault_case;
    int first_frame;
  };
  std::vector<Job> jobs;
  std::size_t frames = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (int frame = 0; frame < cases[i].frames; frame += kFramesPerJob) {
      jobs.push_back({i, frame});
    }
    frames += static_cast<std::size_t>(cases[i].frames);
  }
  Progress progress("faults", frames);
  std::vector<FaultCaseResult> parts(jobs.size());
  parallel_for(jobs.size(), options.threads, [&](std::size_t i) {
    const PlannedCase& planned = cases[jobs[i].fault_case];
    FaultRunner runner(*planned.subject, planned.fault, options.seed);
    const int end = std::min(jobs[i].first_frame + kFramesPerJob, planned.frames);
    for (int frame = jobs[i].first_frame; frame < end; ++frame) {
      runner.run(frame);
      progress.advance();
    }
    parts[i] = runner.result();
  });

  std::vector<FaultCaseResult> results(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    results[i].fault = cases[i].fault;
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    results[jobs[i].fault_case].merge(parts[i]);
  }
  return results;
}

}  // namespace dtof
