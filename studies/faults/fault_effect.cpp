// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_effect.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace dtof {
namespace {

constexpr double kTolerance = 0.03;  // of the distance

PixelPlace place_of(std::size_t index) {
  return {static_cast<int>(index) % kFaultColumns, static_cast<int>(index) / kFaultColumns};
}

}  // namespace

FaultEffect fault_effect(const FaultSubject& subject, std::span<const PixelResult> actual,
                         const FaultReach& reach) {
  FaultEffect effect;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    if (!reach.contains(place_of(i))) {
      continue;
    }
    const PixelResult& expected = subject.expected()[i];
    const double move = std::abs(subject.depth(actual[i]) - subject.depth(expected));
    ++effect.pixels;
    effect.changed += actual[i] != expected ? 1 : 0;
    effect.moved += move > 0.0 ? 1 : 0;
    effect.beyond += move > kTolerance * subject.scene().distances_m[i] ? 1 : 0;
    effect.largest_m = std::max(effect.largest_m, move);
  }
  return effect;
}

int changed_elsewhere(const FaultSubject& subject, std::span<const PixelResult> actual,
                      std::span<const FaultReach> faults) {
  int changed = 0;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const bool touched = std::ranges::any_of(
        faults, [&](const FaultReach& fault) { return fault.columns.contains(place_of(i).column); });
    changed += !touched && actual[i] != subject.expected()[i] ? 1 : 0;
  }
  return changed;
}

}  // namespace dtof
