// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/colour_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace dtof {

Colour viridis(double position) {
  constexpr std::array<Colour, 7> kCoefficients = {
      {{0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
       {0.1050930431085774, 1.404613529898575, 1.384590162594685},
       {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
       {-4.634230498983486, -5.799100973351585, -19.33244095627987},
       {6.228269936347081, 14.17993336680509, 56.69055260068105},
       {4.776384997670288, -13.74514537774601, -65.35303263337234},
       {-5.435455855934631, 4.645852612178535, 26.3124352495832}}};
  const double t = std::clamp(position, 0.0, 1.0);
  Colour colour{};
  for (std::size_t channel = 0; channel < colour.size(); ++channel) {
    double value = 0.0;
    for (std::size_t power = kCoefficients.size(); power-- > 0;) {
      value = value * t + kCoefficients.at(power).at(channel);
    }
    colour.at(channel) = std::clamp(value, 0.0, 1.0);
  }
  return colour;
}

Colour blue_white_red(double position) {
  constexpr std::array<Colour, 5> kNodes = {{{0.020, 0.188, 0.380},
                                             {0.263, 0.576, 0.765},
                                             {0.969, 0.969, 0.969},
                                             {0.839, 0.376, 0.302},
                                             {0.404, 0.000, 0.122}}};
  const double scaled = std::clamp(position, 0.0, 1.0) * static_cast<double>(kNodes.size() - 1);
  const std::size_t node = std::min(static_cast<std::size_t>(scaled), kNodes.size() - 2);
  const double weight = scaled - static_cast<double>(node);
  Colour colour{};
  for (std::size_t channel = 0; channel < colour.size(); ++channel) {
    colour.at(channel) = std::lerp(kNodes.at(node).at(channel), kNodes.at(node + 1).at(channel), weight);
  }
  return colour;
}

}  // namespace dtof
