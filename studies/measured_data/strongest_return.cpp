// SPDX-License-Identifier: Apache-2.0
#include "measured_data/strongest_return.hpp"

#include <cmath>
#include <cstddef>

namespace dtof {
namespace {

/// Logarithm of a bound on the probability that a Poisson number of this mean is at least `number`: Chernoff.
double log_chance_of(double number, double mean) {
  return number > mean ? number - mean - number * std::log(number / mean) : 0.0;
}

}  // namespace

std::optional<double> strongest_return(std::span<const TimedEvents> events, double window_s, double span_s) {
  double all = 0.0;
  double windows = 0.0;
  for (const TimedEvents& one : events) {
    all += one.events;
    windows += one.events > 0.0 ? 1.0 : 0.0;
  }
  // A bin that begins where the window ends is outside of it, whatever the rounding.
  const double length = window_s * (1.0 - 1e-9);
  double most = 0.0;
  std::size_t best_begin = 0;
  std::size_t best_end = 0;
  double inside = 0.0;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < events.size(); ++begin) {
    while (end < events.size() && events[end].time_s < events[begin].time_s + length) {
      inside += events[end++].events;
    }
    // A window with more by rounding alone is no later one.
    if (inside > most * (1.0 + 1e-12)) {
      most = inside;
      best_begin = begin;
      best_end = end;
    }
    inside -= events[begin].events;
  }
  if (most <= 0.0 || window_s >= span_s) {
    return std::nullopt;
  }
  // One event more than there are outside of the window: without any, a single event would be a return.
  const double background = (all - most + 1.0) * window_s / (span_s - window_s);
  if (log_chance_of(most, background) + std::log(windows) > std::log(kChanceOfReturn)) {
    return std::nullopt;
  }
  double moment = 0.0;
  for (const TimedEvents& one : events.subspan(best_begin, best_end - best_begin)) {
    moment += one.events * (one.time_s - events[best_begin].time_s);
  }
  return events[best_begin].time_s + moment / most;
}

}  // namespace dtof
