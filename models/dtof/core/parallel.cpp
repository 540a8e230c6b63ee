// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "dtof/core/progress.hpp"

namespace dtof {
namespace {

// Debian's libtbb is not instrumented, so ThreadSanitizer does not see that a body comes after the call of
// parallel_for and before its return. Under it these say so, and order no body before another one.
#ifdef __SANITIZE_THREAD__
std::atomic<int> calls;
std::atomic<int> ended_bodies;

void before_bodies() { calls.fetch_add(1, std::memory_order_release); }
void begin_body() { (void)calls.load(std::memory_order_acquire); }
void end_body() { ended_bodies.fetch_add(1, std::memory_order_release); }
void after_bodies() { (void)ended_bodies.load(std::memory_order_acquire); }
#else
void before_bodies() {}
void begin_body() {}
void end_body() {}
void after_bodies() {}
#endif

}  // namespace

int hardware_threads() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  const auto limit = static_cast<std::size_t>(threads > 0 ? threads : hardware_threads());
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, limit);
  const std::atomic<bool>* const stop = StopScope::flag();
  const auto run = [&body, stop](std::size_t index) {
    const StopScope scope(stop);
    begin_body();
    check_interruption();
    body(index);
    end_body();
  };
  before_bodies();
  tbb::parallel_for(std::size_t{0}, count, run);
  after_bodies();
}

}  // namespace dtof
