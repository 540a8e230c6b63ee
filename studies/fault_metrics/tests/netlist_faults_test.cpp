// SPDX-License-Identifier: Apache-2.0
// Faults of the netlists that Yosys makes: closed forms, and the Verilated RTL as a second opinion.
#include <gtest/gtest.h>

#include <algorithm>

#include "fault_metrics/metric_study.hpp"
#include "fault_metrics/tests/netlists.hpp"
#include "rtl/registry.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {
namespace {

constexpr MetricStudyOptions kSmall = {.acquisitions = 20, .faults = 60, .seed = 1, .threads = 2};

class NetlistFaults : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_yosys()) {
      GTEST_SKIP() << "yosys is not installed";
    }
  }
};

FaultCounts sum(const ArrayResult& result, CircuitPart part, bool stuck) {
  FaultCounts total;
  for (const StratumResult& one : result.strata) {
    if (one.part == part) {
      const FaultCounts& counts = stuck ? one.stuck : one.events;
      total.faults += counts.faults;
      total.harmful += counts.harmful;
      total.by_parity += counts.by_parity;
      total.by_self_test += counts.by_self_test;
      total.undetected += counts.undetected;
      total.latent += counts.latent;
    }
  }
  return total;
}

// A word with one wrong bit has the wrong parity: what is harmful is detected. Nothing without parity detects
// it.
TEST_F(NetlistFaults, ParityDetectsEveryHarmfulBit) {
  const ArrayResult with = study_netlist(script_netlist("ezpointer_parity"), kSmall);
  const ArrayResult without = study_netlist(script_netlist("ezpointer"), kSmall);
  for (const bool stuck : {false, true}) {
    const FaultCounts words = sum(with, CircuitPart::kWords, stuck);
    EXPECT_GT(words.harmful, 10U);
    EXPECT_EQ(words.by_parity, words.harmful);
    const FaultCounts bare = sum(without, CircuitPart::kWords, stuck);
    EXPECT_EQ(bare.harmful, words.harmful) << "the same bits, clocks and photons";
    EXPECT_EQ(bare.by_parity, 0U);
    EXPECT_EQ(sum(with, CircuitPart::kParityBits, stuck).harmful, 0U);
    EXPECT_EQ(sum(with, CircuitPart::kParityCheck, stuck).harmful, 0U);
  }
  EXPECT_EQ(sum(without, CircuitPart::kWords, false).undetected,
            sum(without, CircuitPart::kWords, false).harmful);
}

TEST_F(NetlistFaults, TheSelfTestFindsMostStuckLogicAndNoEvent) {
  const ArrayResult result = study_netlist(script_netlist("ezpointer_parity"), kSmall);
  const FaultCounts stuck = sum(result, CircuitPart::kColumns, true);
  EXPECT_GT(stuck.by_self_test, stuck.harmful / 2);
  const FaultCounts events = sum(result, CircuitPart::kColumns, false);
  EXPECT_GT(events.undetected, 0U);
  EXPECT_EQ(events.undetected, events.harmful);
}

// An error flip-flop that is stuck at 0 hides every error of its SRAM; one that is stuck at 1 is an error.
TEST_F(NetlistFaults, AStuckErrorFlipFlopIsLatent) {
  const ArrayResult result = study_netlist(script_netlist("ezpointer_parity"), kSmall);
  for (const StratumResult& one : result.strata) {
    if (one.part == CircuitPart::kParityCheck && one.element == Element::kFlipFlop) {
      EXPECT_EQ(one.stuck.faults, 2 * one.sites);
      EXPECT_EQ(one.stuck.latent, one.sites);
    } else if (one.part != CircuitPart::kParityCheck) {
      EXPECT_EQ(one.stuck.latent, 0U) << part_title(one.part);
    }
  }
}

TEST_F(NetlistFaults, ThreadsDoNotChangeTheResult) {
  MetricStudyOptions options = kSmall;
  options.threads = 1;
  EXPECT_EQ(study_netlist(script_netlist("ezpointer_parity"), options),
            study_netlist(script_netlist("ezpointer_parity"), kSmall));
  options.seed = 2;
  EXPECT_NE(study_netlist(script_netlist("ezpointer_parity"), options),
            study_netlist(script_netlist("ezpointer_parity"), kSmall));
}

/// Streams of the frame, as the Verilated array takes them.
std::vector<ColumnStream> streams(const GateNetlist& netlist, const FrameInput& input) {
  const ReadoutParameters parameters = netlist_configuration(netlist).parameters;
  const auto none = static_cast<Timestamp>(parameters.no_detection());
  const auto rows = static_cast<std::size_t>(netlist.rows);
  const auto slots = static_cast<std::size_t>(parameters.slots);
  std::vector<ColumnStream> columns(static_cast<std::size_t>(netlist.columns));
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

// The same flips in the Verilated RTL and in the netlist: each is harmful in both or in none.
TEST_F(NetlistFaults, FlippedBitsAreThoseOfTheRtl) {
  const GateNetlist& netlist = script_netlist("ezpointer");
  const FrameInput input = study_inputs(netlist, kSmall.acquisitions, 1).room;
  const FrameReference reference = run_reference(netlist, input, 1);
  const std::vector<FaultStratum> strata = fault_strata(netlist);
  const auto words = std::ranges::find(strata, CircuitPart::kWords, &FaultStratum::part);
  const std::vector<CircuitFault> flips = draw_events(*words, 200, reference.clocks, 1);
  std::vector<LaneFault> lanes;
  for (const CircuitFault& flip : flips) {
    lanes.push_back({kFirstFaultyLane + lanes.size(), flip});
  }
  const std::vector<FrameOutcome> outcomes = run_lanes(netlist, input, reference, lanes, 1);

  RtlReadout rtl(
      find_rtl_configuration(netlist_configuration(netlist).parameters, netlist.rows, netlist.columns));
  const std::vector<ColumnStream> columns = streams(netlist, input);
  const std::vector<PixelResult> good = rtl.run(columns, input.acquisitions, {}).results;
  std::size_t harmful = 0;
  for (std::size_t i = 0; i < flips.size(); ++i) {
    const Memory& memory = netlist.memories[flips[i].site.index];
    const std::string column = memory.path.substr(0, memory.path.find(']') + 1);
    std::vector<RtlSram> srams = rtl.srams();
    const auto sram = std::ranges::find_if(
        srams, [&](const RtlSram& one) { return one.path().find(column) != std::string::npos; });
    ASSERT_NE(sram, srams.end()) << column;
    const auto word = static_cast<int>(flips[i].site.bit / memory.width());
    const auto bit = static_cast<int>(flips[i].site.bit % memory.width());
    RtlRunOptions options;
    options.observer = [&](const RtlCycle& clock) {
      if (clock.cycle == flips[i].clock) {
        sram->set_bit(word, bit, !sram->bit(word, bit));
      }
    };
    const bool wrong = rtl.run(columns, input.acquisitions, options).results != good;
    EXPECT_EQ(outcomes[kFirstFaultyLane + i].harmful(), wrong)
        << column << " word " << word << " bit " << bit << " clock " << flips[i].clock;
    harmful += wrong ? 1 : 0;
  }
  EXPECT_TRUE(harmful > 20 && harmful < 180) << harmful;
}

}  // namespace
}  // namespace dtof
