// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace dtof {

/// Number of processors of the machine, at least 1.
int hardware_threads();

/// Calls `body(index)` for every index in [0, count) on at most `threads` threads (0 = all processors). The
/// order of the calls is not defined. The first exception stops the remaining calls and is rethrown. An
/// interruption (core/progress.hpp) is thrown as Interrupted.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

}  // namespace dtof
