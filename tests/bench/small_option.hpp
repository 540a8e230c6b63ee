// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string_view>

namespace dtof {

/// Removes --small from the arguments; returns whether it was there. Then each benchmark runs once, on less
/// work.
inline bool take_small_option(int& argc, char** argv) {
  char** const end =
      std::remove_if(argv, argv + argc, [](const char* text) { return std::string_view(text) == "--small"; });
  const bool small = end != argv + argc;
  argc = static_cast<int>(end - argv);
  return small;
}

/// Runs a benchmark for `seconds`, or once if `small`.
inline void run_for(benchmark::internal::Benchmark& bench, double seconds, bool small) {
  if (small) {
    bench.Iterations(1);
  } else {
    bench.MinTime(seconds);
  }
}

}  // namespace dtof
