// SPDX-License-Identifier: Apache-2.0
// Read first by every source of the build with mutants: says which mutant is alive.
#pragma once

#include <cstdlib>

/// Number of the mutant that is alive, from the environment; 0 for none.
inline const int kLiveMutant = [] {
  const char* text = std::getenv("DTOF_LIVE_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();

/// A template, since only a template may be called by constexpr functions without being constant itself.
template <int kNumber>
constexpr bool mutant_lives() {
  return kLiveMutant == kNumber;
}
