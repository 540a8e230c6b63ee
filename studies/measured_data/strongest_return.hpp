// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

namespace dtof {

/// Events of a pixel at one time, for instance a bin of its histogram.
struct TimedEvents {
  double time_s = 0.0;
  double events = 0.0;
};

/// Chance that a pixel of evenly spread photons is taken for one with a return: the bound that
/// `strongest_return` keeps.
inline constexpr double kChanceOfReturn = 1e-3;

/// Mean time in s of the strongest return among all events of a pixel: of the events in the window of
/// `window_s` that holds the most, the earliest of several. `events` ascend in time and lie within `span_s`.
/// None if chance explains the number: a window holds as many of evenly spread events with a probability
/// above kChanceOfReturn, by Chernoff's bound for a Poisson number and the sum over all windows that begin
/// with an event.
std::optional<double> strongest_return(std::span<const TimedEvents> events, double window_s, double span_s);

}  // namespace dtof
