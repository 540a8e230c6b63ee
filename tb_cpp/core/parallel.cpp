// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <thread>

#include "core/progress.hpp"

namespace dtof {

int hardware_threads() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  const auto limit = static_cast<std::size_t>(threads > 0 ? threads : hardware_threads());
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, limit);
  tbb::parallel_for(std::size_t{0}, count, [&body](std::size_t index) {
    check_interruption();
    body(index);
  });
}

}  // namespace dtof
