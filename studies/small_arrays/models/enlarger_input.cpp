// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/enlarger_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dtof {
namespace {

constexpr double kNearest = 0.01;  // a logarithm needs a distance above 0

/// Share of the values that are lower; equal ones count half.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  std::vector<double> shares;
  shares.reserve(values.size());
  for (const double value : values) {
    const auto low = std::ranges::lower_bound(sorted, value);
    const auto high = std::ranges::upper_bound(sorted, value);
    shares.push_back(0.5 * static_cast<double>((low - sorted.begin()) + (high - sorted.begin())) /
                     static_cast<double>(sorted.size()));
  }
  return shares;
}

}  // namespace

EnlargerInput make_enlarger_input(const SmallMap& map, const IntensityImage& image) {
  constexpr double kSteepness = 5.0;
  constexpr double kMostDifference = 2.0;
  constexpr double kUnlike = 0.05;
  constexpr double kCommonSpacing = 4.0;
  constexpr JointBilateral kPrior{0.35, 0.06};
  constexpr double kMostUnlike = 6.0;
  check_small_map(map);
  check_image(map, image);
  const SpotGrid& grid = map.grid;
  const std::vector<double> confidence = ranks(map.confidence);
  const std::vector<double> bright = brightness(image);
  const double pitch_x = static_cast<double>(grid.columns) / grid.small_columns();
  const double pitch_y = static_cast<double>(grid.rows) / grid.small_rows();
  EnlargerInput input{grid.columns, grid.rows, {}, {}, {}};
  const std::size_t pixels = input.pixels();
  input.features.resize(std::size_t{kFeatures} * pixels);
  input.candidates.resize(kCandidates * pixels);
  input.prior.resize(kCandidates * pixels);
  for (int row = 0; row < grid.rows; ++row) {
    const int middle_j = nearest_spot(grid.y, row);
    for (int column = 0; column < grid.columns; ++column) {
      const int middle_i = nearest_spot(grid.x, column);
      const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                                static_cast<std::size_t>(column);
      const auto set = [&](std::size_t feature, double value) {
        input.features[feature * pixels + pixel] = static_cast<float>(value);
      };
      std::array<double, kCandidates> logarithms{};
      for (std::size_t k = 0; k < kCandidates; ++k) {
        const int i = std::clamp(middle_i + static_cast<int>(k % 3) - 1, 0, grid.small_columns() - 1);
        const int j = std::clamp(middle_j + static_cast<int>(k / 3) - 1, 0, grid.small_rows() - 1);
        const std::size_t spot = static_cast<std::size_t>(j) * grid.x.size() + static_cast<std::size_t>(i);
        const std::size_t spot_pixel = static_cast<std::size_t>(grid.y[static_cast<std::size_t>(j)]) *
                                           static_cast<std::size_t>(grid.columns) +
                                       static_cast<std::size_t>(grid.x[static_cast<std::size_t>(i)]);
        input.candidates[k * pixels + pixel] = static_cast<float>(map.distance_m[spot]);
        logarithms[k] = std::log(std::max(map.distance_m[spot], kNearest));
        set(kCandidates + k, confidence[spot]);
        const double unlike = bright[spot_pixel] - bright[pixel];
        set(std::size_t{2} * kCandidates + k, std::exp(-0.5 * std::pow(unlike / kUnlike, 2)));
        const double right = (column - grid.x[static_cast<std::size_t>(i)]) / pitch_x;
        const double below = (row - grid.y[static_cast<std::size_t>(j)]) / pitch_y;
        input.prior[k * pixels + pixel] =
            static_cast<float>(-0.5 * (right * right + below * below) / (kPrior.spatial * kPrior.spatial) -
                               std::min(kMostUnlike, 0.5 * std::pow(unlike / kPrior.range, 2)));
      }
      std::array<double, kCandidates> sorted = logarithms;
      std::ranges::nth_element(sorted, sorted.begin() + kCandidates / 2);
      for (std::size_t k = 0; k < kCandidates; ++k) {
        set(k, std::clamp(kSteepness * (logarithms[k] - sorted[kCandidates / 2]), -kMostDifference,
                          kMostDifference));
      }
      set(27, bright[pixel]);
      set(28, (column - grid.x[static_cast<std::size_t>(middle_i)]) / pitch_x);
      set(29, (row - grid.y[static_cast<std::size_t>(middle_j)]) / pitch_y);
      set(30, pitch_x / kCommonSpacing);
    }
  }
  return input;
}

}  // namespace dtof
