// SPDX-License-Identifier: Apache-2.0
#include "src/rtl_engine.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/frame/array_rows.hpp"
#include "rtl/run_frame.hpp"
#include "run/readout_run.hpp"
#include "run/run_settings.hpp"

namespace dtof::python {
namespace {

/// An array's library takes Verilator's runtime from the process. Python keeps a module's symbols from other
/// libraries; this shows them those of exports.map.
void show_runtime() {
  Dl_info own{};
  if (dladdr(reinterpret_cast<const void*>(&show_runtime), &own) == 0 ||
      dlopen(own.dli_fname, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD) == nullptr) {
    const char* reason = dlerror();
    throw InputError(fmt::format("engine: the module's symbols cannot be shown to its RTL: {}",
                                 reason != nullptr ? reason : "the module's file is unknown"));
  }
}

/// Waits for the turn of this thread: the list of arrays (rtl/registry.hpp) is the process's, and has no
/// lock.
std::unique_lock<std::timed_mutex> take_turn() {
  static std::timed_mutex mutex;
  constexpr auto kInterval = std::chrono::milliseconds(50);
  std::unique_lock lock(mutex, std::defer_lock);
  while (!lock.try_lock_for(kInterval)) {
    check_interruption();
  }
  return lock;
}

class RtlEngine final : public FrameEngine {
 public:
  RtlEngine(int threads, Progress::Observer observer)
      : turn_(take_turn()), threads_(threads), observer_(std::move(observer)) {}

  [[nodiscard]] bool reads_samples(Readout /*readout*/) const override { return false; }

  [[nodiscard]] ReadoutRun read(const StreamSource& source, const ReadoutParameters& parameters,
                                const Region& region) const override {
    const auto start = std::chrono::steady_clock::now();
    const ArrayRows array = array_rows(source, region.rows, parameters.readout);
    Progress progress(region.columns.size(), observer_);
    RtlSourceFrame frame = run_frame_rtl(*array.source, parameters, threads_, region.columns, {}, &progress);
    ReadoutRun run;
    run.cycles = frame.clocks.value_or(0);
    run.results = array.read(std::move(frame.results));
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return run;
  }

 private:
  std::unique_lock<std::timed_mutex> turn_;
  int threads_;
  Progress::Observer observer_;
};

}  // namespace

std::unique_ptr<FrameEngine> make_rtl_engine(const StreamSource& source,
                                             std::span<const ReadoutParameters> readouts,
                                             const Region& region, int threads, Progress::Observer observer) {
  auto engine = std::make_unique<RtlEngine>(threads, std::move(observer));
  show_runtime();
  RunSettings settings;
  settings.engine = "rtl";
  check_engine(source, readouts, settings, region);
  return engine;
}

}  // namespace dtof::python
