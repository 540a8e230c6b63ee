// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/legendre_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dtof/core/error.hpp"
#include "dtof/rival/linear_code.hpp"

namespace dtof {

std::vector<double> legendre_polynomials(int order, double x) {
  const double s = 2.0 * x - 1.0;
  std::vector<double> values = {1.0, s};
  for (int n = 1; n + 1 < order; ++n) {
    const auto last = static_cast<std::size_t>(n);
    values.push_back(((2.0 * n + 1.0) * s * values[last] - n * values[last - 1]) / (n + 1.0));
  }
  values.resize(static_cast<std::size_t>(order));
  return values;
}

std::vector<std::int16_t> legendre_weights(int np, int order, int bits) {
  if (order < 2 || order > 32 || bits < 2 || bits > 12) {
    throw InputError(
        fmt::format("Legendre memory: order {}, numbers of {} bits, but it must be 2 to 32, and 2 to 12 bits",
                    order, bits));
  }
  const int codes = 1 << np;
  const double height = (1 << (bits - 1)) - 1;
  std::vector<std::int16_t> weights;
  for (int x = 0; x < codes; ++x) {
    const std::vector<double> values = legendre_polynomials(order, (x + 0.5) / codes);
    for (int k = 0; k < order; ++k) {
      const double scale = std::sqrt((2.0 * k + 1.0) / (2.0 * order - 1.0));
      weights.push_back(
          static_cast<std::int16_t>(std::lround(height * scale * values[static_cast<std::size_t>(k)])));
    }
  }
  return weights;
}

std::unique_ptr<Rival> make_legendre_memory(const SensorModel& sensor, int order) {
  constexpr int kNumberBits = 4;
  const double most = ((1 << (kNumberBits - 1)) - 1.0) * sensor.acquisitions * sensor.slots;
  return make_linear_code(
      sensor, {.counters = static_cast<std::size_t>(order),
               .weights = legendre_weights(sensor.np, order, kNumberBits),
               .count_bits = std::min(24, static_cast<int>(std::ceil(std::log2(most + 1.0))) + 1),
               .is_signed = true,
               .full = FullCounter::kStays,
               // P[0] is constant, and the others repeat themselves after half of the range but for the sign.
               .table_bits = (order - 1) * kNumberBits * (1 << (sensor.np - 1))});
}

}  // namespace dtof
