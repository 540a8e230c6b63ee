// SPDX-License-Identifier: Apache-2.0
// core/parallel.hpp where there is one thread: in WebAssembly (make playground).
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"

namespace dtof {

int hardware_threads() { return 1; }

void parallel_for(std::size_t count, int /*threads*/, const std::function<void(std::size_t)>& body) {
  for (std::size_t index = 0; index < count; ++index) {
    check_interruption();
    body(index);
  }
}

}  // namespace dtof
