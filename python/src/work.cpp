// SPDX-License-Identifier: Apache-2.0
#include "src/work.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

namespace dtof::python {
namespace {

namespace py = pybind11;

/// What the working thread tells the calling one.
struct WorkState {
  std::mutex mutex;
  std::condition_variable changed;
  bool finished = false;
  std::size_t done = 0;
  std::size_t total = 0;
  std::exception_ptr error;
};

void work_and_notify(WorkState& state, const std::atomic<bool>& stop,
                     const std::function<void(const Progress::Observer&)>& work) {
  const StopScope scope(&stop);
  std::exception_ptr error;
  try {
    work([&state](std::size_t done, std::size_t total) {
      const std::scoped_lock lock(state.mutex);
      state.done = done;
      state.total = total;
    });
  } catch (...) {
    error = std::current_exception();
  }
  const std::scoped_lock lock(state.mutex);
  state.error = error;
  state.finished = true;
  state.changed.notify_one();
}

}  // namespace

void run_work(const py::object& progress, const std::function<void(const Progress::Observer&)>& work) {
  constexpr auto kInterval = std::chrono::milliseconds(50);
  WorkState state;
  std::atomic<bool> stop = false;
  std::exception_ptr python_error;
  std::size_t reported = 0;
  std::thread thread([&] { work_and_notify(state, stop, work); });
  for (bool finished = false; !finished;) {
    std::size_t done = 0;
    std::size_t total = 0;
    {
      const py::gil_scoped_release release;
      std::unique_lock lock(state.mutex);
      finished = state.changed.wait_for(lock, kInterval, [&] { return state.finished; });
      done = state.done;
      total = state.total;
    }
    if (python_error != nullptr) {
      continue;  // the work is on its way to its end
    }
    try {
      if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
      }
      if (!progress.is_none() && done != reported) {
        reported = done;
        progress(done, total);
      }
    } catch (...) {
      python_error = std::current_exception();
      stop = true;
    }
  }
  {
    const py::gil_scoped_release release;
    thread.join();
  }
  if (python_error != nullptr) {
    std::rethrow_exception(python_error);
  }
  if (state.error != nullptr) {
    std::rethrow_exception(state.error);
  }
}

}  // namespace dtof::python
