// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/metric_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/readout/model.hpp"

namespace dtof {
namespace {

constexpr std::size_t kTriedFlips = 200;  // to find flips of SRAM bits that parity must detect
constexpr std::size_t kSecondFaults = 1;  // of each memory
constexpr std::uint64_t kFlipsSeed = 0x466C6970U;

/// A set of faults that one lane has.
using FaultSet = std::vector<CircuitFault>;

/// Streams of the lines that an array receives.
std::vector<ColumnStream> streams_of(const RtlConfiguration& configuration, const FrameInput& input) {
  const auto rows = static_cast<std::size_t>(configuration.pixels_per_sram);
  const auto slots = static_cast<std::size_t>(configuration.parameters.slots);
  const auto none = static_cast<Timestamp>(configuration.parameters.no_detection());
  std::vector<ColumnStream> columns(static_cast<std::size_t>(configuration.sram_num));
  for (std::size_t column = 0; column < columns.size(); ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < input.acquisitions; ++acquisition) {
        for (std::size_t slot = 0; slot < slots; ++slot) {
          const Timestamp code = input.lines[(acquisition * rows + row) * slots + slot][column];
          if (code != none) {
            columns[column].append({acquisition, code});
          }
        }
      }
      columns[column].finish_row();
    }
  }
  return columns;
}

/// Runs the netlist without a fault and compares with the model.
FrameReference checked_reference(const GateNetlist& netlist, const FrameInput& input, std::uint64_t seed) {
  const RtlConfiguration configuration = netlist_configuration(netlist);
  FrameReference reference = run_reference(netlist, input, seed);
  const std::vector<PixelResult> results = reference_results(netlist, reference);
  const auto expected = make_readout_model(configuration.parameters)
                            ->run_columns(streams_of(configuration, input), input.acquisitions);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::size_t columns = expected.size();
    const PixelResult& right = expected[i % columns][i / columns];
    if (results[i].code != right.code || results[i].fraction != right.fraction ||
        results[i].confidence != right.confidence) {
      throw InputError(fmt::format("{}: pixel {} of the netlist without a fault differs from its model",
                                   netlist.readout, i));
    }
  }
  return reference;
}

/// A frame of the array and what the frame gives without a fault.
struct Frame {
  const FrameInput& input;
  FrameReference reference;
};

/// Runs each set of faults in a lane of its own. Outcomes are in the order of the sets.
std::vector<FrameOutcome> run_sets(const GateNetlist& netlist, const Frame& frame,
                                   const std::vector<FaultSet>& sets, std::string_view title,
                                   const MetricStudyOptions& options) {
  std::vector<FrameOutcome> outcomes(sets.size());
  if (sets.empty()) {
    return outcomes;
  }
  const std::size_t batches = (sets.size() + kFaultyLanes - 1) / kFaultyLanes;
  Progress progress(fmt::format("{}{}, {}", netlist.readout, netlist.parity ? " with parity" : "", title),
                    batches);
  parallel_for(batches, options.threads, [&](std::size_t batch) {
    const std::size_t first = batch * kFaultyLanes;
    const std::size_t count = std::min(kFaultyLanes, sets.size() - first);
    std::vector<LaneFault> faults;
    for (std::size_t i = 0; i < count; ++i) {
      for (const CircuitFault& fault : sets[first + i]) {
        faults.push_back({kFirstFaultyLane + i, fault});
      }
    }
    const std::vector<FrameOutcome> lanes =
        run_lanes(netlist, frame.input, frame.reference, faults, options.seed);
    std::copy_n(lanes.begin() + kFirstFaultyLane, count,
                outcomes.begin() + static_cast<std::ptrdiff_t>(first));
    progress.advance();
  });
  return outcomes;
}

/// The faults of all strata one after the other, and the stratum of each.
struct DrawnFaults {
  std::vector<FaultSet> sets;
  std::vector<std::size_t> strata;

  void add(const std::vector<CircuitFault>& faults, std::size_t stratum) {
    for (const CircuitFault& fault : faults) {
      sets.push_back({fault});
      strata.push_back(stratum);
    }
  }
};

/// Flips of stored bits that are harmful and that parity detects: up to kSecondFaults of each memory.
std::vector<CircuitFault> second_faults(const GateNetlist& netlist, const Frame& frame,
                                        const MetricStudyOptions& options) {
  std::vector<FaultSet> tried;
  for (std::uint32_t memory = 0; memory < netlist.memories.size(); ++memory) {
    FaultStratum words;
    words.element = Element::kBit;
    const Memory& one = netlist.memories[memory];
    for (std::uint32_t bit = 0; bit < one.depth * one.width(); ++bit) {
      words.sites.push_back({SiteKind::kBit, memory, bit});
    }
    for (const CircuitFault& fault :
         draw_events(words, kTriedFlips, frame.reference.clocks, options.seed ^ (kFlipsSeed + memory))) {
      tried.push_back({fault});
    }
  }
  const std::vector<FrameOutcome> outcomes = run_sets(netlist, frame, tried, "second faults", options);
  std::vector<CircuitFault> found;
  std::vector<std::size_t> of_memory(netlist.memories.size());
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const CircuitFault& fault = tried[i].front();
    const bool fits = outcomes[i].harmful() && outcomes[i].parity_error && !outcomes[i].frame_check() &&
                      !outcomes[i].protocol_error;
    if (fits && of_memory[fault.site.index] < kSecondFaults) {
      ++of_memory[fault.site.index];
      found.push_back(fault);
    }
  }
  return found;
}

/// Counts the faults that are not seen, and that hide a second fault. They are sets `unseen` of `drawn`.
void count_latent(const GateNetlist& netlist, const Frame& frame, const DrawnFaults& drawn,
                  const std::vector<std::size_t>& unseen, const MetricStudyOptions& options,
                  ArrayResult& result) {
  const std::vector<CircuitFault> seconds = second_faults(netlist, frame, options);
  std::vector<FaultSet> pairs;
  for (const std::size_t set : unseen) {
    for (const CircuitFault& second : seconds) {
      pairs.push_back({drawn.sets[set].front(), second});
    }
  }
  const std::vector<FrameOutcome> outcomes = run_sets(netlist, frame, pairs, "latent faults", options);
  for (std::size_t i = 0; i < unseen.size(); ++i) {
    const auto first = outcomes.begin() + static_cast<std::ptrdiff_t>(i * seconds.size());
    const bool hides = std::any_of(first, first + static_cast<std::ptrdiff_t>(seconds.size()),
                                   [](const FrameOutcome& one) { return one.harmful() && !one.detected(); });
    result.strata[drawn.strata[unseen[i]]].stuck.latent += hides ? 1 : 0;
  }
}

}  // namespace

void count_fault(FaultCounts& counts, const FrameOutcome& frame, const FrameOutcome* self_test) {
  ++counts.faults;
  if (!frame.harmful()) {
    return;
  }
  ++counts.harmful;
  counts.beyond += frame.beyond ? 1 : 0;
  if (frame.parity_error) {
    ++counts.by_parity;
  } else if (frame.protocol_error) {
    ++counts.by_protocol;
  } else if (frame.frame_check()) {
    ++counts.by_frame_check;
  } else if (self_test != nullptr && (self_test->harmful() || self_test->detected())) {
    ++counts.by_self_test;
  } else {
    ++counts.undetected;
    counts.undetected_beyond += frame.beyond ? 1 : 0;
  }
}

bool stays_unseen(const FrameOutcome& frame, const FrameOutcome& self_test) {
  return !frame.harmful() && !frame.detected() && !self_test.harmful() && !self_test.detected();
}

ArrayResult study_netlist(const GateNetlist& netlist, const MetricStudyOptions& options) {
  if (options.faults < 1) {
    throw InputError("the study needs at least one fault of each kind");
  }
  const StudyInputs inputs = study_inputs(netlist, options.acquisitions, options.seed);
  const Frame room{inputs.room, checked_reference(netlist, inputs.room, options.seed)};
  const Frame self_test{inputs.self_test, checked_reference(netlist, inputs.self_test, options.seed)};
  const std::vector<FaultStratum> strata = fault_strata(netlist);
  ArrayResult result{.readout = netlist.readout,
                     .parity = netlist.parity,
                     .rows = netlist.rows,
                     .columns = netlist.columns,
                     .clocks = room.reference.clocks,
                     .strata = {}};
  DrawnFaults events, stuck;
  for (std::size_t i = 0; i < strata.size(); ++i) {
    const FaultStratum& stratum = strata[i];
    result.strata.push_back(
        {stratum.part, stratum.element, stratum.repeated, stratum.sites.size(), stratum.full_sites, {}, {}});
    events.add(draw_events(stratum, options.faults, room.reference.clocks, options.seed), i);
    stuck.add(draw_stuck(stratum, options.faults, options.seed), i);
  }
  const std::vector<FrameOutcome> after_events = run_sets(netlist, room, events.sets, "events", options);
  for (std::size_t i = 0; i < events.sets.size(); ++i) {
    count_fault(result.strata[events.strata[i]].events, after_events[i], nullptr);
  }
  const std::vector<FrameOutcome> in_frame = run_sets(netlist, room, stuck.sets, "stuck faults", options);
  const std::vector<FrameOutcome> in_test = run_sets(netlist, self_test, stuck.sets, "self-tests", options);
  std::vector<std::size_t> unseen;
  for (std::size_t i = 0; i < stuck.sets.size(); ++i) {
    count_fault(result.strata[stuck.strata[i]].stuck, in_frame[i], &in_test[i]);
    if (stays_unseen(in_frame[i], in_test[i])) {
      unseen.push_back(i);
    }
  }
  if (netlist.parity) {
    count_latent(netlist, room, stuck, unseen, options, result);
  }
  return result;
}

}  // namespace dtof
