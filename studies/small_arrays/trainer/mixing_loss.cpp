// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/trainer/mixing_loss.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "small_arrays/models/enlarger_input.hpp"

namespace dtof {
namespace {

constexpr double kRound = 0.01;
constexpr double kFar = 0.1;

}  // namespace

double distance_loss(double measured_m, double true_m) {
  const double size = std::hypot(measured_m / true_m - 1.0, kRound) - kRound;
  return size / (size + kFar);
}

std::size_t judged_pixels(const MixingTruth& truth) {
  return static_cast<std::size_t>(
      std::ranges::count_if(truth.distance_m, [](float distance) { return distance > 0.0F; }));
}

double mixing_loss(std::span<const float> scores, const MixingTruth& truth, std::span<float> gradient) {
  const std::size_t pixels = truth.distance_m.size();
  std::ranges::fill(gradient, 0.0F);
  double loss = 0.0;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const double right = truth.distance_m[pixel];
    if (right <= 0.0) {
      continue;
    }
    std::array<double, kCandidates> weights{};
    for (std::size_t k = 0; k < kCandidates; ++k) {
      weights[k] = double{scores[k * pixels + pixel]} + truth.prior[k * pixels + pixel];
    }
    const double highest = *std::ranges::max_element(weights);
    double sum = 0.0;
    for (std::size_t k = 0; k < kCandidates; ++k) {
      weights[k] = std::exp(weights[k] - highest);
      sum += weights[k];
    }
    double mixed = 0.0;
    for (std::size_t k = 0; k < kCandidates; ++k) {
      weights[k] /= sum;
      mixed += weights[k] * truth.candidates[k * pixels + pixel];
    }
    loss += distance_loss(mixed, right);
    const double error = mixed / right - 1.0;
    const double size = std::hypot(error, kRound) - kRound;
    const double slope = kFar / ((size + kFar) * (size + kFar)) * error / std::hypot(error, kRound) /
                         right;  // of the loss over the mixed distance
    for (std::size_t k = 0; k < kCandidates; ++k) {
      gradient[k * pixels + pixel] =
          static_cast<float>(slope * weights[k] * (truth.candidates[k * pixels + pixel] - mixed));
    }
  }
  return loss;
}

}  // namespace dtof
