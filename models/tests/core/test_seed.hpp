// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace dtof {

inline constexpr std::uint64_t kDefaultTestSeed = 20240611;

/// Seed of randomised tests: the environment variable DTOF_TEST_SEED, else a fixed one. Tests print it.
inline std::uint64_t test_seed() {
  const char* text = std::getenv("DTOF_TEST_SEED");
  return text == nullptr ? kDefaultTestSeed : std::stoull(text);
}

/// Whether tests repeat on large arrays what smaller ones of the same kind show: DTOF_TEST_LONG=1, as
/// .ci/long has it.
inline bool long_tests() { return std::getenv("DTOF_TEST_LONG") != nullptr; }

/// For SCOPED_TRACE: the setting that repeats the run.
inline std::string test_seed_message() { return "DTOF_TEST_SEED=" + std::to_string(test_seed()); }

}  // namespace dtof
