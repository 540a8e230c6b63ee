// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/fault_strata.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "dtof/core/parameters.hpp"
#include "dtof/core/random.hpp"

namespace dtof {
namespace {

// Purposes of random numbers.
constexpr std::uint32_t kEvents = 0x45564E54U;
constexpr std::uint32_t kStuck = 0x53545543U;

CounterRandom random_of(const FaultStratum& stratum, std::uint32_t purpose, std::uint64_t seed) {
  const auto place =
      static_cast<std::uint32_t>(stratum.part) << 8U | static_cast<std::uint32_t>(stratum.element);
  return {seed, purpose, place, static_cast<std::uint32_t>(stratum.repeated)};
}

/// Elements of a full array for each element of `netlist`.
double repetitions(const GateNetlist& netlist, Repeated repeated, bool is_bit) {
  const double rows = is_bit ? static_cast<double>(kFullRows) / netlist.rows : 1.0;
  switch (repeated) {
    case Repeated::kColumn:
      return rows * kFullColumns / netlist.columns;
    case Repeated::kEngine: {
      const int engine_columns =
          ReadoutParameters::defaults(parse_readout(netlist.readout)).pool.engine_columns;
      return rows * ((kFullColumns + engine_columns - 1) / engine_columns);
    }
    case Repeated::kArray:
      return 1.0;
  }
  throw std::logic_error("an element of no place");
}

}  // namespace

std::string_view element_title(Element element) {
  switch (element) {
    case Element::kGate:
      return "gates";
    case Element::kFlipFlop:
      return "flip-flops";
    case Element::kBit:
      return "bits";
  }
  throw std::logic_error("an element of no kind");
}

std::vector<FaultStratum> fault_strata(const GateNetlist& netlist) {
  std::map<std::tuple<CircuitPart, Element, Repeated>, std::vector<FaultSite>> found;
  for (std::uint32_t i = 0; i < netlist.gates.size(); ++i) {
    const Gate& gate = netlist.gates[i];
    found[{gate.part, Element::kGate, gate.repeated}].push_back({SiteKind::kGate, i, 0});
  }
  for (std::uint32_t i = 0; i < netlist.flip_flops.size(); ++i) {
    const FlipFlop& flip_flop = netlist.flip_flops[i];
    found[{flip_flop.part, Element::kFlipFlop, flip_flop.repeated}].push_back({SiteKind::kFlipFlop, i, 0});
  }
  for (std::uint32_t i = 0; i < netlist.memories.size(); ++i) {
    const Memory& memory = netlist.memories[i];
    for (std::uint32_t bit = 0; bit < memory.width(); ++bit) {
      found[{CircuitPart::kMemoryControl, Element::kGate, memory.repeated}].push_back(
          {SiteKind::kReadData, i, bit});
    }
    for (std::uint32_t bit = 0; bit < memory.depth * memory.width(); ++bit) {
      const bool parity = bit % memory.width() >= memory.width() - memory.parity_bits;
      found[{parity ? CircuitPart::kParityBits : CircuitPart::kWords, Element::kBit, memory.repeated}]
          .push_back({SiteKind::kBit, i, bit});
    }
  }
  std::vector<FaultStratum> strata;
  for (auto& [place, sites] : found) {
    const auto [part, element, repeated] = place;
    const double full =
        static_cast<double>(sites.size()) * repetitions(netlist, repeated, element == Element::kBit);
    strata.push_back({part, element, repeated, std::move(sites), full});
  }
  return strata;
}

std::vector<CircuitFault> draw_events(const FaultStratum& stratum, int most, std::uint64_t clocks,
                                      std::uint64_t seed) {
  CounterRandom random = random_of(stratum, kEvents, seed);
  std::vector<CircuitFault> faults;
  for (int i = 0; i < most; ++i) {
    const FaultSite& site = stratum.sites[random.bits64() % stratum.sites.size()];
    faults.push_back({site, FaultAction::kFlip, 1 + random.bits64() % (clocks - 1)});
  }
  return faults;
}

std::vector<CircuitFault> draw_stuck(const FaultStratum& stratum, int most, std::uint64_t seed) {
  CounterRandom random = random_of(stratum, kStuck, seed);
  std::vector<CircuitFault> faults;
  for (const FaultSite& site : stratum.sites) {
    faults.push_back({site, FaultAction::kStuckLow, 0});
    faults.push_back({site, FaultAction::kStuckHigh, 0});
  }
  // The beginning of a random order (Fisher and Yates).
  const std::size_t count = std::min(static_cast<std::size_t>(most), faults.size());
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(faults[i], faults[i + random.bits64() % (faults.size() - i)]);
  }
  faults.resize(count);
  return faults;
}

}  // namespace dtof
