// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/ziggurat.hpp"

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cstddef>

namespace dtof {

const Ziggurat& Ziggurat::exponential() {
  static const Ziggurat ziggurat = [] {
    const auto& borders = boost::random::detail::exponential_table<double>::table_x;
    Ziggurat made;
    for (std::size_t i = 0; i < made.layers_.size(); ++i) {
      made.layers_[i] = {borders[i] * 0x1.0p-56, borders[i + 1]};
    }
    return made;
  }();
  return ziggurat;
}

const Ziggurat& Ziggurat::normal() {
  static const Ziggurat ziggurat = [] {
    const auto& borders = boost::random::detail::normal_table<double>::table_x;
    Ziggurat made;
    for (std::size_t i = 0; i < made.layers_.size(); ++i) {
      const double sign = i % 2 == 0 ? -1.0 : 1.0;
      made.layers_[i] = {sign * borders[i / 2] * 0x1.0p-56, borders[i / 2 + 1]};
    }
    return made;
  }();
  return ziggurat;
}

}  // namespace dtof
