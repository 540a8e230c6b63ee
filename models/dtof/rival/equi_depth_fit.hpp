// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "dtof/rival/rival.hpp"

namespace dtof {

/// How a SPAD is armed.
enum class Capture {
  kFirstEvents,  ///< anew at each pulse; the sensor's number of slots is kept, as PhotonSource does
  kFreeRunning,  ///< after each dead time, whatever the laser does; dead time runs on over the pulses
};

/// The host's part of equi-depth histograms by analysis and synthesis: the position whose calculated
/// boundaries fit best those read (Sadekar, Goyal, Maier and Ingle, High-Flux Count-Free Single-Photon 3D
/// Cameras, ICCP 2025, arXiv 2608.18306).
///
/// A pulse at code t with S events per acquisition on a flat background of B events detects with the
/// calculated density d(x), which includes the loss of events. With n parts between the boundaries e[i],
/// each of which holds 1 / n of the detections, the result is the t with the largest
///
///     L(t) = 1/n  sum over i of log( sum of d(x) over e[i] <= x < e[i+1]  /  sum of d(x) over all x )
///
/// over a table of pairs (S, B). The density for the rate v(x) of the events is
///
///     first events:   d(x) = v(x) P(fewer than `slots` events before x)
///     free-running:   d(x) = v(x) (1 - sum of d(u) over x - D <= u < x),  D the dead time, x on a circle
///
/// The second equation is exact for a dead time that no further event prolongs. The abstract leaves open how
/// the synthesis searches; the table and its steps are choices of this model. Positions are half a standard
/// deviation of the pulse apart, and a parabola through the best one and its neighbours gives the result.
class EquiDepthFit {
 public:
  EquiDepthFit(const SensorModel& sensor, Capture capture);

  /// `boundaries` in codes from the range's begin on, ascending or not. The confidence is L(t) less its mean
  /// over all positions.
  [[nodiscard]] Measurement decode(std::vector<double> boundaries) const;
  /// Multiply-adds and comparisons of decode() for n parts.
  [[nodiscard]] int operations(int parts) const { return static_cast<int>(tables_) * (3 * parts + 1); }

 private:
  double codes_;
  double step_;             // codes between positions
  std::size_t positions_;   // for each pair (S, B)
  std::size_t tables_ = 0;  // pairs times positions, position by position for each pair
  std::vector<float>
      shares_;  // [place * tables_ + table]: share of the detections before a place of the range
};

/// HEDH boundaries (equi_depth.hpp) with the host's part by EquiDepthFit. The chip's part is that of
/// make_hierarchical_equi_depth. The rivals' photons come from a sensor that arms its SPADs at each pulse, so
/// the rival gains from the fit, but not from free-running capture.
std::unique_ptr<Rival> make_fitted_equi_depth(const SensorModel& sensor, int parts);

}  // namespace dtof
