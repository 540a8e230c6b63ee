// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/host/range_converter.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// The host's part of counters that add up a code, y[k] = sum over the detections x of C[k][x]. The result is
/// the position t of the pulse whose expected counters are most similar to those read (Gutierrez-Barragan et
/// al., CVPR 2022).
///
///     rho(t) = y . c(t) / (|y| |c(t)|),   c[k](t) = sum over x of C[k][x] g(x - t),   g the pulse
///
/// Flat background adds a multiple of the vector u[k] = sum over x of C[k][x]; the components of y and c
/// along u are removed first. For bins and splines, where all u[k] are equal, this is the zero mean of the
/// paper. The waves of Fourier codes have u = 0 and lose no dimension. Pile-up is not modelled.
///
/// The likelihood ratio of a pulse at t is (1 - rho^2)^(-d / 2) if both the pulse's photons and the noise are
/// unknown. This holds for rho > 0 and equal noise in all counters; d is the number of remaining dimensions.
/// Its logarithm is the evidence.
class CodeMatcher {
 public:
  /// `weights[x * counters + k]` is C[k][x] for the codes x = 0 .. 2^NP - 1; the last code is no detection.
  CodeMatcher(const SensorModel& sensor, std::span<const std::int16_t> weights, std::size_t counters);

  /// rho for each code 0 .. 2^NP - 2; all 0 if the counters hold only background.
  [[nodiscard]] std::vector<double> correlation(std::span<const std::int32_t> words) const;
  /// Position of the largest rho, refined by the parabola through its neighbours; that rho is the confidence.
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const;
  [[nodiscard]] std::vector<double> evidence(std::span<const std::int32_t> words) const;
  /// Number of multiply-adds and comparisons in decode().
  [[nodiscard]] int operations() const {
    constexpr std::size_t kOfACounter = 4;  // background, length, share
    return static_cast<int>(codes_ * (counters_ + 1) + kOfACounter * counters_);
  }

 private:
  /// Removes the component along the background.
  void project(std::vector<double>& vector) const;

  std::size_t counters_;
  std::size_t codes_;               // without the no-detection code
  std::vector<double> background_;  // unit vector; empty if flat background adds nothing
  std::vector<double> templates_;   // [k * codes + t], a unit vector for each t
};

}  // namespace dtof
