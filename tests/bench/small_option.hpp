// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string_view>

namespace dtof {

/// True if --small is among the arguments, from which it is taken: each benchmark then runs once, on less
/// work.
inline bool take_small_option(int& argc, char** argv) {
  char** const end =
      std::remove_if(argv, argv + argc, [](const char* text) { return std::string_view(text) == "--small"; });
  const bool small = end != argv + argc;
  argc = static_cast<int>(end - argv);
  return small;
}

/// So long, or once.
inline void run_for(benchmark::internal::Benchmark& bench, double seconds, bool small) {
  if (small) {
    bench.Iterations(1);
  } else {
    bench.MinTime(seconds);
  }
}

}  // namespace dtof
