// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/host/range_converter.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// The host's part of counters that add up a code, y[k] = sum over the detections x of C[k][x]: the place t
/// of the pulse whose expected counters look most like those read (Gutierrez-Barragan et al., CVPR 2022).
///
///     rho(t) = y . c(t) / (|y| |c(t)|),   c[k](t) = sum over x of C[k][x] g(x - t),   g the pulse
///
/// Flat background adds the same vector u[k] = sum over x of C[k][x] in proportion to its photons; y and c
/// are taken without their parts along u. For bins and splines, where all u[k] are equal, that is the zero
/// mean of the paper; the waves of Fourier codes have none, and lose no dimension. Pile-up is not known.
///
/// With neither the pulse's photons nor the noise known, the likelihood ratio of a pulse at t against none is
/// (1 - rho^2)^(-d / 2) with d the dimensions left, for rho > 0 and equal noise in all counters: its
/// logarithm is the evidence.
class CodeMatcher {
 public:
  /// `weights[x * counters + k]` is C[k][x], for the codes x of 0 .. 2^NP - 1; the last one is no detection.
  CodeMatcher(const SensorModel& sensor, std::span<const std::int16_t> weights, std::size_t counters);

  /// rho of each code 0 .. 2^NP - 2; all 0 for counters that have nothing but background in them.
  [[nodiscard]] std::vector<double> correlation(std::span<const std::int32_t> words) const;
  /// The highest, refined by the parabola through its neighbours; rho there is the confidence.
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const;
  [[nodiscard]] std::vector<double> evidence(std::span<const std::int32_t> words) const;
  /// Multiply-adds and comparisons of decode().
  [[nodiscard]] int operations() const {
    constexpr std::size_t kOfACounter = 4;  // background, length, share
    return static_cast<int>(codes_ * (counters_ + 1) + kOfACounter * counters_);
  }

 private:
  /// Without the part along the background.
  void project(std::vector<double>& vector) const;

  std::size_t counters_;
  std::size_t codes_;               // without no detection
  std::vector<double> background_;  // of length 1; empty if flat background adds nothing
  std::vector<double> templates_;   // [k * codes + t], each t of length 1
};

}  // namespace dtof
