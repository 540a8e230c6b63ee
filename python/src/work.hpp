// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <utility>

#include "dtof/core/progress.hpp"

namespace dtof::python {

/// Does `work` on a thread of its own while other threads of Python run. Every few hundredths of a second
/// `progress` (a callable of two whole numbers, or None) receives the figures of the work's observer, and
/// Python's signals are looked after: an exception of either, such as KeyboardInterrupt, stops the work and
/// is thrown.
void run_work(const pybind11::object& progress, const std::function<void(const Progress::Observer&)>& work);

/// The same for a work that returns something.
template <typename Work>
auto do_work(const pybind11::object& progress, Work&& work) {
  std::optional<decltype(work(Progress::Observer()))> result;
  run_work(progress, [&](const Progress::Observer& observer) { result.emplace(work(observer)); });
  return std::move(*result);
}

}  // namespace dtof::python
